// SPDX-License-Identifier: MIT
//
// mcb_pins: connects a Verilated module's MCB user port with an McbModel, around one clock edge.

#pragma once

#include "mcb_model.h"

// Samples the design's settled outputs before the edge.
template <class Module> void sampleMcb(Module& top, McbModel& memory) {
    McbModel::Pins& m = memory.pins;
    m.cmdEn = top.mcb_cmd_en_o;
    m.wrEn = top.mcb_wr_en_o;
    m.rdEn = top.mcb_rd_en_o;
    if (m.cmdEn) {
        m.cmdInstr = top.mcb_cmd_instr_o;
        m.cmdBl = top.mcb_cmd_bl_o;
        m.cmdByteAddr = top.mcb_cmd_byte_addr_o;
    }
    if (m.wrEn) {
        m.wrMask = top.mcb_wr_mask_o;
        m.wrData = top.mcb_wr_data_o;
    }
    memory.cycle();
}

// Drives the design's inputs after the edge.
template <class Module> void driveMcb(Module& top, const McbModel& memory) {
    const McbModel::Pins& m = memory.pins;
    top.mcb_cmd_full_i = m.cmdFull;
    top.mcb_wr_full_i = m.wrFull;
    top.mcb_rd_empty_i = m.rdEmpty;
    top.mcb_rd_data_i = m.rdData;
    top.mcb_calib_done_i = m.calibDone;
}
