# SPDX-License-Identifier: MIT
#
# icesoc-ground: the component with the plugin, the gateway and its service, programs and Slice
# files of the ground station, and the Python module `icesoc`.
set(component icesoc-ground)
set(module lib/python3/dist-packages/icesoc)
install(TARGETS xbeeat xbeeat_cpp11 LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
  COMPONENT ${component})
install(TARGETS gateway RUNTIME COMPONENT ${component})
# The file is copied, because install(TARGETS) strips it but cannot rename it.
set(pack_update ${CMAKE_CURRENT_BINARY_DIR}/bin/icesoc-pack-update)
add_custom_command(OUTPUT ${pack_update}
  COMMAND ${CMAKE_STRIP} -o ${pack_update} $<TARGET_FILE:pack_update>
  DEPENDS pack_update VERBATIM COMMENT "Stripping icesoc-pack-update")
install(PROGRAMS ${pack_update} DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT ${component})
list(APPEND installable xbeeat xbeeat_cpp11 gateway ${pack_update})

# Installs the Python module, and its programs as commands.
set(clients ${top}/sw/ground/clients)
install(FILES ${top}/sw/ground/python/icesoc.py DESTINATION ${module} RENAME __init__.py
  COMPONENT ${component})
install(FILES ${clients}/places.py ${clients}/plugged.py ${clients}/reasons.py
  ${clients}/vehicles.py ${clients}/mission_log.py ${clients}/stay.py
  ${top}/tools/icesoc/util/record.py
  DESTINATION ${module} COMPONENT ${component})
install(PROGRAMS ${clients}/mission.py ${clients}/provide_key.py ${clients}/change_key.py
  ${clients}/update.py DESTINATION ${module} COMPONENT ${component})
foreach(program mission provide_key change_key update)
  string(REPLACE _ - command icesoc-${program})
  set(link ${CMAKE_CURRENT_BINARY_DIR}/bin/${command})
  file(MAKE_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/bin)
  file(CREATE_LINK ../${module}/${program}.py ${link} SYMBOLIC)
  install(FILES ${link} DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT ${component})
endforeach()

