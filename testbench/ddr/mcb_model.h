// SPDX-License-Identifier: MIT
//
// mcb_model: a 64-bit user port of the Spartan-6 memory controller block (UG388), and the DDR3 that
// it controls.
//
// The user port has a command FIFO of 4, data FIFOs of 64 words, and the flags of the real port. In
// these cases the real port sets an error flag or loses data; the model does the same and also
// throws McbError, so that a test fails:
//   a command while the FIFO is full (the real port ignores it), or before calibration is done
//   an address that is not a multiple of 8, or beyond the memory
//   a write command before its words are in the FIFO (wr_underrun, wr_error)
//   a word written to the full write FIFO (ignored), or read from the empty read FIFO (rd_error)
//   a word that arrives from the memory while the read FIFO is full (rd_overflow)
//
// The port executes commands one after another, in bursts of 8, on a 16-bit memory at DDR3-800
// (ddr3_timing.h). The memory has four clocks per clock of the design, which runs at 100 MHz.
// According to Xilinx AR36413, a write and an activate wait until the data of the previous read has
// ended. In all other cases a row is opened as soon as the command of the previous burst has been
// given. Addresses are ROW_BANK_COLUMN, MIG's default. Two constants (Timing) are estimates of the
// path through the FIFOs, both clock crossings and the PHY, because UG388 only gives a range for
// the read latency, which depends on the configuration.

#pragma once

#include "ddr3_timing.h"
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>
#include <stdexcept>

class McbError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

// A FIFO of fixed capacity (a power of two) that allocates no memory.
template <class T, size_t capacity> class Ring {
    static_assert((capacity & (capacity - 1)) == 0, "a power of two");

public:
    bool empty() const { return head_ == tail_; }
    size_t size() const { return head_ - tail_; }
    bool full() const { return size() == capacity; }
    T& front() { return items_[tail_ % capacity]; }
    const T& front() const { return items_[tail_ % capacity]; }
    // Adds an item. The caller must have checked that the FIFO is not full.
    void push(const T& item) { items_[head_++ % capacity] = item; }
    void pop() { ++tail_; }

private:
    T items_[capacity];
    size_t head_ = 0, tail_ = 0;
};

// Bytes that are 0 at first. The system provides each page when it is first used, so that a flight
// starts quickly even with a large memory.
class ZeroedBytes {
public:
    explicit ZeroedBytes(size_t size)
        : bytes_(static_cast<uint8_t*>(std::calloc(size, 1))), size_(size) {
        if (!bytes_)
            throw std::bad_alloc();
    }
    uint8_t* data() { return bytes_.get(); }
    const uint8_t* data() const { return bytes_.get(); }
    size_t size() const { return size_; }

private:
    struct Free {
        void operator()(uint8_t* bytes) const { std::free(bytes); }
    };
    std::unique_ptr<uint8_t, Free> bytes_;
    size_t size_;
};

class McbModel {
public:
    static constexpr unsigned commandDepth = 4, dataDepth = 64;
    static constexpr unsigned memoryClocks = 4; // number of memory clocks per clock of the design
    // Duration of a real start, clocks of the design: 200 us in reset, 500 us until CKE (JESD79-3,
    // 3.3.1), and an estimated 300 us for the calibration.
    static constexpr unsigned startClocks = 100'000;

    // Pins of the user port. The design's outputs must be set before cycle() is called.
    struct Pins {
        bool cmdEn = false, wrEn = false, rdEn = false;
        // wrMask: a bit of 1 means that the byte is not written; cmdBl: number of words minus 1
        uint8_t cmdInstr = 0, cmdBl = 0, wrMask = 0;
        uint32_t cmdByteAddr = 0;
        uint64_t wrData = 0;
        // outputs of the model
        bool cmdFull = false, cmdEmpty = true, wrFull = false, wrEmpty = true, rdFull = false,
             rdEmpty = true, calibDone = false;
        uint8_t wrCount = 0, rdCount = 0;
        bool wrUnderrun = false, wrError = false, rdOverflow = false, rdError = false; // sticky
        uint64_t rdData = 0;
    } pins;

    // Durations of the parts of an access, in clocks of the design.
    struct Timing {
        // duration of the calibration, clocks of the design; short for tests (a real start takes
        // startClocks)
        unsigned calibration = 64;
        unsigned commandWay = 6; // number of clocks from cmd_en to the command on the memory bus
        // number of clocks from the last word of a burst on the memory bus until rd_empty falls
        unsigned dataWay = 5;
    };

    explicit McbModel(size_t bytes = size_t(128) << 20) : McbModel(bytes, Timing()) {}
    McbModel(size_t bytes, Timing timing)
        : memory_(bytes), timing_(timing), device_(mt41j64m16, refreshLater) {}

    // Computes one clock cycle: reads the design's outputs at the edge, then sets the design's
    // inputs.
    void cycle() {
        if (pins.wrEn | pins.cmdEn | pins.rdEn)
            takeInputs();
        ++now_;
        if (now_ >= nextEvent_ && !hung_)
            work();
    }

