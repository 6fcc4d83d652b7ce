// SPDX-License-Identifier: MIT
//
// fpga_pins: configuration of the FPGA and its flash, as seen at the pins of the processor: SPI 1
// (PA4 to PA7; driven by the FPGA while it configures itself), PROGRAM_B and DONE. Without a flash
// the FPGA is always configured.

#pragma once

#include "spartan6_boot.h"
#include "spi_flash.h"
#include <functional>

class FpgaPins {
public:
    // `now` is simulated time in ns.
    explicit FpgaPins(std::function<uint64_t()> now) : now_(std::move(now)) {}

    void wire(SpiFlash& flash) { flash_ = &flash; }
    void powerOn() {
        if (!flash_)
            return;
        flash_->powerOff();
        configure();
    }
    // Sets the outputs of the processor: chip select and PROGRAM_B.
    void drive(bool isSelectLow, bool isProgramLow) {
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
    bool isDone() const { return isDoneWired && (!flash_ || (boot_.running && now_() >= doneAt_)); }
    bool isDoneWired = true; // if false, DONE is read as low
    const Spartan6Boot& boot() const { return boot_; }
    // Called when the FPGA has lost its configuration, and starts to load one.
    std::function<void()> onReconfigured;

    // Transfers a byte in both directions; the processor is the master.
    uint8_t transfer(uint8_t byte) { return flash_ ? flash_->transfer(byte) : 0xFF; }
    // State while the FPGA is the master: whether its chip select is low, the number of bytes sent
    // since then, and the bytes.
    bool isReading() const { return current() != nullptr; }
    uint64_t bytesSent() const {
        const Spartan6Boot::Read* read = current();
        return read ? (clock() - read->from) / 8 : 0;
    }
    uint8_t byteSent(uint64_t index) const {
        const Spartan6Boot::Read* read = current();
        if (!read || index > 3)
            return 0xFF;
        return static_cast<uint8_t>((0x03000000 | read->address) >> (24 - 8 * index));
    }
    // Time of the next change of the chip select; ~0 if none is due.
    uint64_t nextEdgeNs() const {
        for (const Spartan6Boot::Read& read : boot_.reads)
            for (uint64_t edge : {read.from, read.to})
                if (edge != never && nsOf(edge) > now_())
                    return nsOf(edge);
        return never;
    }

private:
    static constexpr uint64_t second = 1'000'000'000, never = ~0ull;

    void configure() {
        boot_.configure(flash_->memory);
        begunAt_ = now_();
        doneAt_ = nsOf(boot_.clocks);
        if (onReconfigured)
            onReconfigured();
    }
    const Spartan6Boot::Read* current() const {
        for (const Spartan6Boot::Read& read : boot_.reads)
            if (read.from <= clock() && clock() < read.to)
                return &read;
        return nullptr;
    }
    uint64_t clock() const { return (now_() - begunAt_) * Spartan6Boot::cclkHz / second; }
    // Returns the first nanosecond at which clock() has reached `clock`.
    uint64_t nsOf(uint64_t clock) const {
        return begunAt_ + (clock * second + Spartan6Boot::cclkHz - 1) / Spartan6Boot::cclkHz;
    }

    std::function<uint64_t()> now_;
    SpiFlash* flash_ = nullptr;
    Spartan6Boot boot_;
    uint64_t begunAt_ = 0, doneAt_ = 0; // ns
    bool isProgramLow_ = false;
};
