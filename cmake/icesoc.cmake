# SPDX-License-Identifier: MIT
#
# icesoc.cmake: the functions that build each kind of source.

# icesoc_needs(PACKAGE VARIABLE program|library|path NAME): finds a file of a Debian package, or
# stops with an error that names the package. A missing package is always an error, so that every
# machine has the same list of tests. Programs that only a test script uses (gdb-multiarch, xmllint)
# are not checked here.
function(icesoc_needs package variable kind name)
  cmake_language(CALL find_${kind} ${variable} ${name})
  if(NOT ${variable})
    message(FATAL_ERROR "${name} is missing (Debian: ${package}): run './icesoc setup'")
  endif()
endfunction()
# CMake configures again after packages were installed, removed or upgraded.
set(packages /var/lib/dpkg/status)
if(DEFINED ENV{DPKG_ADMINDIR})
  set(packages $ENV{DPKG_ADMINDIR}/status)
endif()
if(EXISTS ${packages})
  set_property(DIRECTORY ${CMAKE_SOURCE_DIR} APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${packages})
endif()

# Environment in which ccache caches what includes a precompiled header.
set(CCACHE_WITH_HEADER CCACHE_PCH_EXTSUM=1 CCACHE_SLOPPINESS=pch_defines,time_macros)
find_program(CCACHE ccache)
if(CCACHE)
  set(CMAKE_C_COMPILER_LAUNCHER ${CCACHE})
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE})
else()
  message(STATUS "ccache is missing (Debian: ccache): each new build folder compiles everything "
    "itself")
endif()
# LLD links the simulator in a fifth of the time of GNU ld. Packages, coverage and sanitizers use
# GNU ld.
find_program(LLD ld.lld)
if(LLD AND NOT PORTABLE AND NOT COVERAGE AND NOT SANITIZE)
  add_link_options(-fuse-ld=lld)
endif()
icesoc_needs(verilator VERILATOR program verilator)
icesoc_needs(iverilog IVERILOG program iverilog)
icesoc_needs(yosys YOSYS program yosys)
icesoc_needs(clang CLANG program clang)
icesoc_needs(clang CLANGXX program clang++)
find_package(GTest REQUIRED)
include(GoogleTest)

# Runs Python with the modules of this tree, for example ${PYTHON} -m icesoc.regs.generate
set(PYTHON ${CMAKE_SOURCE_DIR}/tools/python)
set(TOOLS ${CMAKE_SOURCE_DIR}/tools/icesoc)
set(FETCH ${PYTHON} -m icesoc.util.fetch)
set(FETCH_FILES ${TOOLS}/__init__.py ${TOOLS}/util/fetch.py ${TOOLS}/util/download.py)

# Code is compiled for the CPU of this machine or, with PORTABLE (for packages), for any CPU of this
# architecture.
set(TUNE -march=native)
set(SAME_BYTES)
if(PORTABLE)
  set(TUNE)
  include(same_bytes)
endif()
set(GEN_DIR ${CMAKE_BINARY_DIR}/gen)
file(MAKE_DIRECTORY ${GEN_DIR})
# gtest_discover_tests runs the binary at ctest time, so a build never runs a test.
set(CMAKE_GTEST_DISCOVER_TESTS_DISCOVERY_MODE PRE_TEST)

set(HOST_WARNINGS -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion)
# Compiling tools and tests takes longer than running them, mostly because of library templates, so
# they are optimised less.
set(TOOL_OPTIONS ${HOST_WARNINGS} -O1)
set(C90_WARNINGS -std=c90 -pedantic -Wall -Wextra -Wconversion -Wstrict-prototypes
    -Wmissing-prototypes -Wdeclaration-after-statement -Werror)
if(COVERAGE)
  # -g: without debug information, gcov misses lines
  add_compile_options(-g --coverage -fprofile-update=atomic)
  add_link_options(--coverage)
endif()
if(SANITIZE STREQUAL "thread")
  add_compile_options(-g1 -fsanitize=thread -fno-omit-frame-pointer)
  add_link_options(-fsanitize=thread)
elseif(SANITIZE)
  add_compile_options(-g1 -fsanitize=address,undefined -fno-sanitize-recover=undefined
                      -fno-omit-frame-pointer)
  add_link_options(-fsanitize=address,undefined)
endif()

