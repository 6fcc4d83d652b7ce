# SPDX-License-Identifier: MIT
# files.cmake: writes the list of the Verilog files that Verilator has read for a model, for other
# tools. The folder of each file is put on the include path, because some cores include files with
# the suffix .v. SystemVerilog packages are listed first.
#
#   cmake -DREAD=V__ver.d -DTO=list -DTOP=module "-DDEFINES=+define+NAME" -P files.cmake
file(READ "${READ}" text)
string(REGEX MATCHALL "[^ \n]+[.][sS]?[vV][hH]?[ \n]" files "${text}")
set(folders)
set(sources)
foreach(file IN LISTS files)
  string(STRIP "${file}" file)
  file(STRINGS "${file}" line REGEX "^`line 1 \".*\"" LIMIT_COUNT 1)
  # `file` is a copy that was made for the simulator (testbench/sim/rest.awk); its `line directive
  # names the original
  if(line MATCHES "\"(.*)\"")
    set(file "${CMAKE_MATCH_1}")
  endif()
  get_filename_component(folder "${file}" DIRECTORY)
  list(APPEND folders "+incdir+${folder}")
  if(file MATCHES "[vV]$")
    file(STRINGS "${file}" package REGEX "^[ \t]*package[ \t]" LIMIT_COUNT 1)
    if(package)
      list(APPEND packages "${file}")
    else()
      list(APPEND sources "${file}")
    endif()
  endif()
endforeach()
list(REMOVE_DUPLICATES folders)
string(JOIN "\n" lines "// top: ${TOP}" ${DEFINES} ${folders} ${packages} ${sources} "")
file(WRITE "${TO}" "${lines}")
