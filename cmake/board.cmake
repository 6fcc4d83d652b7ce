# SPDX-License-Identifier: MIT
#
# board.cmake: selects the board for which the firmware and the simulator are built. The pins
# (board_pins.h), constraints (board.ucf) and wires (board_wires.inc) of the board are generated
# from boards/BOARD/board.toml.
set(DEFAULT_BOARD nucleo-qmtech)
set(BOARD ${DEFAULT_BOARD} CACHE STRING
  "Board of the firmware and the simulator: a folder of boards/, or the path of a file board.toml")
set(board_file ${CMAKE_SOURCE_DIR}/boards/${BOARD}/board.toml)
if(BOARD MATCHES "[.]toml$")
  get_filename_component(board_file ${BOARD} ABSOLUTE)
endif()
if(NOT EXISTS ${board_file})
  message(FATAL_ERROR "BOARD=${BOARD}: ${board_file} is missing; ./icesoc board list names the "
    "boards")
endif()
# FSMC_DEFINES: preprocessor definition that selects this board's settings of the FSMC bridge and of
# its driver.
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${board_file})
execute_process(COMMAND ${PYTHON} -m icesoc.board.make ${board_file}
  OUTPUT_VARIABLE board_fsmc OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
set(FSMC_DEFINES)
if(board_fsmc STREQUAL "multiplexed")
  set(FSMC_DEFINES FSMC_MUXED)
endif()
if(FSMC_DEFINES AND (NETLIST OR BRIDGE STREQUAL sync))
  message(FATAL_ERROR "BOARD=${BOARD}: expected a board without multiplexed address and data, "
    "because NETLIST and BRIDGE=sync are only possible with such a board")
endif()
file(GLOB board_inputs CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/boards/parts/*.csv
     ${CMAKE_SOURCE_DIR}/boards/modules/*.toml ${TOOLS}/board/*.py)
add_custom_command(
  OUTPUT ${GEN_DIR}/board_pins.h ${GEN_DIR}/board.ucf ${GEN_DIR}/board.wires
         ${GEN_DIR}/board_wires.inc
  COMMAND ${PYTHON} -m icesoc.board.make ${board_file} ${GEN_DIR}
  COMMAND ${CMAKE_COMMAND} -E touch ${GEN_DIR}/board_pins.h ${GEN_DIR}/board.ucf
    ${GEN_DIR}/board.wires ${GEN_DIR}/board_wires.inc
  DEPENDS ${board_file} ${board_inputs} ${TOOLS}/board/board.schema.json
  VERBATIM COMMENT "Board: ${BOARD}")
add_custom_target(board_files DEPENDS ${GEN_DIR}/board_pins.h)