# icesoc_folders(PATTERN...): adds each folder that matches a pattern and has a CMakeLists.txt, in
# the order of the names.
function(icesoc_folders)
  list(TRANSFORM ARGN APPEND /CMakeLists.txt)
  file(GLOB found CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} ${ARGN})
  foreach(folder IN LISTS found)
    get_filename_component(folder ${folder} DIRECTORY)
    add_subdirectory(${folder})
  endforeach()
endfunction()

# icesoc_quickly(TARGET... [HEADER file]): compiles C++ that is not optimised with Clang, which
# takes 0.6 of the time of g++. HEADER is a precompiled header. CMake's compiler is used for
# packages, coverage and sanitizers.
function(icesoc_quickly)
  cmake_parse_arguments(A "" "HEADER" "" ${ARGN})
  if(NOT PORTABLE AND NOT COVERAGE AND NOT SANITIZE)
    set(launcher ${CMAKE_CXX_COMPILER_LAUNCHER} ${CLANGXX})
    if(A_HEADER)
      set(launcher env ${CCACHE_WITH_HEADER} ${launcher} -include-pch ${A_HEADER}
        -Xclang -fno-pch-timestamp)
    endif()
    set_target_properties(${A_UNPARSED_ARGUMENTS} PROPERTIES CXX_COMPILER_LAUNCHER
      "${CMAKE_SOURCE_DIR}/cmake/other_compiler.sh;${launcher};--")
  endif()
endfunction()

# icesoc_c90(NAME SOURCES... [INCLUDES dir...] [LIBS lib...]): adds the static library of a firmware
# layer, compiled as strict C90.
function(icesoc_c90 name)
  cmake_parse_arguments(A "" "" "SOURCES;INCLUDES;LIBS" ${ARGN})
  add_library(${name} STATIC ${A_SOURCES})
  target_compile_options(${name} PRIVATE ${C90_WARNINGS} -ffunction-sections -fdata-sections)
  target_include_directories(${name} PUBLIC ${CMAKE_CURRENT_SOURCE_DIR} ${A_INCLUDES})
  if(A_LIBS)
    target_link_libraries(${name} PUBLIC ${A_LIBS})
  endif()
endfunction()

# icesoc_core_program(TARGET): compiles the test of a core with Clang and a precompiled header, and
# without optimisation. An edit of the core's ports or registers compiles its test again, which took
# 4.0 s of CPU time with g++ -O1; with this function it takes a third of that.
function(icesoc_core_program target)
  if(PORTABLE OR COVERAGE OR SANITIZE)
    return()
  endif()
  set(source ${CMAKE_SOURCE_DIR}/testbench/common/precompiled.h)
  set(header ${CMAKE_BINARY_DIR}/core_tests.pch)
  set(options -O0 -fPIC -std=c++17 -DNDEBUG -DVM_TRACE_FST=$<BOOL:${TRACE}>
      -DGTEST_HAS_PTHREAD=1)
  if(NOT TARGET core_tests_header)
    icesoc_verilator_runtime()
    get_target_property(includes verilator_runtime INCLUDE_DIRECTORIES)
    list(TRANSFORM includes PREPEND -isystem)
    get_filename_component(compiler ${CLANGXX} REALPATH)
    # ccache compares the text in .sum, because the header contains the path of its folder.
    add_custom_command(OUTPUT ${header}
      COMMAND ${CMAKE_SOURCE_DIR}/cmake/precompile.sh ${header} ${source} ${CLANGXX}
        ${options} ${includes}
      DEPENDS ${source} ${CMAKE_SOURCE_DIR}/cmake/precompile.sh ${compiler}
      DEPFILE ${header}.d
      VERBATIM COMMENT "Precompiled header of core tests")
    add_custom_target(core_tests_header DEPENDS ${header})
  endif()
  add_dependencies(${target} core_tests_header)
  # For g++, a narrowing conversion in braces deserves a warning, for Clang an error.
  target_compile_options(${target} PRIVATE -O0 -fPIC -Wno-error=c++11-narrowing)
  get_target_property(sources ${target} SOURCES)
  list(FILTER sources INCLUDE REGEX "[.]cpp$")
  set_property(SOURCE ${sources} APPEND PROPERTY OBJECT_DEPENDS ${header})
  icesoc_quickly(${target} HEADER ${header})
endfunction()

