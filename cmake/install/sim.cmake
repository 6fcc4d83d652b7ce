# SPDX-License-Identifier: MIT
#
# icesoc-sim: the component with the simulator of the default chip, the firmware, the modem's model,
# and the command that flies the mission.
set(component icesoc-sim)
install(TARGETS icesoc-sim icesoc-xbee RUNTIME COMPONENT ${component})
install(TARGETS vision-reference RUNTIME DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/icesoc
  COMPONENT ${component})
# The programs of the ground station load this library to follow simulated time.
install(TARGETS sim_clock LIBRARY DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/icesoc
  COMPONENT ${component})
install(PROGRAMS ${top}/testbench/sim/fly.py DESTINATION ${CMAKE_INSTALL_BINDIR}
  RENAME icesoc-fly COMPONENT ${component})
# Installs the firmware without debug information, because debug information contains paths of the
# build.
set(elf ${CMAKE_CURRENT_BINARY_DIR}/uav.elf)
add_custom_command(OUTPUT ${elf}
  COMMAND ${ARM_OBJCOPY} --strip-debug ${CMAKE_BINARY_DIR}/firmware/uav.elf ${elf}
  DEPENDS ${CMAKE_BINARY_DIR}/firmware/uav.elf firmware_uav VERBATIM)
install(FILES ${elf} DESTINATION lib/icesoc COMPONENT ${component})
install(FILES ${top}/tools/icesoc/cli/flight.schema.json DESTINATION ${SHARE}
  COMPONENT ${component})

icesoc_manual(${component} icesoc-sim DEPENDS icesoc-sim
  PURPOSE "simulate the vehicle: FPGA, microcontroller, modems and air"
  COMMAND $<TARGET_FILE:icesoc-sim>)
icesoc_manual(${component} icesoc-xbee DEPENDS icesoc-xbee
  PURPOSE "two simulated XBee modems on pseudo-terminals, and the air between them"
  COMMAND $<TARGET_FILE:icesoc-xbee>)
set(fly ${CMAKE_CURRENT_BINARY_DIR}/fly)
configure_file(${top}/testbench/sim/fly.py ${fly}/bin/icesoc-fly COPYONLY)
configure_file(${top}/tools/icesoc/cli/flight.schema.json ${fly}/share/icesoc/flight.schema.json
  COPYONLY)
icesoc_manual(${component} icesoc-fly DEPENDS ${fly}/bin/icesoc-fly
  PURPOSE "fly the mission in the simulator" COMMAND ${PYTHON} ${fly}/bin/icesoc-fly)
list(APPEND installable icesoc-sim icesoc-xbee vision-reference sim_clock ${elf})
