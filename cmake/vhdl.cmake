# SPDX-License-Identifier: MIT
#
# vhdl.cmake: converts VHDL cores to Verilog with GHDL 5. A latch in the result is an error.

set(GHDL_DIR ${CMAKE_BINARY_DIR}/ghdl)
set(GHDL ${GHDL_DIR}/ghdl)
add_custom_command(OUTPUT ${GHDL}
  COMMAND ${FETCH} ghdl ${GHDL_DIR}
  DEPENDS ${FETCH_FILES} VERBATIM COMMENT "GHDL 5")
add_custom_target(ghdl DEPENDS ${GHDL})

# icesoc_vhdl(NAME entity SOURCES file... [REGS block...] [LIBRARY name] [LIBRARIES name=file...]
#             [GENERICS name=value...] [FOREIGN])
# Converts an entity to ${GEN_DIR}/<entity>.v with the target <entity>_verilog. The file
# ${GEN_DIR}/<entity>.no_latches is written after a search for latches; a model passes it to
# icesoc_verilate as one of its CHECKS. LIBRARY is the library of SOURCES. The files may be in any
# order. GHDL copies the names of the files into the Verilog. The names passed to GHDL are relative
# to the tree, so that copies of the tree give the same Verilog.
function(icesoc_vhdl)
  cmake_parse_arguments(A "FOREIGN" "NAME;LIBRARY" "SOURCES;REGS;GENERICS;LIBRARIES" ${ARGN})
  list(TRANSFORM A_LIBRARIES REPLACE "(.+)" "--in;\\1" OUTPUT_VARIABLE members)
  list(TRANSFORM A_LIBRARIES REPLACE "^[^=]*=" "" OUTPUT_VARIABLE member_files)
  list(TRANSFORM A_GENERICS REPLACE "(.+)" "--generic;\\1" OUTPUT_VARIABLE generics)
  if(NOT A_LIBRARY)
    set(A_LIBRARY work)
  endif()
  set(foreign)
  if(A_FOREIGN)
    set(foreign --foreign)
  endif()
  set(packages)
  set(deps)
  foreach(r IN LISTS A_REGS)
    list(APPEND packages ${GEN_DIR}/${r}_regs_pkg.vhd)
    list(APPEND deps regmap_${r})
  endforeach()
  set(named)
  foreach(file IN LISTS packages A_SOURCES)
    cmake_path(IS_PREFIX CMAKE_SOURCE_DIR "${file}" NORMALIZE inside)
    if(inside)
      cmake_path(RELATIVE_PATH file BASE_DIRECTORY ${CMAKE_SOURCE_DIR})
    endif()
    list(APPEND named ${file})
  endforeach()
  set(work ${CMAKE_CURRENT_BINARY_DIR}/ghdl_${A_NAME})
  file(MAKE_DIRECTORY ${work})
  add_custom_command(OUTPUT ${GEN_DIR}/${A_NAME}.v
    COMMAND ${CMAKE_SOURCE_DIR}/cmake/vhdl_to_verilog.sh ${foreign} --library ${A_LIBRARY}
            ${members} ${generics} ${GHDL} ${work} ${A_NAME} ${GEN_DIR}/${A_NAME}.v ${named}
    WORKING_DIRECTORY ${CMAKE_SOURCE_DIR}
    DEPENDS ${GHDL} ghdl ${packages} ${A_SOURCES} ${member_files} ${deps}
      ${CMAKE_SOURCE_DIR}/cmake/vhdl_to_verilog.sh
    VERBATIM COMMENT "VHDL to Verilog: ${A_NAME}")
  add_custom_target(${A_NAME}_verilog DEPENDS ${GEN_DIR}/${A_NAME}.v)
  set(checked ${GEN_DIR}/${A_NAME}.no_latches)
  set(check ${CMAKE_SOURCE_DIR}/cmake/no_latches.sh)
  add_custom_command(OUTPUT ${checked}
    COMMAND ${check} ${work} ${A_NAME} ${GEN_DIR}/${A_NAME}.v
    COMMAND ${CMAKE_COMMAND} -E touch ${checked}
    DEPENDS ${GEN_DIR}/${A_NAME}.v ${check} VERBATIM COMMENT "Latches: ${A_NAME}")
  add_custom_target(${A_NAME}_no_latches DEPENDS ${checked})
  set_property(GLOBAL APPEND PROPERTY ICESOC_VHDL_TARGETS ${A_NAME}_verilog ${A_NAME}_no_latches)
endfunction()

# icesoc_vhdl_test(NAME core SOURCES file... [LIBS lib...]): adds the test <core>.vhdl
# (cmake/vhdl_test.sh). It runs <core>_tb.vhd with vectors that <core>_vectors.cpp writes. Both
# files are in the folder of the caller.
function(icesoc_vhdl_test)
  cmake_parse_arguments(A "" "NAME" "SOURCES;LIBS" ${ARGN})
  add_executable(${A_NAME}_vectors ${A_NAME}_vectors.cpp)
  target_link_libraries(${A_NAME}_vectors PRIVATE ${A_LIBS} bench)
  add_dependencies(${A_NAME}_vectors ghdl)
  icesoc_tested(${A_NAME} ${A_NAME}_vectors)
  set_property(GLOBAL APPEND PROPERTY ICESOC_TEST_PROGRAMS ${A_NAME}_vectors)
  add_test(NAME ${A_NAME}.vhdl COMMAND ${CMAKE_SOURCE_DIR}/cmake/vhdl_test.sh ${A_NAME} ${GHDL}
           $<TARGET_FILE:${A_NAME}_vectors> ${CMAKE_CURRENT_BINARY_DIR}/vhdl ${A_SOURCES}
           ${CMAKE_CURRENT_SOURCE_DIR}/${A_NAME}_tb.vhd)
  set_tests_properties(${A_NAME}.vhdl PROPERTIES LABELS vhdl)
endfunction()
