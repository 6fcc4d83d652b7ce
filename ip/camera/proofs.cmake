# SPDX-License-Identifier: MIT
# Proofs of the camera core, read by tests/hdl/formal/CMakeLists.txt.
proof(camera_buffers camera_buffers 12)
