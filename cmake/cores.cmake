# SPDX-License-Identifier: MIT
#
# cores.cmake: IP cores: how one is built, and how those of ip/cores.list come into the chip (docs/hw-mapping.md).

set(CORES ${CMAKE_SOURCE_DIR}/ip/cores.list CACHE FILEPATH "The cores in the chip, one a line")
set(CORE_FOLDERS "" CACHE STRING "Folders of cores besides those in ip/")
set(FOREIGN_CORES ${CMAKE_BINARY_DIR}/foreign CACHE PATH "Where cmake/fetch.sh foreign put third-party cores")

# Names in the list, for what is built only with a core: if("vision" IN_LIST CHIP_CORES)
set(CHIP_CORES)
set(instances 0)
set_property(DIRECTORY ${CMAKE_SOURCE_DIR} APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${CORES})
file(STRINGS ${CORES} lines)
foreach(line IN LISTS lines)
  if(line MATCHES "^[ \t]*([^# \t]+)")
    list(APPEND CHIP_CORES ${CMAKE_MATCH_1})
    math(EXPR instances "${instances} + 1")
  endif()
endforeach()
list(REMOVE_DUPLICATES CHIP_CORES)
# The object adapter has room for every core's servant beside the UAV's own: 8 servants by default (sw/icec/ice_config.h),
# more where the list is longer, on the host and, by ARM_DEFINES, in the firmware.
set(ARM_DEFINES)
if(instances GREATER 7)
  math(EXPR servants "${instances} + 1")
  add_compile_definitions(ICE_SERVANTS=${servants})
  set(ARM_DEFINES ICE_SERVANTS=${servants})
endif()

# icesoc_core(NAME [ICE file.ice | REGS name.regs.json] [VERILOG file...] [VHDL file...] [SERVANT file.c...]
#             [SLICE name...] [INCLUDES dir...] [FLAGS ...])
# The core NAME: a module or entity NAME with a slot's ports. ICE: its [":hw"] interface, from which
# registers, wrapper and servant are made; else REGS describes its registers, and SERVANT is written by hand, for an
# interface of the Slice libraries SLICE. <NAME>_test.cpp beside it becomes test_ip_<NAME>, with the model V<NAME>_slot.
# FLAGS: Verilator's, for a foreign core's style. LIBRARY: the VHDL library that its files say they are in.
function(icesoc_core name)
  cmake_parse_arguments(A "" "ICE;REGS;LIBRARY" "VERILOG;VHDL;SERVANT;SLICE;INCLUDES;FLAGS" ${ARGN})
  list(TRANSFORM A_VHDL PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/ REGEX "^[^/]")
  list(TRANSFORM A_VERILOG PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/ REGEX "^[^/]")
  list(TRANSFORM A_SERVANT PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/ REGEX "^[^/]")
  set(files ${A_VERILOG})
  set(targets)
  set(wrapper)
  set(arm_sources ${A_SERVANT})
  set(arm_includes ${CMAKE_CURRENT_SOURCE_DIR} ${CMAKE_SOURCE_DIR}/sw/hw)
  set(arm_targets)
  set(libs)
  if(A_ICE)
    get_filename_component(base ${A_ICE} NAME_WE)
    icesoc_hardware(${name} ${A_ICE} BLOCKS ${name} INCLUDES ${A_INCLUDES})
    set(regs ${GEN_DIR}/${name}.regs.json)
    if(A_VHDL)
      set(wrapper ${GEN_DIR}/${name}_wrapper.vhd)
    else()
      list(APPEND files ${GEN_DIR}/${name}_wrapper.v)
    endif()
    list(APPEND targets ${name}_hardware)
    set(slice ${GEN_DIR}/slice/${name})
    list(APPEND arm_sources ${GEN_DIR}/${name}_servant.c ${slice}/${base}_types.c ${slice}/${base}_client.c
                            ${slice}/${base}_server.c)
    list(APPEND arm_includes ${slice})
    list(APPEND arm_targets ${name}_slice ${name}_hardware)
    list(APPEND libs ${name}_servants)
  else()
    icesoc_regmap(${A_REGS})
    get_filename_component(regs ${A_REGS} ABSOLUTE)
    list(APPEND targets regmap_${name})
    if(A_SERVANT)
      set(slices)
      foreach(s IN LISTS A_SLICE)
        list(APPEND slices ${s}_server)
      endforeach()
      icesoc_c90(${name}_servants SOURCES ${A_SERVANT} INCLUDES ${CMAKE_SOURCE_DIR}/sw/apps/uav
                 LIBS ${slices} hw_core regs_${name})
      list(APPEND libs ${name}_servants)
    endif()
  endif()
  if(A_VHDL)
    set(registers)
    if(A_REGS)
      set(registers REGS ${name})
    endif()
    icesoc_vhdl(NAME ${name} SOURCES ${wrapper} ${A_VHDL} ${registers} LIBRARY ${A_LIBRARY})
    list(APPEND files ${GEN_DIR}/${name}.v)
    list(APPEND targets ${name}_verilog)
    list(APPEND A_FLAGS -Wno-PINCONNECTEMPTY) # GHDL's way to write `open`
  endif()
  foreach(what files targets regs libs arm_sources arm_includes arm_targets)
    set_property(GLOBAL PROPERTY ICESOC_CORE_${name}_${what} ${${what}})
  endforeach()
  set_property(GLOBAL PROPERTY ICESOC_CORE_${name}_flags ${A_FLAGS})
  set_property(GLOBAL APPEND PROPERTY ICESOC_CORES ${name})
  if(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/${name}_test.cpp AND "testbench" IN_LIST ROOMS)
    icesoc_verilate(${name}_slot TOP ${name} SOURCES ${files} DEPENDS ${targets} FLAGS ${A_FLAGS}
                    INCLUDES ${CMAKE_SOURCE_DIR}/bus ${CMAKE_SOURCE_DIR}/hdl/ddr ${CMAKE_SOURCE_DIR}/hdl/system ${CMAKE_CURRENT_SOURCE_DIR})
    set(labels rtl)
    if(A_VHDL)
      list(APPEND labels vhdl)
    endif()
    icesoc_test(test_ip_${name} SOURCES ${name}_test.cpp LIBS ${libs} ${name}_slot bench fsmc hw_core icec LABELS ${labels})
  endif()
