# SPDX-License-Identifier: MIT
#
# icesoc-hdl: the component with the reusable blocks of the FPGA. For each block, one declaration
# below generates a FuseSoC core file (CAPI 2) and a plain file list.
set(component icesoc-hdl)
set(HDL ${SHARE}/hdl)
set(hdl_out ${CMAKE_CURRENT_BINARY_DIR}/hdl)

# icesoc_hdl_core(NAME TOP module PURPOSE text FILES file... [INCLUDES file...] [DEPENDS block...]
#                 [CONSTRAINTS file...])
# Adds a block. Each file is given as FOLDER/FILE. FOLDER is either bus or a folder of hdl/ such as
# cdc; for a generated file, it is the folder into which the file is installed. Sets
# CORE_FILES_<name> and CORE_FOLDERS_<name>, which the file lists of dependent blocks use.
function(icesoc_hdl_core name)
  cmake_parse_arguments(A "" "TOP;PURPOSE" "FILES;INCLUDES;DEPENDS;CONSTRAINTS" ${ARGN})
  set(core "CAPI=2:\n# SPDX-License-Identifier: MIT\nname: icesoc:hdl:${name}:${ICESOC_VERSION}\n"
    "description: ${A_PURPOSE}\nfilesets:\n  rtl:\n    file_type: verilogSource-2005\n"
    "    files:\n")
  set(list)
  set(folders)
  foreach(file IN LISTS A_INCLUDES)
    get_filename_component(folder ${file} DIRECTORY)
    list(APPEND folders "+incdir+\${ICESOC_HDL}/${folder}")
    list(APPEND core "      - ${file}: {is_include_file: true, include_path: ${folder}}\n")
  endforeach()
  foreach(file IN LISTS A_FILES)
    list(APPEND core "      - ${file}\n")
    list(APPEND list "\${ICESOC_HDL}/${file}")
  endforeach()
  if(A_DEPENDS)
    list(APPEND core "    depend:\n")
    foreach(block IN LISTS A_DEPENDS)
      list(APPEND core "      - icesoc:hdl:${block}:${ICESOC_VERSION}\n")
      list(PREPEND list ${CORE_FILES_${block}})
      list(PREPEND folders ${CORE_FOLDERS_${block}})
    endforeach()
  endif()
  set(constrained)
  if(A_CONSTRAINTS)
    set(constrained ", constraints")
    list(APPEND core "  constraints:\n    files:\n")
    foreach(file IN LISTS A_CONSTRAINTS)
      set(type UCF)
      if(file MATCHES "tcl$")
        set(type tclSource)
      endif()
      list(APPEND core "      - constraints/${file}: {file_type: ${type}}\n")
    endforeach()
  endif()
  list(APPEND core "targets:\n  default:\n    filesets: [rtl]\n  synth:\n"
    "    filesets: [rtl${constrained}]\n    toplevel: ${A_TOP}\n  lint:\n    filesets: [rtl]\n"
    "    toplevel: ${A_TOP}\n    default_tool: verilator\n    tools:\n      verilator:\n"
    "        mode: lint-only\n")
  list(REMOVE_DUPLICATES folders)
  list(REMOVE_DUPLICATES list)
  set(CORE_FILES_${name} ${list} PARENT_SCOPE)
  set(CORE_FOLDERS_${name} ${folders} PARENT_SCOPE)
  string(CONCAT core ${core})
  file(CONFIGURE OUTPUT hdl/icesoc-${name}.core CONTENT "${core}" @ONLY)
  string(JOIN "\n" text "// ${name}: ${A_PURPOSE}. Top: ${A_TOP}."
    "// The variable ICESOC_HDL of the environment is this file's folder, for example"
    "// ICESOC_HDL=/usr/share/icesoc/hdl iverilog -g2005 -f /usr/share/icesoc/hdl/${name}.f"
    ${folders} ${list} "")
  file(CONFIGURE OUTPUT hdl/${name}.f CONTENT "${text}" @ONLY)
  install(FILES ${hdl_out}/icesoc-${name}.core ${hdl_out}/${name}.f DESTINATION ${HDL}
    COMPONENT ${component})
  foreach(file IN LISTS A_FILES A_INCLUDES)
    get_filename_component(folder ${file} DIRECTORY)
    get_filename_component(base ${file} NAME)
    set(path ${top}/hdl/${file})
    if(folder STREQUAL "bus")
      set(path ${top}/${file})
    elseif(NOT EXISTS ${path}) # generated
      set(path ${GEN_DIR}/${base})
    endif()
    install(FILES ${path} DESTINATION ${HDL}/${folder} COMPONENT ${component})
  endforeach()
