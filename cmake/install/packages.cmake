# SPDX-License-Identifier: MIT
#
# packages.cmake: describes the Debian packages to CPack, one for each component.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME icesoc)
set(CPACK_PACKAGE_VENDOR "The IceSoC authors")
set(CPACK_PACKAGE_CONTACT "The IceSoC authors <packages@icesoc.example>")
# ./icesoc package sets DEB_VERSION, which differs for each commit. Otherwise apt would not replace
# an installed package, because it ignores a package with the same version.
set(DEB_VERSION "" CACHE STRING "version of the Debian packages; default: newest in CHANGELOG.md")
set(CPACK_PACKAGE_VERSION ${ICESOC_VERSION})
if(DEB_VERSION)
  set(CPACK_PACKAGE_VERSION ${DEB_VERSION})
endif()
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL icesoc-ground icesoc-slice2c libicec-dev icesoc-sim icesoc-hdl)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS OFF)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
# The version ends with Debian's release: 1.0.0-1~deb12 is older than 1.0.0-1~deb13, so that an
# upgrade of Debian also upgrades the packages.
file(STRINGS /etc/os-release release REGEX "^VERSION_ID=" LIMIT_COUNT 1)
string(REGEX MATCH "[0-9]+" release "${release}")
set(CPACK_DEBIAN_PACKAGE_RELEASE 1~deb${release})
set(deb_version ${CPACK_PACKAGE_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})

# icesoc_package(COMPONENT SUMMARY text DESCRIPTION text [SECTION utils] [ALL]
#                [DEPENDS list] [RECOMMENDS list] [BREAKS list] [SCRIPTS file...])
macro(icesoc_package component)
  cmake_parse_arguments(P "ALL" "SUMMARY;DESCRIPTION;SECTION;DEPENDS;RECOMMENDS;BREAKS"
    "SCRIPTS" ${ARGN})
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${component})
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${P_SUMMARY}\n${P_DESCRIPTION}")
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${P_SECTION})
  set(CPACK_DEBIAN_${upper}_PACKAGE_DEPENDS "${P_DEPENDS}")
  set(CPACK_DEBIAN_${upper}_PACKAGE_RECOMMENDS "${P_RECOMMENDS}")
  set(CPACK_DEBIAN_${upper}_PACKAGE_BREAKS "${P_BREAKS}")
  set(CPACK_DEBIAN_${upper}_PACKAGE_CONTROL_EXTRA ${P_SCRIPTS})
  set(CPACK_DEBIAN_${upper}_PACKAGE_SHLIBDEPS ON)
  if(P_ALL)
    set(CPACK_DEBIAN_${upper}_PACKAGE_ARCHITECTURE all)
    set(CPACK_DEBIAN_${upper}_PACKAGE_SHLIBDEPS OFF)
  endif()
  set(others)
  if(EXISTS ${here}/debian/${component}.copyright)
    file(READ ${here}/debian/${component}.copyright others)
    string(CONFIGURE "${others}" others @ONLY)
    string(PREPEND others "\n")
  endif()
  configure_file(${here}/debian/copyright.in ${CMAKE_CURRENT_BINARY_DIR}/doc/${component}/copyright
    @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/doc/${component}/copyright
    ${CMAKE_CURRENT_BINARY_DIR}/doc/changelog.gz
    ${CMAKE_CURRENT_BINARY_DIR}/doc/${component}/changelog.Debian.gz
    DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${component} COMPONENT ${component})
  add_custom_command(OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/doc/${component}/changelog.Debian.gz
    COMMAND ${here}/debian/changelog.sh ${component}
      ${deb_version} ${CMAKE_CURRENT_BINARY_DIR}/doc/${component}/changelog.Debian.gz
    WORKING_DIRECTORY ${top} DEPENDS ${here}/debian/changelog.sh ${top}/CHANGELOG.md VERBATIM)
  list(APPEND documents ${CMAKE_CURRENT_BINARY_DIR}/doc/${component}/changelog.Debian.gz)
  if(EXISTS ${here}/debian/${component}.lintian)
    install(FILES ${here}/debian/${component}.lintian RENAME ${component}
      DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides COMPONENT ${component})
  endif()
endmacro()

add_custom_command(OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/doc/changelog.gz
  COMMAND gzip -9nc ${top}/CHANGELOG.md > ${CMAKE_CURRENT_BINARY_DIR}/doc/changelog.gz
  DEPENDS ${top}/CHANGELOG.md VERBATIM)
set(documents ${CMAKE_CURRENT_BINARY_DIR}/doc/changelog.gz)
file(STRINGS ${top}/LICENSE copyright REGEX "^Copyright" LIMIT_COUNT 1)
string(REGEX REPLACE "^Copyright [(]c[)] " "" copyright "${copyright}")
file(READ ${top}/LICENSE text)
string(REGEX REPLACE "^.*Copyright[^\n]*\n\n" "" text "${text}")
string(REGEX REPLACE "\n\n" "\n.\n" text "${text}")
string(REGEX REPLACE "\n$" "" text "${text}")
string(REGEX REPLACE "\n" "\n " licence " ${text}")

set(scripts ${here}/debian/ground)
icesoc_package(icesoc-ground SECTION comm
  SUMMARY "ground station for vehicles with ZeroC Ice objects over a radio"
  DESCRIPTION "A transport plugin connects programs with stock ZeroC Ice to IceSoC vehicles
over XBee modems. A gateway serves programs in any language. The package has
the service of the gateway, commands for keys and updates, Slice files, and
the Python module icesoc."
  DEPENDS "icesoc-slice2c (= ${deb_version}), python3, \
python3-zeroc-ice, python3-pil, python3-lz4, zeroc-ice-slice, adduser"
  SCRIPTS ${scripts}/postinst ${scripts}/prerm ${scripts}/postrm
    ${scripts}/shlibs ${scripts}/triggers)
icesoc_package(icesoc-slice2c SECTION devel
  SUMMARY "compiler from Slice to C90 for IceC"
  DESCRIPTION "slice2c generates stubs and skeletons in C90 from interfaces in Slice, the
language of ZeroC Ice, and wrappers and registers of FPGA cores. The package
has a CMake function."
  RECOMMENDS "libicec-dev")
icesoc_package(libicec-dev SECTION libdevel
  SUMMARY "Ice protocol in C90 without memory allocation"
  DESCRIPTION "IceC serves and calls ZeroC Ice objects from C. The package has static
libraries for this machine, headers, and the sources for other machines, such
as microcontrollers."
  DEPENDS "libc6-dev" RECOMMENDS "icesoc-slice2c"
  BREAKS "icesoc-slice2c (<< ${deb_version}), icesoc-slice2c (>> ${deb_version})")
icesoc_package(icesoc-sim SECTION electronics
  SUMMARY "simulator of an IceSoC vehicle, with modems and air"
  DESCRIPTION "The simulator runs the FPGA's logic and the firmware of a vehicle with models
of memory, modems and air. icesoc-fly flies the example mission with the
programs of icesoc-ground."
  DEPENDS "icesoc-ground (= ${deb_version}), python3"
  RECOMMENDS "xplanet-images")
icesoc_package(icesoc-hdl SECTION electronics ALL
  SUMMARY "Verilog blocks of IceSoC for other FPGA projects"
  DESCRIPTION "FSMC bridge, register bus with adapters, memory arbiter, modem controller and
clock-domain crossings, with FuseSoC core files, file lists and constraints.")

add_custom_target(documents DEPENDS ${documents})
add_dependencies(installable documents)
include(CPack)