# icesoc_test(NAME SOURCES... [LIBS lib...] [LABELS label...] [ARGS ...] [SANITIZED regexp]): adds a
# GoogleTest program; CTest discovers its cases. LABELS select tests: `ctest -L rtl`. SANITIZED:
# `make test` runs the cases with matching names a second time, with sanitizers.
function(icesoc_test name)
  cmake_parse_arguments(A "" "SANITIZED" "SOURCES;LIBS;LABELS;ARGS" ${ARGN})
  if(NOT TARGET clock_listener)
    add_library(clock_listener OBJECT ${CMAKE_SOURCE_DIR}/testbench/common/clock_listener.cpp)
    target_link_libraries(clock_listener PRIVATE GTest::gtest)
    icesoc_core_program(clock_listener)
  endif()
  add_executable(${name} ${A_SOURCES} $<TARGET_OBJECTS:clock_listener>)
  set_property(GLOBAL APPEND PROPERTY ICESOC_TEST_PROGRAMS ${name})
  target_compile_options(${name} PRIVATE ${TOOL_OPTIONS})
  target_link_libraries(${name} PRIVATE ${A_LIBS} GTest::gtest GTest::gmock GTest::gtest_main)
  gtest_discover_tests(${name} TEST_PREFIX "${name}." EXTRA_ARGS ${A_ARGS}
                       DISCOVERY_TIMEOUT 60)
  # CTest reads this file after it has discovered the cases. The file sets the labels, because
  # gtest_discover_tests keeps only the first of several labels. REQUIRED_FILES is the first source
  # file, whose folder is the folder of the test. For a program that is not built, CTest adds a test
  # NAME_NOT_BUILT.
  set(labels ${CMAKE_CURRENT_BINARY_DIR}/${name}_labels.cmake)
  list(GET A_SOURCES 0 first)
  cmake_path(ABSOLUTE_PATH first)
  file(WRITE ${labels}
    "foreach(t IN LISTS ${name}_TESTS ITEMS ${name}_NOT_BUILT)\n"
    "  set_tests_properties(\${t} PROPERTIES LABELS \"${A_LABELS}\"\n"
    "    REQUIRED_FILES \"${first}\")\n")
  if(A_SANITIZED)
    icesoc_sanitized(${name})
    file(APPEND ${labels} "  if(t MATCHES \"${A_SANITIZED}|_NOT_BUILT$\")\n"
      "    set_tests_properties(\${t} PROPERTIES LABELS \"${A_LABELS};sanitized\")\n  endif()\n")
  endif()
  file(APPEND ${labels} "endforeach()\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${labels})
endfunction()

# icesoc_sanitized(TARGET...): adds programs to the target `sanitized`. Tests with the label
# `sanitized` run these programs.
function(icesoc_sanitized)
  set_property(GLOBAL APPEND PROPERTY ICESOC_SANITIZED ${ARGN})
endfunction()

# icesoc_test_folder(VARIABLE): returns the first word of the names of the caller's tests: the name
# of the caller's folder below ip/, tests/sw/ or tests/. It is taken from the build folder, because
# a core outside the tree also has a folder there, in which CTest runs its tests.
function(icesoc_test_folder variable)
  cmake_path(RELATIVE_PATH CMAKE_CURRENT_BINARY_DIR BASE_DIRECTORY ${CMAKE_BINARY_DIR}
             OUTPUT_VARIABLE path)
  if(path MATCHES "^(tests/sw|tests|ip)/([^/]+)")
    set(${variable} ${CMAKE_MATCH_2} PARENT_SCOPE)
  else()
    cmake_path(GET path FILENAME name)
    set(${variable} ${name} PARENT_SCOPE)
  endif()
endfunction()

# icesoc_uncertain(PROGRAM seeds [gtest filter]): adds tests <folder>.cdc.<program>.<seed>.
# Each runs the cases of an icesoc_test again, with synchronisers that sample the old or the new
# value at random (hdl/cdc/cdc_random.vh). The random numbers depend on <seed> and on the test run's
# SEED.
function(icesoc_uncertain program seeds)
  set(filter ${ARGN})
  if(NOT filter)
    set(filter *)
  endif()
  icesoc_test_folder(folder)
  foreach(seed RANGE 1 ${seeds})
    add_test(NAME ${folder}.cdc.${program}.${seed}
      COMMAND ${program} --gtest_brief=1 "--gtest_filter=${filter}")
    # The test fails if the filter matches no case.
    set_tests_properties(${folder}.cdc.${program}.${seed} PROPERTIES LABELS "rtl;cdc"
                         ENVIRONMENT "CDC_SEED=${seed};NEEDS=${program}"
                         FAIL_REGULAR_EXPRESSION "[^0-9]0 tests from")
  endforeach()
endfunction()

# icesoc_regmap(JSON... [BLOCK]): generates files for the registers of each block from its
# *.regs.json. The files in ${GEN_DIR} are a Verilog include, a C header, a VHDL package and a
# Markdown page. With BLOCK, it also generates the register block <block>_regs.v, the proof of this
# block, and <block>_regs.vhd. The target of a block is regmap_<block>, and its interface library is
# regs_<block>. One process generates the files of one call, because starting Python takes longer
# than generating the files of ten blocks; files that stay equal are not written.
set(REGMAP ${PYTHON} -m icesoc.regs.generate)
file(GLOB REGMAP_FILES CONFIGURE_DEPENDS ${TOOLS}/__init__.py ${TOOLS}/regs/*.py
  ${TOOLS}/regs/regs.schema.json ${TOOLS}/regs/templates/*.j2)
function(icesoc_regmap)
  cmake_parse_arguments(A "BLOCK" "" "" ${ARGN})
  set(flag)
  if(A_BLOCK)
    set(flag --block)
  endif()
  set(paths)
  set(blocks)
  set(all)
  foreach(json IN LISTS A_UNPARSED_ARGUMENTS)
    get_filename_component(block ${json} NAME_WE)
    get_filename_component(path ${json} ABSOLUTE)
    list(APPEND blocks ${block})
    list(APPEND paths ${path})
    set(outs_${block} ${GEN_DIR}/${block}_regs.vh ${GEN_DIR}/${block}_regs.h
      ${GEN_DIR}/${block}_regs_pkg.vhd ${GEN_DIR}/${block}_regs.md)
    if(A_BLOCK)
      list(APPEND outs_${block} ${GEN_DIR}/${block}_regs.v ${GEN_DIR}/${block}_regs_proof.vh
        ${GEN_DIR}/${block}_regs.vhd)
      set_property(GLOBAL APPEND PROPERTY ICESOC_REGISTER_BLOCKS ${block})
    endif()
    list(APPEND all ${outs_${block}})
  endforeach()
  string(REPLACE ";" ", " names "${blocks}")
  add_custom_command(OUTPUT ${all}
    COMMAND ${REGMAP} ${paths} --output-dir ${GEN_DIR} ${flag}
    DEPENDS ${REGMAP_FILES} ${paths}
    VERBATIM COMMENT "Registers of ${names}")
  foreach(block IN LISTS blocks)
    add_custom_target(regmap_${block} ALL DEPENDS ${outs_${block}})
    set_property(GLOBAL APPEND PROPERTY ICESOC_REGMAP_TARGETS regmap_${block})
    add_library(regs_${block} INTERFACE)
    target_include_directories(regs_${block} INTERFACE ${GEN_DIR})
    add_dependencies(regs_${block} regmap_${block})
  endforeach()
endfunction()

# Adds the flags for waveforms and coverage counters to icesoc_verilate. This macro uses the
# variables of icesoc_verilate.
macro(icesoc_verilate_observed)
  set(definitions) # observer.h reads these definitions
  if(TRACE)
    list(APPEND flags --trace-fst -DTRACED)
    list(APPEND definitions ICESOC_TRACE)
  endif()
  if(COVERAGE)
    # --assert is needed because newer Verilators otherwise omit cover properties. Verilator treats
    # a cover point that reads a pin as a flip-flop of clk_i; if the pin is also an asynchronous
    # reset, this causes the warning SYNCASYNCNET.
    list(APPEND flags --coverage --assert -DCOVER_POINTS -Wno-SYNCASYNCNET)
    list(APPEND definitions ICESOC_COVERAGE)
    if(A_FAST)
      file(WRITE ${dir}.vlt
        "`verilator_config\ncoverage_off -file \"*\"\ncoverage_on -file \"*/soc.v\"\n"
        "coverage_on -file \"*/platform.v\"\n")
      list(APPEND flags ${dir}.vlt)
    endif()
  endif()
endmacro()

# icesoc_verilate(NAME TOP module SOURCES file... [PARAMS NAME=value...] [INCLUDES dir...]
#                 [REGS block...] [DEPENDS target-or-file...] [CHECKS file...] [FLAGS ...] [FAST]
#                 [EDITED] [STATE] [CLASS class])
# Builds a Verilated model of a module as the library NAME with the class V<NAME>, or V<CLASS>. Lint
# (-Wall) is on, and its warnings are errors. CHECKS are files that are written when checks of the
# sources succeed; the checks run at the same time as Verilator, and without them the model is not
# compiled. FAST is for the model of the whole chip. With
# COVERAGE, a FAST model has coverage counters only in soc.v and platform.v, because the other
# blocks are counted by their own tests. With counters in all modules, a few simulated seconds of
# flight take minutes. EDITED is for a model that is compiled after each edit: the header of
# Verilator's run-time library, which takes half of the compile time of a model, is precompiled.
# STATE adds a list of the model's signals (testbench/common/model_state.h).
#
# Clang compiles the model. Compared with g++, compiling takes 0.6 of the time (measured with fir),
# and the compiled model is 1.18 times as fast (measured with the chip).
function(icesoc_verilate name)
  cmake_parse_arguments(A "FAST;EDITED;STATE" "TOP;CLASS"
    "SOURCES;PARAMS;INCLUDES;REGS;DEPENDS;CHECKS;FLAGS" ${ARGN})
  set(dir ${CMAKE_CURRENT_BINARY_DIR}/verilated_${name})
  set(class V${name})
  if(A_CLASS)
    set(class V${A_CLASS})
  endif()
  set(lib ${dir}/${class}__ALL.a)
  set(flags --cc -Wall --x-assign unique --x-initial unique -O3 --top-module ${A_TOP}
            --prefix ${class} --Mdir ${dir} -y ${GEN_DIR} -I${GEN_DIR} ${A_FLAGS})
  set(library) # files of modules that Verilator may find through -y
  foreach(i IN LISTS A_INCLUDES)
    list(APPEND flags -y ${i} -I${i})
    file(GLOB found CONFIGURE_DEPENDS ${i}/*.v ${i}/*.vh)
    list(FILTER found EXCLUDE REGEX _proof[.]vh?$)
    list(APPEND library ${found})
  endforeach()
  list(TRANSFORM A_PARAMS PREPEND -G)
  icesoc_verilate_observed()
  set(sources ${A_SOURCES})
  list(TRANSFORM sources PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/ REGEX "^[^/]")
  get_property(blocks GLOBAL PROPERTY ICESOC_REGISTER_BLOCKS)
  foreach(block IN LISTS A_REGS)
    list(APPEND A_DEPENDS regmap_${block} ${GEN_DIR}/${block}_regs.vh)
    if(block IN_LIST blocks)
      list(APPEND A_DEPENDS ${GEN_DIR}/${block}_regs.v)
    endif()
  endforeach()
  set(deps ${sources} ${library} ${A_DEPENDS})
  set(unchanged ${CMAKE_SOURCE_DIR}/cmake/unchanged.sh)
  set(compiler ${CMAKE_CXX_COMPILER})
  if(NOT COVERAGE AND NOT SANITIZE)
    set(compiler ${CLANGXX})
  endif()
  set(fast ${MODEL_OPTIONS})
  set(environment)
  set(headers)
  icesoc_verilator_runtime()
  if(A_EDITED AND TARGET verilated_header)
    set(environment ${CCACHE_WITH_HEADER})
    set(header ${CMAKE_BINARY_DIR}/verilated.pch)
    list(APPEND fast -include-pch ${header} -Xclang -fno-pch-timestamp)
    list(APPEND headers ${header} verilated_header)
  endif()
  list(JOIN fast " " fast)
  # The simulator is installed, so its messages must not contain the path of this tree.
  set(without_tree)
  if(A_FAST)
    set(without_tree COMMAND find ${dir} -name "*.cpp" -exec sed -i
      "s|MT(\"${CMAKE_SOURCE_DIR}/|MT(\"|" {} +)
  endif()
  set(state)
  set(list_state)
  if(A_STATE)
    set(state ${class}_state)
    set(list_state COMMAND awk -v top=${A_TOP}__DOT__ -v class=${class} -f ${STATE_MEMBERS}
      ${dir}/${class}___024root.h > ${dir}/${state}.cpp)
    list(APPEND deps ${STATE_MEMBERS})
  endif()
  # The headers are declared as by-products, so that ninja compiles the files that include them in
  # the same run, not in the next one, and at the same time as the model. After each change of the
  # RTL, Verilator writes all files again. Files with the same content keep their time, so that what
  # includes them is not compiled again.
  set(written ${dir}/${class}__ver.d)
  add_custom_command(OUTPUT ${written} BYPRODUCTS ${dir}/${class}.h ${dir}/${class}___024root.h
    COMMAND ${unchanged} save ${dir}
    COMMAND ${VERILATOR} ${flags} ${A_PARAMS} ${sources}
    ${without_tree}
    ${list_state}
    COMMAND ${unchanged} restore ${dir}
    DEPENDS ${deps} ${unchanged} VERBATIM COMMENT "Verilating ${A_TOP} as ${name}")
  # Verilator's makefile appends -Os; OPT_FAST overrides it, which doubles the measured speed.
  # The model of the chip is compiled as three files.
  set(makefile ${CMAKE_SOURCE_DIR}/cmake/model.mk)
  add_custom_command(OUTPUT ${lib}
    COMMAND ${CMAKE_COMMAND} -E env --unset=MAKEFLAGS CCACHE_DIR=$ENV{CCACHE_DIR}
            ${environment} make -s -j3 -C ${dir} -f ${makefile} ${class}__ALL.a
            CLASS=${class} STATE=${state} "CXX=${CCACHE} ${compiler}" "OPT_FAST=${fast}"
            OPT_GLOBAL=-O2 "USER_CPPFLAGS=-fPIC -I${CMAKE_SOURCE_DIR}/testbench/common" ARCHIVE=1
    DEPENDS ${written} ${headers} ${makefile} ${A_CHECKS}
    VERBATIM COMMENT "Compiling the model ${name}")
  set(defines ${A_FLAGS})
  list(FILTER defines INCLUDE REGEX "^-D")
  list(TRANSFORM defines REPLACE "^-D" "+define+")
  set(files ${CMAKE_BINARY_DIR}/files/${name}.f)
  add_custom_command(OUTPUT ${files}
    COMMAND ${CMAKE_COMMAND} -DREAD=${dir}/${class}__ver.d -DTO=${files} -DTOP=${A_TOP}
            "-DDEFINES=${defines}" -P ${CMAKE_SOURCE_DIR}/cmake/files.cmake
    DEPENDS ${written} ${CMAKE_SOURCE_DIR}/cmake/files.cmake VERBATIM COMMENT "Files of ${name}")
  add_custom_target(verilated_${name} DEPENDS ${written} ${files})
  add_custom_target(compiled_${name} DEPENDS ${lib})
  add_library(${name} INTERFACE)
  add_dependencies(${name} verilated_${name})
  target_include_directories(${name} SYSTEM INTERFACE ${dir})
  target_compile_definitions(${name} INTERFACE ${definitions})
  target_link_libraries(${name} INTERFACE ${lib} verilator_runtime)
endfunction()

# Lists the signals in a Verilated model's state (STATE).
set(STATE_MEMBERS ${CMAKE_SOURCE_DIR}/testbench/common/state_members.awk)

# icesoc_netlist(NAME DESIGN design [PARAMS NAME=value...] [DEPENDS target...] [TOP module SOURCES
# file... INCLUDES dir...] [FLAGS ...] [CLASS class]): builds a Verilated model of a netlist, as
# icesoc_verilate does for a module. The netlist is built as for `make synth`,
# unless PARAMS sets other parameters. Each primitive in the netlist has a Verilog model. With TOP,
# the model is of a module that contains the netlist.
function(icesoc_netlist name)
  cmake_parse_arguments(A "" "DESIGN;TOP;CLASS" "PARAMS;DEPENDS;SOURCES;INCLUDES;FLAGS" ${ARGN})
  if(NOT A_TOP)
    set(A_TOP ${A_DESIGN})
  endif()
  list(TRANSFORM A_PARAMS PREPEND "--set=")
  set(here ${CMAKE_SOURCE_DIR})
  set(netlist ${CMAKE_CURRENT_BINARY_DIR}/netlist_${name}/${A_DESIGN}.v)
  file(GLOB scripts CONFIGURE_DEPENDS ${here}/synth/*/*.v ${here}/synth/*/*.ys)
  foreach(part netlist sources synthesis)
    list(APPEND scripts ${TOOLS}/synth/${part}.py)
  endforeach()
  get_property(made GLOBAL PROPERTY ICESOC_REGMAP_TARGETS)
  add_custom_command(OUTPUT ${netlist}
    COMMAND ${CMAKE_BINARY_DIR}/synth/utilisation --source ${here} --generated ${GEN_DIR}
      --output ${CMAKE_BINARY_DIR}/netlists --netlist ${A_DESIGN} ${A_PARAMS}
      --family ${NETLIST_FAMILY} --to ${netlist}
    DEPENDS ${scripts} ${made} ${A_DEPENDS}
    DEPFILE ${CMAKE_CURRENT_BINARY_DIR}/netlist_${name}/${A_DESIGN}.d
    VERBATIM COMMENT "Netlist of ${A_DESIGN}")
  # Lint is off, because it would only report the style of the Verilog that Yosys writes.
  icesoc_verilate(${name} TOP ${A_TOP} SOURCES ${A_SOURCES} ${netlist} INCLUDES ${A_INCLUDES}
    CLASS ${A_CLASS} FLAGS ${A_FLAGS} -Wno-lint -Wno-style -Wno-UNOPTFLAT)
endfunction()

# Verilator's run-time library, compiled once for all models, and its precompiled header,
# verilated.pch.
set(MODEL_OPTIONS -O3 ${TUNE})
function(icesoc_verilator_runtime)
  if(TARGET verilator_runtime)
    return()
  endif()
  execute_process(COMMAND ${VERILATOR} --getenv VERILATOR_ROOT
                  OUTPUT_VARIABLE root OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(NOT EXISTS ${root}/include/verilated.cpp)
    message(FATAL_ERROR "Verilator's include folder is not at '${root}': reinstall verilator")
  endif()
  find_package(ZLIB REQUIRED)
  find_package(Threads REQUIRED)
  # The parts for waveforms and coverage took most of the compile time of the first test in a clone.
  set(parts verilated.cpp verilated_threads.cpp)
  if(TRACE)
    list(APPEND parts verilated_fst_c.cpp)
  endif()
  if(COVERAGE)
    list(APPEND parts verilated_cov.cpp)
  endif()
  list(TRANSFORM parts PREPEND ${root}/include/)
  add_library(verilator_runtime STATIC ${parts})
  # Models call these functions only at the start and for messages, and compiling them is a tenth of
  # the time of the first test in a clone. Only waveforms are worth optimising.
  set(optimise -O0)
  if(TRACE OR PORTABLE)
    set(optimise -O1)
  endif()
  target_compile_options(verilator_runtime PRIVATE ${optimise} -w)
  if(NOT TRACE AND NOT COVERAGE)
    set_target_properties(verilator_runtime PROPERTIES UNITY_BUILD ON)
  endif()
  icesoc_quickly(verilator_runtime)
  target_compile_definitions(verilator_runtime PUBLIC VM_TRACE_FST=$<BOOL:${TRACE}>)
  target_include_directories(verilator_runtime SYSTEM PUBLIC ${root}/include ${root}/include/vltstd)
  target_link_libraries(verilator_runtime PUBLIC ZLIB::ZLIB Threads::Threads)
  if(NOT TRACE AND NOT COVERAGE AND NOT SANITIZE)
    set(makefile ${CMAKE_SOURCE_DIR}/cmake/verilated_header.mk)
    get_filename_component(compiler ${CLANGXX} REALPATH)
    set(header ${CMAKE_BINARY_DIR}/verilated.pch)
    list(JOIN MODEL_OPTIONS " " options)
    add_custom_command(OUTPUT ${header}
      COMMAND ${CMAKE_COMMAND} -E env --unset=MAKEFLAGS
              make -s -B -f ${makefile} VERILATOR_ROOT=${root} TO=${header}
              CXX=${CLANGXX} "OPT_FAST=${options} -Xclang -fno-pch-timestamp"
              USER_CPPFLAGS=-fPIC
      DEPENDS ${makefile} ${root}/include/verilated.h ${compiler}
      VERBATIM COMMENT "Precompiled header of Verilator's run-time library")
    add_custom_target(verilated_header DEPENDS ${header})
  endif()
endfunction()
include(editors)
include(vhdl)
include(arm)