# icesoc-call: installs the modules of `./icesoc call`, and the list of objects of the default chip.
set(tools ${top}/tools/icesoc)
file(GLOB modules CONFIGURE_DEPENDS ${tools}/call/*.py)
install(FILES ${tools}/__init__.py DESTINATION ${SHARE}/tools/icesoc COMPONENT ${component})
install(FILES ${modules} DESTINATION ${SHARE}/tools/icesoc/call COMPONENT ${component})
install(FILES ${tools}/cli/__init__.py ${tools}/cli/choices.py ${tools}/cli/command.py
  ${tools}/cli/installed.py ${tools}/cli/main.py ${tools}/cli/options.py
  DESTINATION ${SHARE}/tools/icesoc/cli COMPONENT ${component})
install(FILES ${tools}/cli/commands/__init__.py ${tools}/cli/commands/call.py
  DESTINATION ${SHARE}/tools/icesoc/cli/commands COMPONENT ${component})
install(FILES ${tools}/util/__init__.py ${tools}/util/chip.py ${tools}/util/console.py
  ${tools}/util/errors.py ${tools}/util/process.py ${tools}/util/rooms.py ${tools}/util/rows.py
  ${tools}/util/spelling.py
  DESTINATION ${SHARE}/tools/icesoc/util COMPONENT ${component})
install(PROGRAMS ${here}/ground/icesoc-call DESTINATION ${CMAKE_INSTALL_BINDIR}
  COMPONENT ${component})
set(objects ${CMAKE_CURRENT_BINARY_DIR}/chip.json)
add_custom_command(OUTPUT ${objects}
  COMMAND ${PYTHON} ${here}/objects.py ${GEN_DIR}/chip.json ${top} ${objects}
  DEPENDS ${here}/objects.py ${tools}/util/chip.py ${GEN_DIR}/chip.json
  VERBATIM COMMENT "Objects for icesoc-call")
install(FILES ${objects} DESTINATION ${SHARE}/gen COMPONENT ${component})
list(APPEND installable ${objects})

# icesoc-page: installs the page of the gateway, with Ice for JavaScript, which is GPL-2.0.
install(FILES ${tools}/web/__init__.py ${tools}/web/bridge.py ${tools}/web/live.py
  ${tools}/web/mission.py ${tools}/web/common.css ${tools}/web/common.js
  DESTINATION ${SHARE}/tools/icesoc/web COMPONENT ${component})
file(GLOB parts CONFIGURE_DEPENDS ${tools}/web/flight/*)
install(FILES ${parts} DESTINATION ${SHARE}/tools/icesoc/web/flight COMPONENT ${component})
install(FILES ${CMAKE_BINARY_DIR}/page/ice.js DESTINATION ${SHARE}/page COMPONENT ${component})
install(PROGRAMS ${here}/ground/icesoc-page DESTINATION ${CMAKE_INSTALL_BINDIR}
  COMPONENT ${component})
list(APPEND installable page_ice)

install(FILES ${top}/sw/vehicle/Autopilot.ice ${top}/sw/hw/registers/Registers.ice
  ${top}/sw/update/Update.ice DESTINATION ${SHARE}/slice COMPONENT ${component})
install(FILES ${top}/testbench/status/sim_status.toml ${top}/sw/update/slots_header.toml
  DESTINATION ${SHARE} COMPONENT ${component})
# Installs the Slice files of the cores, and the Python code of each core for a mission.
foreach(core IN LISTS CHIP_CORES)
  if(EXISTS ${top}/ip/${core})
    file(GLOB files ${top}/ip/${core}/*.ice ${top}/ip/${core}/ground.py)
    install(FILES ${files} DESTINATION ${SHARE}/ip/${core} COMPONENT ${component})
  endif()
endforeach()

install(FILES ${here}/ground/icesoc-gateway@.service DESTINATION lib/systemd/system
  COMPONENT ${component})
install(FILES ${here}/ground/70-icesoc-modem.rules DESTINATION lib/udev/rules.d
  COMPONENT ${component})
install(FILES ${here}/ground/gateway.conf ${here}/ground/vehicles.conf ${clients}/ping.cpp
  DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${component}/examples COMPONENT ${component})

icesoc_manual(${component} icesoc-gateway SECTION 8 DEPENDS gateway
  PURPOSE "server in front of the radio for programs with ZeroC Ice in any language"
  COMMAND $<TARGET_FILE:gateway>)
icesoc_manual(${component} icesoc-call DEPENDS ${tools}/cli/installed.py
    ${tools}/cli/commands/call.py
  PURPOSE "call any operation of a vehicle's objects"
  COMMAND ${PYTHON} -m icesoc.cli.installed)
icesoc_manual(${component} icesoc-page DEPENDS ${here}/ground/icesoc-page ${tools}/web/live.py
  PURPOSE "server of the page on which a browser calls the vehicles of a gateway"
  COMMAND ${PYTHON} ${here}/ground/icesoc-page)
icesoc_manual(${component} icesoc-pack-update DEPENDS ${pack_update}
  PURPOSE "pack and sign firmware, bitstreams and lists of keys"
  COMMAND ${pack_update})
icesoc_manual(${component} icesoc-mission DEPENDS ${clients}/mission.py
  PURPOSE "fly the example mission: find corners in the vehicle's picture"
  COMMAND ${PYTHON} ${clients}/mission.py)
icesoc_manual(${component} icesoc-provide-key DEPENDS ${clients}/provide_key.py
  PURPOSE "give a vehicle its address and key over a cable"
  COMMAND ${PYTHON} ${clients}/provide_key.py)
icesoc_manual(${component} icesoc-change-key DEPENDS ${clients}/change_key.py
  PURPOSE "give a vehicle a new key over the radio" COMMAND ${PYTHON} ${clients}/change_key.py)
icesoc_manual(${component} icesoc-update DEPENDS ${clients}/update.py
  PURPOSE "send firmware, a bitstream or keys to a vehicle" COMMAND ${PYTHON} ${clients}/update.py)
add_custom_command(OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/man/icesoc-xbee-at.7.gz
  COMMAND gzip -9nc ${top}/docs/man/icesoc-xbee-at.7
          > ${CMAKE_CURRENT_BINARY_DIR}/man/icesoc-xbee-at.7.gz
  DEPENDS ${top}/docs/man/icesoc-xbee-at.7 VERBATIM)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/man/icesoc-xbee-at.7.gz
  DESTINATION ${CMAKE_INSTALL_MANDIR}/man7 COMPONENT ${component})
list(APPEND installable ${CMAKE_CURRENT_BINARY_DIR}/man/icesoc-xbee-at.7.gz)
