// SPDX-License-Identifier: MIT
//
// app_paper: the paper's Figure 5 as firmware.

#include "app.h"

extern "C" {
#include "paper.h"
}

UavMachine::Firmware simulatedFirmware() {
    return {PAPER_start, PAPER_irqHandler, [] { return PAPER_irqEnabled() != 0; }};
}
