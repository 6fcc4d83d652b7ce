# SPDX-License-Identifier: MIT
#
# same_bytes.cmake: makes paths in objects relative to the build folder, so that packages have the
# same bytes in every folder. ccache also makes paths relative; these options have the same effect
# without ccache. The variable SAME_BYTES contains the options. If several options match, the
# compiler applies the last one.
file(RELATIVE_PATH source ${CMAKE_BINARY_DIR} ${CMAKE_SOURCE_DIR})
set(SAME_BYTES -ffile-prefix-map=${CMAKE_SOURCE_DIR}/=${source}
    -ffile-prefix-map=${CMAKE_BINARY_DIR}/=)
add_compile_options(${SAME_BYTES})