endfunction()

function(in_folder variable folder)
  list(TRANSFORM ARGN PREPEND ${folder}/)
  set(${variable} ${ARGN} PARENT_SCOPE)
endfunction()

in_folder(files cdc cdc_skew.v cdc_bit.v cdc_bus.v cdc_copy.v cdc_pending.v cdc_pulse.v
  cdc_reset.v async_fifo.v)
icesoc_hdl_core(cdc TOP async_fifo FILES ${files} INCLUDES cdc/cdc_random.vh
  CONSTRAINTS cdc.tcl PURPOSE "Clock-domain crossings, synchronisers, pulses, buses and a FIFO")

in_folder(files bus bus_decoder.v bus_registers.v bus_wrapper.v bus_window.v
  bus_crossing_core.v bus_crossing.v bus_to_wishbone.v bus_to_axi4lite.v)
icesoc_hdl_core(bus TOP bus_decoder FILES ${files}
  INCLUDES bus/slot_ports.vh bus/slot_connect.vh bus/wrong_parameter.vh
  DEPENDS cdc PURPOSE "Register bus, its decoder, slots, and adapters to Wishbone and AXI4-Lite")

in_folder(files ddr npi_fifo.v npi_write_fifo.v npi_queue.v npi_select.v npi_arbiter.v
  npi_stream.v)
in_folder(includes ddr count_up.vh shift_order.vh npi_ports.vh memory_ports.vh memory_connect.vh)
icesoc_hdl_core(npi_arbiter TOP npi_arbiter FILES ${files}
  INCLUDES ${includes} bus/wrong_parameter.vh
  PURPOSE "Arbiter between 64-bit memory ports (NPI)")

in_folder(files ddr mcb_backend.v memory_mcb.v)
icesoc_hdl_core(memory_mcb TOP memory_mcb FILES ${files} INCLUDES ddr/mcb_ports.vh
  DEPENDS npi_arbiter PURPOSE "Memory controller of several ports on the Spartan-6 memory block")

in_folder(files fsmc fsmc_parameter_rules.v fsmc_timeout.v fsmc_nwait.v fsmc_found.v fsmc_post.v
  fsmc_memory.v fsmc_registers.v fsmc_bridge.v fsmc_sync_bridge.v)
in_folder(includes ddr count_up.vh shift_order.vh memory_ports.vh)
icesoc_hdl_core(fsmc_bridge TOP fsmc_bridge FILES ${files}
  INCLUDES ${includes} bus/wrong_parameter.vh
  DEPENDS cdc CONSTRAINTS platform.ucf
  PURPOSE "Bridge from the FSMC bus of an STM32 to memory and registers")

in_folder(files modem modem_baud.v modem_timer.v modem_ring.v modem_uart_tx.v modem_uart_rx.v
  modem_at_rows.v modem_at.v modem_api_tx.v modem_api_rx.v modem_tx.v modem_rx.v modem_npi.v
  modem_regs.v modem.v)
in_folder(includes ddr count_up.vh shift_order.vh memory_ports.vh)
icesoc_hdl_core(modem TOP modem FILES ${files} INCLUDES ${includes} modem/modem_regs.vh
  DEPENDS bus CONSTRAINTS platform.ucf
  PURPOSE "Controller of an XBee modem, which receives packets into memory")

install(FILES ${top}/synth/ise/chip.ucf DESTINATION ${HDL}/constraints RENAME platform.ucf
  COMPONENT ${component})
install(FILES ${here}/hdl/cdc.tcl DESTINATION ${HDL}/constraints COMPONENT ${component})
list(APPEND installable regmap_modem)
