// SPDX-License-Identifier: MIT
//
// litedram_pins: connects a Verilated module's LiteDRAM port with a LitedramModel, around a clock
// edge.

#ifndef LITEDRAM_PINS_H
#define LITEDRAM_PINS_H

#include "litedram_model.h"

// Samples the design's settled outputs before the edge.
template <class Module> void sampleLitedram(Module& top, LitedramModel& memory) {
    LitedramModel::Pins& m = memory.pins;
    m.cmdValid = top.dram_cmd_valid_o;
    m.cmdWe = top.dram_cmd_we_o;
    m.cmdAddr = top.dram_cmd_addr_o;
    m.wdataValid = top.dram_wdata_valid_o;
    m.wdataWe = top.dram_wdata_we_o;
    m.wdataData = top.dram_wdata_data_o;
    m.rdataReady = top.dram_rdata_ready_o;
    m.cmdReady = memory.ready(m.cmdAddr);
    top.dram_cmd_ready_i = m.cmdReady;
    top.eval();
    memory.cycle();
}

// Drives the design's inputs after the edge.
template <class Module> void driveLitedram(Module& top, const LitedramModel& memory) {
    const LitedramModel::Pins& m = memory.pins;
    top.dram_wdata_ready_i = m.wdataReady;
    top.dram_rdata_valid_i = m.rdataValid;
    top.dram_rdata_data_i = m.rdataData;
    top.dram_init_done_i = m.initDone;
}

#endif
