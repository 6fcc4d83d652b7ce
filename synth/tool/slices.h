// SPDX-License-Identifier: MIT
//
// slices: estimates the slices of four LUT6 and eight flip-flops of a netlist
// (docs/utilisation.md).
// (docs/utilisation.md).
//
// The rules of Spartan-6 and 7-series slices (UG384, UG474): clock, enable and set/reset are common
// to a slice; a LUT6 is two functions of at most five common inputs; a carry chain takes a slice
// for every four bits with the LUTs in front of it; a LUT RAM takes a SLICEM.

#pragma once

#include "netlist.h"

struct Slices {
    int low = 0;      // as ISE's map fills a chip with room
    int estimate = 0; // as in the least dense design of the calibration
    int high = 0;     // as in the least dense design of the calibration
    int slicem = 0;   // of these, must be SLICEM: LUT RAM and shift registers

    int sites = 0;       // LUT6 sites, LUTs of five common inputs paired as far as possible
    int pairs = 0;       // sites that only lead a signal into a carry chain, without a cell
    int through = 0;     // sites that only lead a signal into a carry chain, without a cell
    int controlSets = 0; // distinct (clock, enable, set/reset)
};

// Estimates map's slices for these LUT sites and flip-flops: (sites + share * flip-flops) / 4,
// where `share` is the share of flip-flops without a place beside a used LUT. Calibrated with
// published reports of map for Spartan-6 (tests/synth/slices_test.cpp has them).
constexpr double usualShare = 0.55, leastShare = 0.13, mostShare = 0.97;
// Share of functions without a site of their own, since two share one: 1 to 18 % in the reports
// that have it.
constexpr double usualPairing = 0.11;
// Mean error for a design outside of the calibration: each of those reports by the share that fits
// the others best (leave one out).
constexpr double slicesError = 0.17;
double occupiedSlices(double sites, double flipFlops, double share);

Slices slicesOf(const Netlist& netlist);
