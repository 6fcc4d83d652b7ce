// SPDX-License-Identifier: MIT
//
// slices: how many slices of four LUT6 and eight flip-flops a netlist takes (docs/utilisation.md).
//
// The rules of Spartan-6 and 7-series slices (UG384, UG474): clock, enable and set/reset are common
// to a slice; a LUT6 is two functions of at most five common inputs; a carry chain takes a slice
// for every four bits with the LUTs in front of it; a LUT RAM takes a SLICEM.

#pragma once

#include "netlist.h"

struct Slices {
    int low = 0;      // nothing but the rules: no placer can do with less
    int estimate = 0; // as ISE's map fills slices in a chip with room (calibrated)
    int high = 0;     // as it does with the most generous of the calibration designs
    int slicem = 0;   // of these, must be SLICEM: LUT RAM and shift registers

    int sites = 0;       // LUT6 sites after pairing LUTs of five common inputs
    int pairs = 0;       // flip-flops that a LUT of their own feeds
    int controlSets = 0; // distinct (clock, enable, set/reset)
};

Slices slicesOf(const Netlist& netlist);
