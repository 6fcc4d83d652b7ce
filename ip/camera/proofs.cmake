# SPDX-License-Identifier: MIT
# Proofs of the camera core: tests/hdl/formal/CMakeLists.txt
proof(camera_fifo camera_fifo 20 "chparam -set WIDTH 2 -set LOG2 2 camera_fifo")
proof(camera_buffers camera_buffers 12)
