# SPDX-License-Identifier: MIT
#
# cdc: Vivado constraints for the clock domain crossings of the block cdc. The path to the first
# flip-flop of each synchroniser takes less than one period of the destination clock. This file
# has not been run with Vivado yet. The constraints for ISE are in platform.ucf.
foreach cell [get_cells -hierarchical -filter {NAME =~ *bit_meta_reg*}] {
    set clock [get_clocks -of_objects $cell]
    set_max_delay -datapath_only -to $cell [get_property PERIOD $clock]
}
