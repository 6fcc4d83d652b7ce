// SPDX-License-Identifier: MIT
//
// fpga_pins: models the configuration of the FPGA and its flash, as the processor sees it at its
// pins: SPI 1 (PA4 to PA7; the FPGA drives them while it configures itself), PROGRAM_B and DONE. If
// no flash is connected, the FPGA is always configured.

#pragma once

#include "spartan6_boot.h"
#include "spi_flash.h"
#include <functional>

class FpgaPins {
public:
    // `now` returns simulated time, ns.
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
    bool isDoneWired = true; // false: the wire of DONE is missing, so DONE always reads as low
    const Spartan6Boot& boot() const { return boot_; }
    // called when the FPGA has lost its configuration and begins to load a new configuration
    std::function<void()> onReconfigured;

    // Transfers one byte in both directions, with the processor as the master.
    uint8_t transfer(uint8_t byte) { return flash_ ? flash_->transfer(byte) : 0xFF; }
    // The state while the FPGA is the master. isReading returns true if the FPGA's chip select is
    // low; bytesSent returns the number of bytes sent since chip select fell; byteSent returns one
    // of these bytes.
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
    // Returns the time of the next change of the chip select; ~0 if no change is due.
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
    // Returns the time, ns, at which clock() reaches `clock`.
    uint64_t nsOf(uint64_t clock) const {
        return begunAt_ + (clock * second + Spartan6Boot::cclkHz - 1) / Spartan6Boot::cclkHz;
    }

    std::function<uint64_t()> now_;
    SpiFlash* flash_ = nullptr;
    Spartan6Boot boot_;
    uint64_t begunAt_ = 0, doneAt_ = 0; // ns
    bool isProgramLow_ = false;
};
