// SPDX-License-Identifier: MIT
//
// speed: what speed_tb.v does, for Verilator. Usage: speed frames

#include "Vvision_slot.h"
#include "vision_regs.h"
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <verilated.h>

namespace {

struct Run {
    VerilatedContext context;
    Vvision_slot top{&context};
    uint32_t at = 0, nextAt = 0;
    unsigned left = 0, nextLeft = 0;
    unsigned long clocks = 0;

    static uint8_t pixel(uint32_t address) {
        uint32_t value = ((address & 31) ^ (address >> 8 & 31)) << 3;
        return static_cast<uint8_t>(value + ((address >> 5 ^ address >> 10) & 1 ? 90 : 0));
    }
    void clock() {
        top.eval();
        bool ack = top.npi_addr_req_o && !top.npi_addr_ack_i && (!top.npi_rnw_o || nextLeft == 0);
        if (top.npi_rd_pop_o) {
            if (left > 1) {
                at += 8;
                --left;
            } else {
                at = nextAt;
                left = nextLeft;
                nextLeft = 0;
            }
        }
        if (top.npi_addr_ack_i && top.npi_rnw_o) {
            (left == 0 ? at : nextAt) = top.npi_addr_o;
            (left == 0 ? left : nextLeft) = 16;
        }
        top.clk_i = 1;
        top.eval();
        top.npi_addr_ack_i = ack;
        top.npi_rd_empty_i = left == 0;
        uint64_t data = 0;
        for (unsigned b = 0; b < 8; ++b)
            data |= uint64_t(pixel(at + b)) << (8 * b);
        top.npi_rd_data_i = data;
        top.clk_i = 0;
        top.eval();
        ++clocks;
    }
    void write(unsigned word, uint32_t value) {
        top.bus_valid_i = 1;
        top.bus_addr_i = static_cast<uint8_t>(word);
        top.bus_wdata_i = value;
        clock();
        top.bus_valid_i = 0;
    }
};

} // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: speed frames\n");
        return 2;
    }
    auto run = std::make_unique<Run>();
    auto& top = run->top;
    top.bus_write_i = top.npi_wr_empty_i = top.npi_rd_empty_i = top.npi_init_done_i = 1;
    top.rst_i = 1;
    for (int i = 0; i < 4; ++i)
        run->clock();
    top.rst_i = 0;
    run->write(VISION_MASK, 3);
    run->write(VISION_THRESHOLD, 20);
    run->write(VISION_FRAME_BASE, 0);
    run->write(VISION_FRAME_SIZE, 64u << 16 | 256u);
    run->write(VISION_RESULT_BASE, 0x100000);
    run->write(VISION_RESULT_MAX, 0);
    for (long frame = 0; frame < std::atol(argv[1]); ++frame) {
        run->write(VISION_EVENT, 3);
        run->write(VISION_CONTROL, 1);
        while (!top.irq_o)
            run->clock();
    }
    std::printf("clocks %lu\n", run->clocks);
    top.final();
    return 0;
}