    // untilEvent returns the number of clocks before the next event; the event happens in the clock
    // that follows these clocks. pass skips clocks in which the design is idle.
    uint64_t untilEvent() const {
        return hung_ ? ~0ull : nextEvent_ > now_ + 1 ? nextEvent_ - now_ - 1 : 0;
    }
    void pass(uint64_t clocks) { now_ += clocks; }

    // Restarts the memory, as after power-on; the start takes `clocks` clocks.
    void restart(unsigned clocks) {
        timing_.calibration = neverStarts_ ? ~0u >> 1 : static_cast<unsigned>(now_) + clocks;
        pins.calibDone = false;
        nextEvent_ = 0;
    }

    // Injects a fault of the clock, a command line or the supply: the calibration never ends.
    void breakStart() {
        neverStarts_ = true;
        restart(0);
    }
    bool neverStarts() const { return neverStarts_; }

    // Starts or ends a fault in which the memory hangs: no command begins and no word moves.
    // Waiting commands are carried out after the fault.
    void hang(bool on) { hung_ = on; }

    // Faults of the lines between the FPGA and the memory. Each halfword of data is one transfer on
    // DQ15..DQ0; row and column addresses share A9..A0.
    struct Lines {
        uint16_t dqLow = 0, dqHigh = 0; // data lines that are stuck at a level
        uint16_t dqShort = 0;           // data lines that are shorted to each other
        // data masks that are stuck at a level; bit 0 is LDM, bit 1 is UDM
        uint8_t maskLow = 0, maskHigh = 0;
        uint16_t addressLow = 0, addressShort = 0; // A12..A0
        // data strobes with a broken wire, so that reads return noise; bit 0 is LDQS, bit 1 is
        // UDQS
        uint8_t strobeOpen = 0;
        uint8_t bankLow = 0, bankShort = 0; // BA2..BA0
    };
    void plant(const Lines& lines) {
        lines_ = lines;
        isFaulty_ = true;
    }

    // Direct access to the contents of the memory, for pictures and checks.
    uint8_t* data() { return memory_.data(); }
    size_t size() const { return memory_.size(); }
    const Ddr3Timing& device() const { return device_; }

    uint64_t wordsRead = 0, wordsWritten = 0;

private:
    struct Command {
        uint64_t at; // time at which the memory receives the command
        uint32_t address;
        uint8_t instruction, words;
    };
    struct Write {
        uint64_t data;
        uint8_t mask;
    };
    struct Word {
        uint64_t at, data;
    };
    struct Release {
        uint64_t at;
        unsigned words;
    };

    void takeInputs();
    void takeCommand();
    void work();
    void start(const Command& command);
    void readBurst(uint32_t address, unsigned words, uint64_t cas);
    void writeBurst(uint32_t address, unsigned words, uint64_t cas);
    void show();
    uint32_t reached(uint32_t address) const;
    uint64_t seen(uint64_t word) const;
    uint8_t masked(uint8_t mask) const;

    Lines lines_;
    bool isFaulty_ = false, neverStarts_ = false;
    mutable uint64_t noise_ = 1;
    ZeroedBytes memory_;
    Timing timing_;
    Ddr3Timing device_;
    bool hung_ = false;
    uint64_t now_ = 0, nextEvent_ = 0;
    // Delays according to AR36413, memory clocks: additional wait before a refresh, and time from
    // the end of read data to a write.
    static constexpr unsigned refreshLater = 2, readToWrite = 3;
    uint64_t readEnd_ = 0; // memory clock in which the data of the last read ends
    bool lastWasRead_ = false;
    uint64_t free_ = 0; // earliest memory clock for the next command
    // number of words in the write FIFO that belong to commands that were accepted
    unsigned promised_ = 0;
    unsigned writeCount_ = 0; // number of words in the write FIFO, as the user port reports it
    Ring<Command, commandDepth> commands_;
    Ring<Write, dataDepth> write_; // writes not yet carried out
    // times at which words leave the write FIFO, with the number of words
    Ring<Release, 256> releases_;
    // words that the memory has sent and the read FIFO has not received yet
    Ring<Word, 1024> coming_;
    Ring<uint64_t, dataDepth> read_;
};

// ---- functions that connect the MCB user port of a Verilated module with an McbModel, around one
// clock edge ----

// Copies the design's settled outputs to the model, before the edge.
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

// Copies the model's outputs to the design's inputs, after the edge.
template <class Module> void driveMcb(Module& top, const McbModel& memory) {
    const McbModel::Pins& m = memory.pins;
    top.mcb_cmd_full_i = m.cmdFull;
    top.mcb_wr_full_i = m.wrFull;
    top.mcb_rd_empty_i = m.rdEmpty;
    top.mcb_rd_data_i = m.rdData;
    top.mcb_calib_done_i = m.calibDone;
}
