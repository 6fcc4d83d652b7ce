# SPDX-License-Identifier: MIT
#
# vhdl.cmake: translates VHDL cores to Verilog by GHDL 5 and refuses latches.

set(GHDL_DIR ${CMAKE_BINARY_DIR}/ghdl)
set(GHDL ${GHDL_DIR}/ghdl)
add_custom_command(OUTPUT ${GHDL}
  COMMAND ${CMAKE_SOURCE_DIR}/cmake/fetch.py ghdl ${GHDL_DIR}
  DEPENDS ${CMAKE_SOURCE_DIR}/cmake/fetch.py VERBATIM COMMENT "GHDL 5")
add_custom_target(ghdl DEPENDS ${GHDL})

# icesoc_vhdl(NAME entity SOURCES file... [REGS block...] [LIBRARY name] [GENERICS name=value...]): ${GEN_DIR}/<entity>.v,
# target <entity>_verilog. The files come in any order.
function(icesoc_vhdl)
  cmake_parse_arguments(A "" "NAME;LIBRARY" "SOURCES;REGS;GENERICS" ${ARGN})
  list(TRANSFORM A_GENERICS PREPEND -g)
  list(JOIN A_GENERICS " " generics)
  if(NOT A_LIBRARY)
    set(A_LIBRARY work)
  endif()
  set(packages)
  set(deps)
  foreach(r IN LISTS A_REGS)
    list(APPEND packages ${GEN_DIR}/${r}_regs_pkg.vhd)
    list(APPEND deps regmap_${r})
  endforeach()
  set(work ${CMAKE_CURRENT_BINARY_DIR}/ghdl_${A_NAME})
  file(MAKE_DIRECTORY ${work})
  add_custom_command(OUTPUT ${GEN_DIR}/${A_NAME}.v
    COMMAND ${CMAKE_COMMAND} -E env VHDL_LIBRARY=${A_LIBRARY} "VHDL_GENERICS=${generics}" ${CMAKE_SOURCE_DIR}/cmake/vhdl_to_verilog.sh ${GHDL} ${work} ${A_NAME} ${GEN_DIR}/${A_NAME}.v
            ${packages} ${A_SOURCES}
    DEPENDS ${GHDL} ghdl ${packages} ${A_SOURCES} ${deps} ${CMAKE_SOURCE_DIR}/cmake/vhdl_to_verilog.sh
    VERBATIM COMMENT "VHDL to Verilog: ${A_NAME}")
  add_custom_target(${A_NAME}_verilog DEPENDS ${GEN_DIR}/${A_NAME}.v)
  set_property(GLOBAL APPEND PROPERTY ICESOC_VHDL_TARGETS ${A_NAME}_verilog)
endfunction()
