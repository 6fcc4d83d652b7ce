# SPDX-License-Identifier: MIT
#
# fuzz.cmake: builds libFuzzer programs with clang, with address and undefined-behaviour sanitizers.

# icesoc_fuzz(NAME HARNESS file.cpp SOURCES file... [INCLUDES dir...] [DEFINES name...] RUNS n
#             [SEEDS file-or-folder] [DICT file] [LENGTH bytes] [LIBS file...] [LABELS ...]
#             [DEPENDS ...])
# Builds the program NAME, and adds the test FOLDER.fuzz.NAME (icesoc_test_folder), which runs RUNS
# inputs of up to LENGTH bytes (default 400). The inputs in SEEDS run first; the others are random
# and depend only on the environment variable SEED. The test ends after RUNS inputs, however long
# they take.
function(icesoc_fuzz name)
  cmake_parse_arguments(A "" "HARNESS;DICT;RUNS;SEEDS;LENGTH"
    "SOURCES;INCLUDES;DEFINES;LIBS;LABELS;DEPENDS" ${ARGN})
  list(TRANSFORM A_INCLUDES PREPEND -I)
  list(TRANSFORM A_DEFINES PREPEND -D)
  icesoc_for_editors(SOURCES ${A_HARNESS} OPTIONS ${A_INCLUDES} ${A_DEFINES})
  set(flags -g -O1 -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined
            -fno-omit-frame-pointer ${A_INCLUDES} ${A_DEFINES})
  set(dir ${CMAKE_CURRENT_BINARY_DIR}/${name}.fuzz)
  file(MAKE_DIRECTORY ${dir})
  set(objects)
  foreach(source IN LISTS A_SOURCES A_HARNESS)
    get_filename_component(path ${source} ABSOLUTE)
    get_filename_component(file ${path} NAME)
    get_filename_component(folder ${path} DIRECTORY)
    get_filename_component(folder ${folder} NAME)
    set(object ${dir}/${folder}_${file}.o)
    set(compile ${CCACHE} ${CLANG} -std=c90)
    if(path MATCHES "\\.cpp$")
      set(compile ${CCACHE} ${CLANGXX} -std=c++17)
    endif()
    add_custom_command(OUTPUT ${object}
      COMMAND ${compile} ${flags} -MMD -MF ${object}.d -c ${path} -o ${object}
      DEPENDS ${path} ${A_DEPENDS} DEPFILE ${object}.d VERBATIM COMMENT "Fuzzer ${name}: ${file}")
    list(APPEND objects ${object})
  endforeach()
  add_custom_command(OUTPUT ${dir}/run
    COMMAND ${CLANGXX} -fsanitize=fuzzer,address,undefined -o ${dir}/run ${objects} ${A_LIBS}
    DEPENDS ${objects} ${A_DEPENDS} VERBATIM COMMENT "Fuzzer ${name}")
  add_custom_target(fuzz_${name} ALL DEPENDS ${dir}/run ${A_DEPENDS})
  if(NOT A_LENGTH)
    set(A_LENGTH 400)
  endif()
  set(options -max_len=${A_LENGTH} -verbosity=0)
  if(A_DICT)
    get_filename_component(dict ${A_DICT} ABSOLUTE)
    list(APPEND options -dict=${dict})
  endif()
  set(seeds -)
  if(A_SEEDS)
    get_filename_component(seeds ${A_SEEDS} ABSOLUTE)
  endif()
  icesoc_test_folder(test)
  add_test(NAME ${test}.fuzz.${name}
    COMMAND ${CMAKE_SOURCE_DIR}/cmake/fuzz.sh ${dir}/run ${A_RUNS} ${seeds} ${options})
  set_tests_properties(${test}.fuzz.${name} PROPERTIES LABELS "${A_LABELS};fuzz")
endfunction()
