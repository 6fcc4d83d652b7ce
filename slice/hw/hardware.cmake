# SPDX-License-Identifier: MIT
#
# hardware.cmake: generates wrappers, registers and servants of [":hw"] interfaces
# (docs/hw-mapping.md).

# icesoc_hardware(NAME file.ice BLOCKS block... [OWN_CLOCK]) generates the wrappers
# <block>_wrapper.v and <block>_wrapper.vhd in ${GEN_DIR}, and the registers of each block as
# icesoc_regmap does. It adds the library NAME_servants and the target NAME_hardware. BLOCKS: the
# hardware interfaces of the file, in snake_case. OWN_CLOCK: each block has a clock that may stop.
function(icesoc_hardware name file)
  cmake_parse_arguments(A "OWN_CLOCK" "" "BLOCKS;INCLUDES" ${ARGN})
  get_filename_component(path ${file} ABSOLUTE)
  set(dir ${GEN_DIR})
  set(outs)
  set(sources)
  set(registers)
  foreach(b IN LISTS A_BLOCKS)
    list(APPEND outs ${dir}/${b}_wrapper.v ${dir}/${b}_wrapper.vhd ${dir}/${b}.regs.json
                     ${dir}/${b}_servant.h ${dir}/${b}_servant.c ${dir}/${b}_proxy.h)
    list(APPEND sources ${dir}/${b}_servant.c)
    list(APPEND registers regs_${b})
  endforeach()
  list(TRANSFORM A_INCLUDES PREPEND -I)
  icesoc_slice(${name} ${file} INCLUDES ${A_INCLUDES})
  add_custom_command(OUTPUT ${outs}
    COMMAND slice2c ${A_INCLUDES} ${path} --output-dir ${dir}/hw/${name} --hw-verilog ${dir}
            --hw-vhdl ${dir}
            --hw-regs ${dir} --hw-c ${dir} --hw-cpp ${dir} $<$<BOOL:${A_OWN_CLOCK}>:--hw-own-clock>
    DEPENDS slice2c ${path} VERBATIM COMMAND_EXPAND_LISTS COMMENT "Slice to hardware: ${name}")
  add_custom_target(${name}_hardware DEPENDS ${outs})
  list(TRANSFORM A_BLOCKS REPLACE "(.+)" "${dir}/\\1.regs.json" OUTPUT_VARIABLE descriptions)
  icesoc_regmap(${descriptions})
  icesoc_c90(${name}_servants SOURCES ${sources} INCLUDES ${dir}
             LIBS ${name}_server ${name}_client hw_core hw_listener ${registers})
  add_dependencies(${name}_servants ${name}_hardware)
endfunction()
