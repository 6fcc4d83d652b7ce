// SPDX-License-Identifier: MIT
//
// fpga_pins: computes a configuration at its begin, and plays its reads as time passes.

#include "fpga_pins.h"

namespace {

constexpr uint64_t second = 1'000'000'000, never = ~0ull;

} // namespace

void FpgaPins::powerOn() {
    if (!flash_)
        return;
    flash_->powerOff();
    configure();
}

void FpgaPins::drive(bool isSelectLow, bool isProgramLow) {
    if (!flash_)
        return;
    flash_->select(isSelectLow);
    const bool was = isProgramLow_;
    isProgramLow_ = isProgramLow;
    if (isProgramLow) {
        boot_.running.reset();
        boot_.reads.clear();
    } else if (was) {
        configure();
    }
}

void FpgaPins::configure() {
    boot_.configure(flash_->memory);
    begunAt_ = now_();
    doneAt_ = nsOf(boot_.clocks);
    if (onReconfigured)
        onReconfigured();
}

uint64_t FpgaPins::clock() const {
    return (now_() - begunAt_) * Spartan6Boot::cclkHz / second;
}

// The first nanosecond at which clock() has reached it.
uint64_t FpgaPins::nsOf(uint64_t clock) const {
    return begunAt_ + (clock * second + Spartan6Boot::cclkHz - 1) / Spartan6Boot::cclkHz;
}

const Spartan6Boot::Read* FpgaPins::current() const {
    for (const Spartan6Boot::Read& read : boot_.reads)
        if (read.from <= clock() && clock() < read.to)
            return &read;
    return nullptr;
}

uint64_t FpgaPins::bytesSent() const {
    const Spartan6Boot::Read* read = current();
    return read ? (clock() - read->from) / 8 : 0;
}

uint8_t FpgaPins::byteSent(uint64_t index) const {
    const Spartan6Boot::Read* read = current();
    if (!read || index > 3)
        return 0xFF;
    return static_cast<uint8_t>((0x03000000 | read->address) >> (24 - 8 * index));
}

uint64_t FpgaPins::nextEdgeNs() const {
    for (const Spartan6Boot::Read& read : boot_.reads)
        for (uint64_t edge : {read.from, read.to})
            if (edge != never && nsOf(edge) > now_())
                return nsOf(edge);
    return never;
}
