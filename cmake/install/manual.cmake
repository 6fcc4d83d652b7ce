# SPDX-License-Identifier: MIT
#
# manual.cmake: generates manual pages of programs from their --help.

# icesoc_manual(COMPONENT name [SECTION 1] PURPOSE text COMMAND program...): installs the page
# NAME.SECTION.gz, generated from the output of COMMAND --help.
function(icesoc_manual component name)
  cmake_parse_arguments(A "" "SECTION;PURPOSE" "COMMAND;DEPENDS" ${ARGN})
  if(NOT A_SECTION)
    set(A_SECTION 1)
  endif()
  set(page ${CMAKE_CURRENT_BINARY_DIR}/man/${name}.${A_SECTION}.gz)
  add_custom_command(OUTPUT ${page}
    COMMAND ${PYTHON} ${here}/manual.py ${page} --name ${name} --purpose ${A_PURPOSE}
      --version ${ICESOC_VERSION} -- ${A_COMMAND} --help
    DEPENDS ${here}/manual.py ${A_DEPENDS} VERBATIM COMMENT "Manual page: ${name}")
  list(APPEND installable ${page})
  set(installable ${installable} PARENT_SCOPE)
  install(FILES ${page} DESTINATION ${CMAKE_INSTALL_MANDIR}/man${A_SECTION}
    COMPONENT ${component})
endfunction()
