// SPDX-License-Identifier: MIT
//
// litedram_model: a 64-bit native port of LiteDRAM with DDR3 behind it.
//
// The port, as LiteDRAM's crossbar gives it: one command is one word; cmd is a handshake;
// wdata_ready and rdata_valid come a fixed time after the memory's own command and wait for nobody,
// so LitedramError is thrown where the design has no word to give (wdata_valid low) or cannot take
// one (rdata_ready low), withdraws or changes a command that waits, or leaves the memory. A port
// has commands under way in one bank at a time: for another bank, cmd_ready waits until all were
// issued (the lock of LiteDRAM's bank machines).
//
// The memory: MT41J128M8, 8 bits, DDR3-800, behind a quarter-rate PHY at 100 MHz, so that a word is
// a burst of 8 and takes one clock. Addresses are ROW_BANK_COL.

#ifndef LITEDRAM_MODEL_H
#define LITEDRAM_MODEL_H

#include "ddr3_timing.h"
#include "ring.h"
#include <cstdint>
#include <stdexcept>
#include <vector>

class LitedramError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

class LitedramModel {
public:
    static constexpr unsigned bankDepth = 8; // cmd_buffer_depth's default
    static constexpr unsigned memoryClocks = 4;

    // The design's side is set before cycle(), cmdReady from ready().
    struct Pins {
        bool cmdValid = false, cmdWe = false, wdataValid = false, rdataReady = false;
        uint32_t cmdAddr = 0; // of a 64-bit word
        uint8_t wdataWe = 0;  // 1 = byte is written
        uint64_t wdataData = 0;
        // to the design
        bool cmdReady = false, wdataReady = false, rdataValid = false, initDone = false;
        uint64_t rdataData = 0;
    } pins;

    // Clocks of the design; LiteDRAM's crossbar adds read_latency and write_latency of the PHY.
    struct Timing {
        unsigned initialisation = 64; // shortened
        unsigned commandWay = 3;      // crossbar and bank machine
        unsigned readWay = 4, writeWay = 1;
    };

    explicit LitedramModel(size_t bytes = size_t(128) << 20) : LitedramModel(bytes, Timing()) {}
    LitedramModel(size_t bytes, Timing timing)
        : memory_(bytes), timing_(timing), device_(mt41j128m8) {}

    // cmd_ready for the command that is shown: combinational, as in the crossbar.
    bool ready(uint32_t cmdAddr) const;
    // One clock cycle: what the design does at the edge, then what it sees after it.
    void cycle();

    uint8_t* data() { return memory_.data(); }
    size_t size() const { return memory_.size(); }
    const Ddr3Timing& device() const { return device_; }

    uint64_t wordsRead = 0, wordsWritten = 0;

private:
    struct Command {
        uint64_t at;
        uint32_t address;
        bool write;
    };
    struct Issued {
        uint64_t at; // of its data
        uint32_t address;
        bool write;
    };
    struct Word {
        uint64_t at, data;
    };

    void takeCommand();
    void takeWrite();
    void issue();
    void fetch();

    std::vector<uint8_t> memory_;
    Timing timing_;
    Ddr3Timing device_;
    uint64_t now_ = 0, free_ = 0;
    Ring<Command, bankDepth> commands_;
    Ring<Issued, 256> order_; // issued; a read is fetched when the writes before it are done
    Ring<Word, 256> reads_;
    bool waited_ = false; // a command that was not taken must stay
    uint32_t waitedAddr_ = 0;
    bool waitedWe_ = false;
};

#endif
