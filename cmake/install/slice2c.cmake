# SPDX-License-Identifier: MIT
#
# icesoc-slice2c: the component with the compiler from Slice to C90, its CMake function and its
# pkg-config file.
set(component icesoc-slice2c)
install(TARGETS slice2c RUNTIME COMPONENT ${component})
install(FILES ${top}/sw/hw/registers/Registers.ice
  DESTINATION ${CMAKE_INSTALL_DATADIR}/slice2c/slice COMPONENT ${component})
configure_file(slice2c/slice2c-config.cmake.in slice2c/slice2c-config.cmake @ONLY)
include(CMakePackageConfigHelpers)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/slice2c/slice2c-config-version.cmake
  VERSION ${ICESOC_VERSION} COMPATIBILITY SameMajorVersion ARCH_INDEPENDENT)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/slice2c/slice2c-config.cmake
  ${CMAKE_CURRENT_BINARY_DIR}/slice2c/slice2c-config-version.cmake
  DESTINATION ${CMAKE_INSTALL_DATADIR}/cmake/slice2c COMPONENT ${component})
configure_file(slice2c/slice2c.pc.in slice2c/slice2c.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/slice2c/slice2c.pc
  DESTINATION ${CMAKE_INSTALL_DATADIR}/pkgconfig COMPONENT ${component})
icesoc_manual(${component} slice2c DEPENDS slice2c
  PURPOSE "generate C90 stubs and skeletons for IceC from Slice files"
  COMMAND $<TARGET_FILE:slice2c>)
list(APPEND installable slice2c)
