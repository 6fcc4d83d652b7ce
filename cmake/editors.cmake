# SPDX-License-Identifier: MIT
#
# editors.cmake: lists files that CMake does not compile itself in compile_commands.json, so that
# editors know their compiler options.

# icesoc_for_editors(SOURCES file... [OPTIONS word...] [LIBS lib...]): remembers files of this tree,
# and the options with which clang accepts them. One call names either C or C++ files, not both.
function(icesoc_for_editors)
  cmake_parse_arguments(A "" "" "SOURCES;OPTIONS;LIBS" ${ARGN})
  set(files)
  foreach(source IN LISTS A_SOURCES)
    cmake_path(ABSOLUTE_PATH source NORMALIZE)
    cmake_path(IS_PREFIX CMAKE_BINARY_DIR ${source} is_generated)
    cmake_path(IS_PREFIX CMAKE_SOURCE_DIR ${source} is_here)
    if(is_here AND NOT is_generated AND source MATCHES "\\.(c|cpp)$")
      list(APPEND files ${source})
    endif()
  endforeach()
  if(files)
    string(MD5 group "${A_OPTIONS} ${A_LIBS}")
    set_property(GLOBAL APPEND PROPERTY ICESOC_EDITOR_GROUPS ${group})
    set_property(GLOBAL APPEND PROPERTY ICESOC_EDITOR_FILES_${group} ${files})
    set_property(GLOBAL PROPERTY ICESOC_EDITOR_OPTIONS_${group} ${A_OPTIONS})
    set_property(GLOBAL PROPERTY ICESOC_EDITOR_LIBS_${group} ${A_LIBS})
  endif()
endfunction()

# Appends the source files that CMake compiles in a folder and in the folders below it.
function(icesoc_compiled variable folder)
  set(files ${${variable}})
  get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
  foreach(target IN LISTS targets)
    get_property(sources TARGET ${target} PROPERTY SOURCES)
    list(FILTER sources INCLUDE REGEX "^[^$]*[.](c|cpp)$")
    list(TRANSFORM sources PREPEND ${folder}/ REGEX "^[^/]")
    list(APPEND files ${sources})
  endforeach()
  get_property(folders DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
  foreach(each IN LISTS folders)
    icesoc_compiled(files ${each})
  endforeach()
  set(${variable} ${files} PARENT_SCOPE)
endfunction()

# icesoc_list_for_editors(): adds the remembered files that CMake does not compile to
# compile_commands.json, each with the options of the first call that names it. For this purpose,
# they become libraries that are never built.
function(icesoc_list_for_editors)
  get_property(groups GLOBAL PROPERTY ICESOC_EDITOR_GROUPS)
  list(REMOVE_DUPLICATES groups)
  set(listed)
  icesoc_compiled(listed ${CMAKE_SOURCE_DIR})
  set(number 0)
  foreach(group IN LISTS groups)
    foreach(what FILES OPTIONS LIBS)
      get_property(${what} GLOBAL PROPERTY ICESOC_EDITOR_${what}_${group})
    endforeach()
    list(REMOVE_DUPLICATES FILES)
    list(REMOVE_ITEM FILES ${listed} "")
    if(FILES)
      list(APPEND listed ${FILES})
      math(EXPR number "${number} + 1")
      add_library(for_editors_${number} OBJECT EXCLUDE_FROM_ALL ${FILES})
      target_compile_options(for_editors_${number} PRIVATE ${OPTIONS})
      target_link_libraries(for_editors_${number} PRIVATE ${LIBS})
    endif()
  endforeach()
endfunction()
