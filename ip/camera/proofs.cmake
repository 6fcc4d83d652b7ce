# SPDX-License-Identifier: MIT
# Proofs of the camera core. tests/hdl/formal/CMakeLists.txt reads this file.
proof(camera_buffers camera_buffers 12)
