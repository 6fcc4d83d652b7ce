// SPDX-License-Identifier: MIT
//
// fpga_pins: the FPGA's configuration and its flash at the processor's pins: SPI 1 (PA4 to PA7),
// which the FPGA drives while it configures itself, PROGRAM_B and DONE. Without a flash the FPGA is
// always configured.

#ifndef FPGA_PINS_H
#define FPGA_PINS_H

#include "spartan6_boot.h"
#include "spi_flash.h"
#include <functional>

class FpgaPins {
public:
    // `now` is simulated time in ns.
    explicit FpgaPins(std::function<uint64_t()> now) : now_(std::move(now)) {}

    void wire(SpiFlash& flash) { flash_ = &flash; }
    void powerOn();
    // Takes the processor's outputs: chip select, PROGRAM_B.
    void drive(bool isSelectLow, bool isProgramLow);
    bool isDone() const { return isDoneWired && (!flash_ || (boot_.running && now_() >= doneAt_)); }
    bool isDoneWired = true; // else it is read as low
    const Spartan6Boot& boot() const { return boot_; }
    // Called when the FPGA has lost its configuration, and starts to load one.
    std::function<void()> onReconfigured;

    // The processor is the master: a byte out and one in.
    uint8_t transfer(uint8_t byte) { return flash_ ? flash_->transfer(byte) : 0xFF; }
    // The FPGA is the master: whether its chip select is low, how many bytes it has sent since
    // then, and each.
    bool isReading() const { return current() != nullptr; }
    uint64_t bytesSent() const;
    uint8_t byteSent(uint64_t index) const;
    // When the chip select changes next; ~0: it does not.
    uint64_t nextEdgeNs() const;

private:
    void configure();
    const Spartan6Boot::Read* current() const;
    uint64_t clock() const;
    uint64_t nsOf(uint64_t clock) const;

    std::function<uint64_t()> now_;
    SpiFlash* flash_ = nullptr;
    Spartan6Boot boot_;
    uint64_t begunAt_ = 0, doneAt_ = 0; // ns
    bool isProgramLow_ = false;
};

#endif
