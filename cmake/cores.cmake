# SPDX-License-Identifier: MIT
#
# cores.cmake: builds IP cores, and adds the cores of ip/cores.list to the chip
# (docs/hw-mapping.md).

set(CORES ${CMAKE_SOURCE_DIR}/ip/cores.list CACHE FILEPATH "The cores in the chip, one a line")
set(CORE_FOLDERS "" CACHE STRING "Folders of cores besides those in ip/")
set(FOREIGN_CORES ${CMAKE_BINARY_DIR}/foreign
  CACHE PATH "Where icesoc.util.fetch put third-party cores")

set(MANIFEST_FILES ${REGMAP_FILES} ${TOOLS}/chip/manifest.py ${TOOLS}/chip/core.schema.json
  ${TOOLS}/util/schema.py ${TOOLS}/util/templates.py)
file(GLOB MAP_TEMPLATES CONFIGURE_DEPENDS ${TOOLS}/chip/templates/*.j2)

# Names of the cores in the list. A CMakeLists.txt that needs a core checks whether the core is in
# the list: if("vision" IN_LIST CHIP_CORES)
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
# ICE_SERVANTS is the number of servants in the object adapter: one for each servant of the vehicle
# and for each core. It is at least 8, the default in sw/icec/ice_config.h. ARM_DEFINES passes it to
# the firmware, and the library icec on the host uses the same number. ICE_CONNECTIONS is the number
# of connections: four for a ground station, four for a second ground station, and four for another
# vehicle.
set(ARM_DEFINES ICE_CONNECTIONS=12)
# The FSMC bridge of the chip, and the driver's settings for it (docs/fsmc.md).
set(BRIDGE async CACHE STRING "FSMC bridge: async, or sync for a bridge that samples its pins")
if(NOT BRIDGE MATCHES "^(async|sync)$")
  message(FATAL_ERROR "BRIDGE=${BRIDGE}: expected async or sync")
endif()
if(BRIDGE STREQUAL sync)
  list(APPEND ARM_DEFINES FSMC_SYNC)
endif()
set(header ${CMAKE_SOURCE_DIR}/sw/vehicle/uav_tasks.h)
set_property(DIRECTORY ${CMAKE_SOURCE_DIR} APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${header})
file(STRINGS ${header} servants REGEX "^#define UAV_SERVANTS ")
string(REGEX REPLACE "[^0-9]" "" servants "${servants}")
math(EXPR servants "${instances} + ${servants}")
if(servants GREATER 8)
  list(APPEND ARM_DEFINES ICE_SERVANTS=${servants})
endif()

# Macros that icesoc_core calls. They use the variables of icesoc_core. Each handles one part of a
# core: C code from a Slice file, in a folder of GEN_DIR; registers, wrapper and servant; a separate
# clock; the block test.
macro(icesoc_core_slice folder file)
  get_filename_component(base ${file} NAME_WE)
  set(slice ${GEN_DIR}/slice/${folder})
  list(APPEND arm_sources ${slice}/${base}_types.c ${slice}/${base}_client.c
                          ${slice}/${base}_server.c)
  list(APPEND arm_includes ${slice})
  list(APPEND arm_targets ${folder}_slice)
endmacro()
macro(icesoc_core_software)
  if(A_ICE)
    set(own)
    if(A_CLOCK)
      set(own OWN_CLOCK)
    endif()
    icesoc_hardware(${name} ${A_ICE} BLOCKS ${name} INCLUDES ${A_INCLUDES} ${own})
    set(regs ${GEN_DIR}/${name}.regs.json)
    if(A_VHDL)
      set(wrapper ${GEN_DIR}/${name}_wrapper.vhd)
    else()
      list(APPEND files ${GEN_DIR}/${name}_wrapper.v)
    endif()
    list(APPEND targets ${name}_hardware)
    list(APPEND arm_sources ${GEN_DIR}/${name}_servant.c)
    icesoc_core_slice(${name} ${A_ICE})
    list(APPEND arm_targets ${name}_hardware)
    list(APPEND slices ${name}_slice)
    list(APPEND libs ${name}_servants)
  else()
    set(block BLOCK)
    if(A_WINDOW)
      set(block)
    elseif(A_VHDL)
      set(wrapper ${GEN_DIR}/${name}_regs.vhd)
    else()
      list(APPEND files ${GEN_DIR}/${name}_regs.v)
    endif()
    if(NOT TARGET regmap_${name})
      icesoc_regmap(${A_REGS} ${block})
    endif()
    get_filename_component(regs ${A_REGS} ABSOLUTE)
    list(APPEND targets regmap_${name})
    list(APPEND libs regs_${name})
    if(A_SERVANT)
      set(servers)
      foreach(s IN LISTS A_SLICE)
        get_filename_component(base ${s} NAME_WE)
        if(s MATCHES "[.]ice$")
          icesoc_slice(${base} ${s})
          icesoc_core_slice(${base} ${s})
        endif()
        list(APPEND servers ${base}_server)
        list(APPEND slices ${base}_slice)
      endforeach()
      icesoc_c90(${name}_servants SOURCES ${A_SERVANT}
                 LIBS ${servers} hw_core regs_${name})
      list(APPEND libs ${name}_servants)
    else()
      list(APPEND slices Registers_slice)
      list(APPEND libs hw_registers)
    endif()
  endif()
endmacro()
macro(icesoc_core_clock)
  set(top ${name})
  set(hz 100000000)
  if(A_CLOCK)
    set(top ${name}_clocked)
    set(hz ${A_CLOCK})
    add_custom_command(OUTPUT ${GEN_DIR}/${top}.v
      COMMAND ${PYTHON} -m icesoc.chip.clocked ${manifest} ${regs} ${GEN_DIR}/${top}.v
      DEPENDS ${MANIFEST_FILES} ${TOOLS}/chip/clocked.py ${TOOLS}/chip/core_output.py
        ${MAP_TEMPLATES} ${manifest} ${regs}
      VERBATIM COMMENT "${name} in its own clock")
    add_custom_target(${top}_verilog DEPENDS ${GEN_DIR}/${top}.v)
    list(APPEND files ${GEN_DIR}/${top}.v)
    list(APPEND targets ${top}_verilog)
  endif()
endmacro()
macro(icesoc_core_test)
  set(clock)
  if(A_CLK_HZ)
    set(clock CLK_HZ=${hz})
  endif()
  file(GLOB test CONFIGURE_DEPENDS ${folder}/${name}_test.cpp)
  if(A_TESTS)
    set(test ${A_TESTS})
  endif()
  if(test AND "testbench" IN_LIST ROOMS)
    if(NETLIST AND NOT A_CLOCK)
      icesoc_netlist(${name}_slot DESIGN ${top} DEPENDS ${targets} ${checks})
    else()
      icesoc_verilate(${name}_slot TOP ${top} SOURCES ${files} DEPENDS ${targets}
                      CHECKS ${checks}
                      FLAGS ${A_FLAGS} ${CORE_TEST_FLAGS} EDITED
                      PARAMS ${clock} INCLUDES ${CMAKE_SOURCE_DIR}/bus ${CMAKE_SOURCE_DIR}/hdl/ddr
                        ${CMAKE_SOURCE_DIR}/hdl/system ${CMAKE_SOURCE_DIR}/hdl/cdc
                        ${folder})
    endif()
    set(state ${CMAKE_CURRENT_BINARY_DIR}/verilated_${name}_slot/V${name}_slot)
    add_custom_command(OUTPUT ${state}_state.h
      COMMAND awk -v top=${top}__DOT__ -v class=V${name}_slot -v slot=1 -f ${STATE_MEMBERS}
        ${state}___024root.h > ${state}_state.h
      DEPENDS ${STATE_MEMBERS} ${state}___024root.h VERBATIM)
    # As a part of the test program only, this command would wait for all libraries of the program.
    add_custom_target(${name}_slot_state DEPENDS ${state}_state.h)
    set(labels rtl)
    if(A_VHDL)
      list(APPEND labels vhdl)
    endif()
    icesoc_test(test_ip_${name} SOURCES ${test} ${state}_state.h
      LIBS ${libs} ${name}_slot bench fsmc hw_core icec LABELS ${labels})
    icesoc_core_program(test_ip_${name})
    if(A_CLK_HZ)
      set(clock CORE_CLK_HZ=100000000)
    endif()
    if(A_CLOCK)
      list(APPEND clock CORE_OWN_HZ=${A_CLOCK}u)
      icesoc_uncertain(test_ip_${name} 1)
    endif()
    target_compile_definitions(test_ip_${name} PRIVATE ${clock})
    icesoc_tested(${name} test_ip_${name})
  endif()
endmacro()

# icesoc_tested(CORE PROGRAM): adds a program of a core's tests, which `./icesoc core test` builds.
function(icesoc_tested core program)
  if(TARGET tests_of_${core})
    add_dependencies(tests_of_${core} ${program})
    set_property(GLOBAL APPEND PROPERTY ICESOC_TESTED_CORES ${core})
  endif()
endfunction()

# icesoc_read_manifests(FILE...): reads the manifests of several cores in one call of Python. A
# later icesoc_core() uses the stored result. Without a stored result, icesoc_core() starts Python
# to read its own manifest, and starting Python takes longer than reading.
function(icesoc_read_manifests)
  execute_process(COMMAND ${PYTHON} -m icesoc.chip.manifest ${ARGN}
    OUTPUT_VARIABLE facts ERROR_VARIABLE error RESULT_VARIABLE status)
  if(status)
    message(FATAL_ERROR "${error}")
  endif()
  cmake_language(EVAL CODE "${facts}")
endfunction()

# icesoc_core([FOLDER]): adds the core described by core.toml in FOLDER (default: the current source
# folder); docs/hw-mapping.md lists the keys. The core is a module or entity that has the ports of a
# slot and the name given in the manifest. If the core has a test, this function also adds the
# target test_ip_<NAME> and the model V<NAME>_slot.
function(icesoc_core)
  set(folder ${CMAKE_CURRENT_SOURCE_DIR})
  if(ARGC)
    set(folder ${ARGV0})
  endif()
  set(manifest ${folder}/core.toml)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${manifest} ${MANIFEST_FILES})
  get_property(facts GLOBAL PROPERTY ICESOC_FACTS_${manifest})
  if(NOT facts)
    icesoc_read_manifests(${manifest})
    get_property(facts GLOBAL PROPERTY ICESOC_FACTS_${manifest})
  endif()
  cmake_language(EVAL CODE "${facts}")
  set(A_DEPENDS)
  set(checks)
  foreach(entity IN LISTS A_ENTITIES)
    icesoc_vhdl(NAME ${entity} ${A_ENTITY_${entity}})
    list(APPEND A_VERILOG ${GEN_DIR}/${entity}.v)
    list(APPEND checks ${GEN_DIR}/${entity}.no_latches)
    list(APPEND A_DEPENDS ${entity}_verilog)
  endforeach()
  if(A_IDLE)
    set_property(GLOBAL APPEND PROPERTY ICESOC_IDLE_CORES ${name})
  endif()
  set(files ${A_VERILOG})
  set(headers ${A_VERILOG}) # the sources include the headers, so headers are not passed as sources
  list(FILTER files EXCLUDE REGEX "[.]([sS]?[vV]?[hH]|[iI][nN][cC])$")
  list(FILTER headers INCLUDE REGEX "[.]([sS]?[vV]?[hH]|[iI][nN][cC])$")
  set(targets ${A_DEPENDS})
  set(wrapper)
  set(arm_sources ${A_SERVANT})
  set(arm_includes ${folder} ${CMAKE_SOURCE_DIR}/sw/hw)
  set(arm_targets)
  set(libs)
  set(slices)
  icesoc_core_software()
  if(A_VHDL)
    set(registers)
    if(A_REGS)
      set(registers REGS ${name})
    endif()
    icesoc_vhdl(NAME ${name} SOURCES ${wrapper} ${A_VHDL}
                ${CMAKE_SOURCE_DIR}/hdl/ddr/npi_stream_pkg.vhd ${registers})
    list(APPEND files ${GEN_DIR}/${name}.v)
    list(APPEND targets ${name}_verilog)
    list(APPEND checks ${GEN_DIR}/${name}.no_latches)
    # GHDL writes an `open` port as a port with empty parentheses
    list(APPEND A_FLAGS -Wno-PINCONNECTEMPTY)
  endif()
  icesoc_core_clock()
  foreach(what files headers targets checks regs libs manifest slices
               arm_sources arm_includes arm_targets)
    set_property(GLOBAL PROPERTY ICESOC_CORE_${name}_${what} ${${what}})
  endforeach()
  set_property(GLOBAL PROPERTY ICESOC_CORE_${name}_flags ${A_FLAGS})
  set_property(GLOBAL APPEND PROPERTY ICESOC_CORES ${name})
  add_custom_target(tests_of_${name}) # programs of the core's tests
  icesoc_core_test()
endfunction()

# icesoc_core_folder(FOLDER BINARY): adds the core in FOLDER. Most cores need only a manifest. A
# core that needs more, such as models, has a CMakeLists.txt that begins with icesoc_core().
function(icesoc_core_folder folder binary)
  if(NOT EXISTS ${folder}/CMakeLists.txt)
    set(text "# Generated: the core of ${folder}/core.toml.\nicesoc_core(${folder})\n")
    file(CONFIGURE OUTPUT ${binary}/source/CMakeLists.txt CONTENT "${text}")
    set(folder ${binary}/source)
  endif()
  add_subdirectory(${folder} ${binary})
endfunction()

# icesoc_chip_property(OUT KIND): collects in OUT the values of
# the property KIND (files, slices, ...) from all cores in the list.
function(icesoc_chip_property out what)
  set(all)
  foreach(name IN LISTS CHIP_CORES)
    get_property(values GLOBAL PROPERTY ICESOC_CORE_${name}_${what})
    list(APPEND all ${values})
  endforeach()
  list(REMOVE_DUPLICATES all)
  set(${out} ${all} PARENT_SCOPE)
endfunction()

# icesoc_chip(): generates the address map, soc_cores.vh, and the library soc_cores, which contains
# the firmware's table of cores. Call it after all cores have been added.
function(icesoc_chip)
  get_property(known GLOBAL PROPERTY ICESOC_CORES)
  set(options)
  foreach(name IN LISTS CHIP_CORES)
    if(NOT name IN_LIST known)
      message(FATAL_ERROR "${CORES}: no core '${name}': add ip/${name}/core.toml "
        "(./icesoc core new ${name}) or remove the line")
    endif()
    get_property(regs GLOBAL PROPERTY ICESOC_CORE_${name}_regs)
    get_property(manifest GLOBAL PROPERTY ICESOC_CORE_${name}_manifest)
    list(APPEND options --core=${name}=${manifest}=${regs})
    get_property(slices GLOBAL PROPERTY ICESOC_CORE_${name}_slices)
    foreach(s IN LISTS slices)
      if(TARGET slice2c)
        list(APPEND options "--slice=${name}=$<TARGET_PROPERTY:${s},SLICE_FILE>")
      endif()
    endforeach()
    get_filename_component(folder ${manifest} DIRECTORY)
    file(GLOB own CONFIGURE_DEPENDS ${folder}/*.ucf)
    list(APPEND inputs ${manifest} ${regs} ${own})
  endforeach()
  # Building the chip runs this check that no two files contain a module of the same name. The
  # simulator's model takes it as one of its CHECKS.
  icesoc_chip_property(files files)
  icesoc_chip_property(targets targets)
  add_custom_command(OUTPUT ${GEN_DIR}/cores.checked
    COMMAND ${PYTHON} -m icesoc.cores.foreign_files ${files}
    COMMAND ${CMAKE_COMMAND} -E touch ${GEN_DIR}/cores.checked
    DEPENDS ${files} ${targets} ${TOOLS}/cores/foreign_files.py
    VERBATIM COMMENT "Modules of the chip's cores")
  add_custom_target(cores_checked DEPENDS ${GEN_DIR}/cores.checked)
  # The Slice files of all cores must be compatible, because one program contains all of them.
  icesoc_chip_property(slices slices)
  set(check)
  set(slice_files)
  if(TARGET slice2c AND slices)
    set(slice_includes)
    foreach(s IN LISTS slices)
      list(APPEND slice_files "$<TARGET_PROPERTY:${s},SLICE_FILE>")
      list(APPEND slice_includes "$<TARGET_PROPERTY:${s},SLICE_INCLUDES>")
    endforeach()
    set(check COMMAND slice2c --one-program ${slice_includes} ${slice_files})
  endif()
  add_custom_command(OUTPUT ${GEN_DIR}/map.regs.json ${GEN_DIR}/soc_cores.vh ${GEN_DIR}/soc_cores.c
                     ${GEN_DIR}/soc_pins.h ${GEN_DIR}/core_pins.vh ${GEN_DIR}/core_pins.ucf
                     ${GEN_DIR}/icesoc.svd ${GEN_DIR}/chip.json ${GEN_DIR}/icesoc.rdl
                     ${GEN_DIR}/icesoc.ipxact.xml
                     ${check}
    COMMAND ${PYTHON} -m icesoc.chip.coremap ${CORES}
            --base ${CMAKE_SOURCE_DIR}/bus/map.regs.json ${options}
            --block 0=system=${CMAKE_SOURCE_DIR}/hdl/system/system.regs.json
            --block 1=modem=${CMAKE_SOURCE_DIR}/hdl/modem/modem.regs.json --output-dir ${GEN_DIR}
    DEPENDS ${MANIFEST_FILES} ${TOOLS}/chip/collisions.py ${TOOLS}/chip/coremap.py
            ${TOOLS}/chip/core_output.py ${TOOLS}/chip/model.py ${TOOLS}/util/chip.py
            ${MAP_TEMPLATES}
            ${CORES} ${CMAKE_SOURCE_DIR}/bus/map.regs.json
            ${inputs} ${CMAKE_SOURCE_DIR}/hdl/system/system.regs.json
            ${CMAKE_SOURCE_DIR}/hdl/modem/modem.regs.json ${slice_files}
    COMMAND_EXPAND_LISTS VERBATIM COMMENT "Cores of the chip: ${CHIP_CORES}")
  icesoc_regmap(${GEN_DIR}/map.regs.json)
  icesoc_chip_property(libs libs)
  icesoc_c90(soc_cores SOURCES ${GEN_DIR}/soc_cores.c
    LIBS ${libs} hw_core regs_map Registers_server icec)
endfunction()
