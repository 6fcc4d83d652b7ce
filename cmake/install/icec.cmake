# SPDX-License-Identifier: MIT
#
# libicec-dev: the component with IceC for programs on this machine (static libraries, headers,
# CMake and pkg-config files) and with its sources for other machines. The libraries are compiled
# with the defaults of ice_config.h, so that a program needs no definitions.
set(component libicec-dev)
set(icec ${top}/sw/icec)
file(GLOB sources CONFIGURE_DEPENDS ${icec}/*.c ${icec}/values/*.c ${icec}/extra/*.c)
file(GLOB tcp_sources CONFIGURE_DEPENDS ${icec}/endpoints/tcp_*.c)
set(headers ${icec}/icec.h ${icec}/ice_config.h ${icec}/ice_objects.h ${icec}/ice_port.h
  ${icec}/ice_stream.h ${icec}/ice_value.h ${icec}/ice_operation.h ${icec}/values/ice_slice.h
  ${icec}/endpoints/tcp_endpoint.h ${top}/sw/base/base.h)

icesoc_c90(icec_host SOURCES ${sources} INCLUDES ${icec} ${top}/sw/base)
icesoc_c90(icec_host_tcp SOURCES ${tcp_sources} INCLUDES ${icec} ${icec}/endpoints ${top}/sw/base)
# htons and similar macros contain implicit conversions
target_compile_options(icec_host_tcp PRIVATE -Wno-conversion)
set_target_properties(icec_host PROPERTIES OUTPUT_NAME icec)
set_target_properties(icec_host_tcp PROPERTIES OUTPUT_NAME icec_tcp)
list(APPEND installable icec_host icec_host_tcp)
install(TARGETS icec_host icec_host_tcp ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  COMPONENT ${component})
install(FILES ${headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/icec COMPONENT ${component})
# The sources, for compiling IceC for other machines; the folders are as in the source tree. The
# radio endpoints are left out, because they need the sources of the link layer.
install(DIRECTORY ${icec} DESTINATION ${CMAKE_INSTALL_DATADIR}/icec/src COMPONENT ${component}
  FILES_MATCHING PATTERN *.c PATTERN *.h PATTERN xbee_* EXCLUDE)
install(FILES ${top}/sw/base/base.h DESTINATION ${CMAKE_INSTALL_DATADIR}/icec/src/base
  COMPONENT ${component})

configure_file(icec/icec-config.cmake.in icec/icec-config.cmake @ONLY)
include(CMakePackageConfigHelpers)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/icec/icec-config-version.cmake
  VERSION ${ICESOC_VERSION} COMPATIBILITY SameMajorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/icec/icec-config.cmake
  ${CMAKE_CURRENT_BINARY_DIR}/icec/icec-config-version.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/icec COMPONENT ${component})
configure_file(icec/icec.pc.in icec/icec.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/icec/icec.pc
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT ${component})
