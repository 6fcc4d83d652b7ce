# SPDX-License-Identifier: MIT
#
# fuzz.cmake: libFuzzer programs, by clang, with address and undefined-behaviour sanitizers.

find_program(CLANG clang)
find_program(CLANGXX clang++)

# icesoc_fuzz(NAME HARNESS file.cpp SOURCES file.c... [INCLUDES dir...] [DEFINES name...] [DICT file] [RUNS n] [LABELS ...])
# The program NAME, and a test of RUNS inputs from SEED: the number of inputs decides, never the time.
function(icesoc_fuzz name)
  cmake_parse_arguments(A "" "HARNESS;DICT;RUNS" "SOURCES;INCLUDES;DEFINES;LABELS" ${ARGN})
  if(NOT CLANG OR NOT CLANGXX)
    message(WARNING "${name}: clang is missing, so it is not built; run 'make setup'")
    return()
  endif()
  set(flags -g -O1 -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined
            -fno-omit-frame-pointer)
  foreach(i IN LISTS A_INCLUDES)
    list(APPEND flags -I${i})
  endforeach()
  foreach(d IN LISTS A_DEFINES)
    list(APPEND flags -D${d})
  endforeach()
  set(dir ${CMAKE_CURRENT_BINARY_DIR}/${name}.fuzz)
  file(MAKE_DIRECTORY ${dir})
  set(objects)
  foreach(source IN LISTS A_SOURCES A_HARNESS)
    get_filename_component(path ${source} ABSOLUTE)
    get_filename_component(file ${path} NAME)
    set(compile ${CCACHE} ${CLANG} -std=c90)
    if(path MATCHES "\\.cpp$")
      set(compile ${CCACHE} ${CLANGXX} -std=c++17)
    endif()
    add_custom_command(OUTPUT ${dir}/${file}.o
      COMMAND ${compile} ${flags} -MMD -MF ${dir}/${file}.d -c ${path} -o ${dir}/${file}.o
      DEPENDS ${path} DEPFILE ${dir}/${file}.d VERBATIM COMMENT "Fuzzer ${name}: ${file}")
    list(APPEND objects ${dir}/${file}.o)
  endforeach()
  add_custom_command(OUTPUT ${dir}/run
    COMMAND ${CLANGXX} -fsanitize=fuzzer,address,undefined -o ${dir}/run ${objects}
    DEPENDS ${objects} VERBATIM COMMENT "Fuzzer ${name}")
  add_custom_target(${name} ALL DEPENDS ${dir}/run)
  set(arguments -max_len=400 -print_final_stats=0 -verbosity=0)
  if(A_DICT)
    get_filename_component(dict ${A_DICT} ABSOLUTE)
    list(APPEND arguments -dict=${dict})
  endif()
  add_test(NAME fuzz.${name} COMMAND ${CMAKE_SOURCE_DIR}/cmake/fuzz.sh
           ${dir}/run ${A_RUNS} ${arguments})
  set_tests_properties(fuzz.${name} PROPERTIES LABELS "${A_LABELS}")
endfunction()
