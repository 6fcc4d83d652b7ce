// SPDX-License-Identifier: MIT
//
// placement: designs placed and routed on an ECP5 by nextpnr, to compare the estimates with.

#pragma once

#include "table.h"

// Places each of these runs (of family "ecp5") with five seeds; results in the cache are reused.
// Returns a row for each: fmax, the estimate for Spartan-6, utilisation. Throws with nextpnr's
// message if it fails.
TextTable placed(const std::vector<Row>& rows, const std::string& nextpnr, unsigned jobs);
