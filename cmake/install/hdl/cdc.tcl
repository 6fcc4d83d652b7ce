# SPDX-License-Identifier: MIT
#
# cdc: constraints of the crossings of the block cdc, for Vivado. A value reaches the first flip-flop
# of a synchroniser in less than one period of its clock. Not run with Vivado yet. For ISE see
# platform.ucf.
foreach cell [get_cells -hierarchical -filter {NAME =~ *bit_meta_reg*}] {
    set clock [get_clocks -of_objects $cell]
    set_max_delay -datapath_only -to $cell [get_property PERIOD $clock]
}
