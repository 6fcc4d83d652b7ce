# SPDX-License-Identifier: MIT
#
# arm.cmake: compiles C90 and assembly for the Cortex-M3 with GCC's bare-metal toolchain. icesoc_c90
# (icesoc.cmake) compiles the same sources for the host.

icesoc_needs(gcc-arm-none-eabi ARM_GCC program arm-none-eabi-gcc)
icesoc_needs(binutils-arm-none-eabi ARM_SIZE program arm-none-eabi-size)
icesoc_needs(libnewlib-arm-none-eabi ARM_LIBC path newlib/string.h)
icesoc_needs(binutils-arm-none-eabi ARM_OBJCOPY program arm-none-eabi-objcopy)

set(ARM_FLAGS -mcpu=cortex-m3 -mthumb -Os -g -ffunction-sections -fdata-sections -fno-common
    -fstack-usage -fcallgraph-info=su ${SAME_BYTES})

# icesoc_arm_objects(OUT name SOURCES file... [INCLUDES dir...] [DEFINES NAME=value...]
#                    [OPTIONS ...] [DEPENDS target...] [FOREIGN])
# Compiles the sources and stores the paths of the objects in the variable OUT. FOREIGN: third-party
# code, compiled without our warnings.
function(icesoc_arm_objects out name)
  cmake_parse_arguments(A "FOREIGN" "" "SOURCES;INCLUDES;DEFINES;OPTIONS;DEPENDS" ${ARGN})
  set(dir ${CMAKE_CURRENT_BINARY_DIR}/${name}.arm)
  list(TRANSFORM A_INCLUDES PREPEND -I)
  list(TRANSFORM A_DEFINES PREPEND -D)
  string(REGEX MATCHALL "-isystem;[^;]+" others "${A_OPTIONS}")
  list(TRANSFORM others REPLACE ";" "")
  icesoc_for_editors(SOURCES ${A_SOURCES}
    OPTIONS --target=arm-none-eabi -mcpu=cortex-m3 -mthumb ${C90_WARNINGS} ${A_INCLUDES}
      ${A_DEFINES} ${others} -isystem${ARM_LIBC}/newlib)
  set(objects)
  foreach(source IN LISTS A_SOURCES)
    get_filename_component(path ${source} ABSOLUTE)
    get_filename_component(folder ${path} DIRECTORY)
    get_filename_component(folder ${folder} NAME)
    get_filename_component(file ${path} NAME)
    set(object ${dir}/${folder}/${file}.o)
    file(MAKE_DIRECTORY ${dir}/${folder})
    set(own)
    if(NOT A_FOREIGN AND path MATCHES "\\.c$")
      set(own ${C90_WARNINGS})
    elseif(A_FOREIGN)
      set(own -w)
    endif()
    add_custom_command(OUTPUT ${object}
      COMMAND ${CCACHE} ${ARM_GCC} ${ARM_FLAGS} ${A_INCLUDES} ${A_DEFINES} ${own} ${A_OPTIONS}
        -MMD -MF ${object}.d -c ${path} -o ${object}
      DEPENDS ${path} ${A_DEPENDS} DEPFILE ${object}.d VERBATIM COMMENT "ARM: ${folder}/${file}")
    list(APPEND objects ${object})
  endforeach()
  set(${out} ${objects} PARENT_SCOPE)
endfunction()

# icesoc_arm_program(NAME SCRIPT file.ld OBJECTS ... [OPTIONS ...]): adds the target firmware_NAME.
# It links NAME.elf, which contains its own checksum, and writes a map file. Both are in
# ${CMAKE_BINARY_DIR}/firmware.
function(icesoc_arm_program name)
  cmake_parse_arguments(A "" "SCRIPT" "OBJECTS;OPTIONS" ${ARGN})
  set(dir ${CMAKE_BINARY_DIR}/firmware)
  file(MAKE_DIRECTORY ${dir})
  add_custom_command(OUTPUT ${dir}/${name}.elf
    COMMAND ${ARM_GCC} -mcpu=cortex-m3 -mthumb -nostartfiles --specs=nano.specs
            -T ${A_SCRIPT} ${A_OPTIONS} -Wl,--gc-sections -Wl,-Map=${dir}/${name}.map
            -Wl,--fatal-warnings -o ${dir}/${name}.elf ${A_OBJECTS}
    COMMAND pack_update stamp ${dir}/${name}.elf
    COMMAND ${ARM_OBJCOPY} -O binary ${dir}/${name}.elf ${dir}/${name}.bin
    DEPENDS ${A_OBJECTS} ${A_SCRIPT} pack_update BYPRODUCTS ${dir}/${name}.map ${dir}/${name}.bin
    VERBATIM COMMENT "Firmware: ${name}.elf")
  add_custom_target(firmware_${name} DEPENDS ${dir}/${name}.elf)
endfunction()
