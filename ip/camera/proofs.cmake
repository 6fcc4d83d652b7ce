# SPDX-License-Identifier: MIT
# Proofs of the camera core: tests/hdl/formal/CMakeLists.txt
proof(camera_buffers camera_buffers 12)
