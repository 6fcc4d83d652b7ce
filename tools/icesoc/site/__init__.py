# SPDX-License-Identifier: MIT
"""site: builds the documentation site (`./icesoc docs`) from docs/ and from the sources.

hdl        reads the interface of a Verilog module or VHDL entity from its file
symbol     draws the ports of a module as an SVG
reference  writes the reference pages that are generated: HDL, registers, C headers, command line
build      stages all pages and runs Sphinx
"""