endfunction()

# What the listed cores bring, of one kind: icesoc_chip_property(OUT files)
function(icesoc_chip_property out what)
  set(all)
  foreach(name IN LISTS CHIP_CORES)
    get_property(values GLOBAL PROPERTY ICESOC_CORE_${name}_${what})
    list(APPEND all ${values})
  endforeach()
  list(REMOVE_DUPLICATES all)
  set(${out} ${all} PARENT_SCOPE)
endfunction()

# After all cores: the address map, soc_cores.vh, the library soc_cores with the firmware's table.
function(icesoc_chip)
  get_property(known GLOBAL PROPERTY ICESOC_CORES)
  set(options)
  foreach(name IN LISTS CHIP_CORES)
    if(NOT name IN_LIST known)
      message(FATAL_ERROR "${CORES}: there is no core '${name}': it needs ip/${name}/CMakeLists.txt with icesoc_core, "
                          "or its line goes")
    endif()
    get_property(regs GLOBAL PROPERTY ICESOC_CORE_${name}_regs)
    list(APPEND options --core ${name}=${regs})
    list(APPEND inputs ${regs})
  endforeach()
  add_custom_command(OUTPUT ${GEN_DIR}/map.regs.json ${GEN_DIR}/soc_cores.vh ${GEN_DIR}/soc_cores.c
                     ${GEN_DIR}/icesoc.svd ${GEN_DIR}/registers.html
    COMMAND coremap ${CORES} --base ${CMAKE_SOURCE_DIR}/bus/map.regs.json ${options}
            --block 0=system=${CMAKE_SOURCE_DIR}/hdl/system/system.regs.json
            --block 1=modem=${CMAKE_SOURCE_DIR}/hdl/modem/modem.regs.json --output-dir ${GEN_DIR}
    DEPENDS coremap ${CORES} ${CMAKE_SOURCE_DIR}/bus/map.regs.json ${inputs}
            ${CMAKE_SOURCE_DIR}/hdl/system/system.regs.json ${CMAKE_SOURCE_DIR}/hdl/modem/modem.regs.json
    VERBATIM COMMENT "Cores of the chip: ${CHIP_CORES}")
  icesoc_regmap(${GEN_DIR}/map.regs.json)
  icesoc_chip_property(libs libs)
  icesoc_c90(soc_cores SOURCES ${GEN_DIR}/soc_cores.c LIBS ${libs} hw_core regs_map icec)
endfunction()
