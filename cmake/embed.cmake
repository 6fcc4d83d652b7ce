# SPDX-License-Identifier: MIT
# A text file as a C++ string constant: -DIN=file -DOUT=header -DNAME=constant
file(READ ${IN} text HEX)
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${text}")
file(WRITE ${OUT} "static const char ${NAME}[] = {${bytes}0};\n")
