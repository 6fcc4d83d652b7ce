// SPDX-License-Identifier: MIT
//
// driver_port: connects the loads and stores of the FSMC driver (sw/fsmc) to the model of the FSMC.
// The driver's context pointer is the FsmcMaster.

#pragma once

#include "fsmc_master.h"

extern "C" {
#include "fsmc.h"
}

inline FsmcMaster& masterOf(void* context) {
    return *static_cast<FsmcMaster*>(context);
}
inline const FSMC_Port driverPort = {[](void* c, U32 a) -> U8 { return masterOf(c).read8(a); },
                                     [](void* c, U32 a, U8 v) { masterOf(c).write8(a, v); },
                                     [](void* c, U32 a) -> U16 { return masterOf(c).read16(a); },
                                     [](void* c, U32 a, U16 v) { masterOf(c).write16(a, v); },
                                     [](void* c, U32 a) -> U32 { return masterOf(c).read32(a); },
                                     [](void* c, U32 a, U32 v) { masterOf(c).write32(a, v); }};
