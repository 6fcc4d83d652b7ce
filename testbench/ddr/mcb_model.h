// SPDX-License-Identifier: MIT
//
// mcb_model: a 64-bit user port of the Spartan-6 memory controller block (UG388) with DDR3 behind
// it.
//
// Commands wait in a FIFO of 4, data in FIFOs of 64 words. Times are in cycles of the design's
// clock, from DDR3-800 data-sheet numbers at 100 MHz. What the real one refuses throws McbError.

#ifndef MCB_MODEL_H
#define MCB_MODEL_H

#include <cstdint>
#include <cstring>
#include <deque>
#include <stdexcept>
#include <string>
#include <vector>

class McbError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

class McbModel {
public:
    // Pins of the user port; the design's side is set before sample().
    struct Pins {
        bool cmdEn = false, wrEn = false, rdEn = false;
        uint8_t cmdInstr = 0, cmdBl = 0, wrMask = 0;
        uint32_t cmdByteAddr = 0;
        uint64_t wrData = 0;
        // to the design
        bool cmdFull = false, wrFull = false, rdEmpty = true, calibDone = false;
        uint64_t rdData = 0;
    } pins;

    struct Timing {
        unsigned calibration = 64; // shortened: the real one takes about 100 us
        unsigned rowHit = 14;      // command to first data through the controller, CL included
        unsigned rowMiss = 18;     // + tRP + tRCD (27.5 ns)
        unsigned turnaround = 2;   // read after write: tWTR
        unsigned refreshEvery = 780, refreshTakes = 16; // tREFI 7.8 us, tRFC 160 ns
    };

    explicit McbModel(size_t bytes = size_t(128) << 20) : McbModel(bytes, Timing()) {}
    McbModel(size_t bytes, Timing timing) : memory_(bytes), timing_(timing) {}

    // One clock cycle: what the design does at the edge, then what it sees after it.
    void cycle() {
        if (pins.wrEn || pins.cmdEn || pins.rdEn)
            takeInputs();
        ++now_;
        if (now_ >= nextRefresh_) {
            nextRefresh_ = now_ + timing_.refreshEvery;
            busyUntil_ = std::max(busyUntil_, now_) + timing_.refreshTakes;
            openRow_ = ~0u;
        }
        if (!commands_.empty() || !pending_.empty())
            work();
        pins.calibDone = now_ >= timing_.calibration;
    }

    // Back door, for pictures and checks.
    uint8_t* data() { return memory_.data(); }
    size_t size() const { return memory_.size(); }

    uint64_t wordsRead = 0, wordsWritten = 0, rowMisses = 0;

private:
    struct Command {
        bool read;
        uint32_t address;
        unsigned words;
    };
    struct Write {
        uint64_t data;
        uint8_t mask;
    };
    struct Word {
        uint64_t at, data;
    };

    void takeInputs() {
        if (pins.rdEn) {
            if (read_.empty())
                throw McbError("MCB: read of an empty FIFO");
            read_.pop_front();
            showRead();
        }
        if (pins.wrEn) {
            if (write_.size() >= 64)
                throw McbError("MCB: write FIFO overflow");
            write_.push_back({pins.wrData, pins.wrMask});
            pins.wrFull = write_.size() >= 64;
        }
        if (pins.cmdEn)
            takeCommand();
    }

    void takeCommand() {
        if (now_ < timing_.calibration)
            throw McbError("MCB: command before calibration is done");
        if (commands_.size() >= 4)
            throw McbError("MCB: command FIFO overflow");
        Command command{(pins.cmdInstr & 1) != 0, pins.cmdByteAddr, pins.cmdBl + 1u};
        if (command.address % 8)
            throw McbError("MCB: address not aligned to 8 bytes");
        if (command.address + size_t(8) * command.words > memory_.size())
            throw McbError("MCB: address " + std::to_string(command.address) +
                           " beyond the memory");
        queuedWrites_ += command.read ? 0 : command.words;
        if (queuedWrites_ > write_.size())
            throw McbError("MCB: write command before its data");
        commands_.push_back(command);
        pins.cmdFull = commands_.size() >= 4;
    }

    // Starts the next command when the memory is free, and lets read words come one a cycle.
    void work() {
        if (!commands_.empty() && now_ >= busyUntil_ && pending_.size() + read_.size() + 16 <= 64) {
            Command command = commands_.front();
            commands_.pop_front();
            pins.cmdFull = false;
            start(command);
        }
        while (!pending_.empty() && pending_.front().at <= now_) {
            read_.push_back(pending_.front().data);
            pending_.pop_front();
            if (read_.size() == 1)
                showRead();
        }
    }

    void start(const Command& command) {
        uint32_t row = command.address >> 11; // 2 KiB a row of the x16 part
        bool miss = row != openRow_;
        rowMisses += miss;
        unsigned latency = miss ? timing_.rowMiss : timing_.rowHit;
        if (command.read && lastWrote_)
            latency += timing_.turnaround;
        openRow_ = row;
        lastWrote_ = !command.read;
        for (unsigned w = 0; w < command.words; ++w) {
            uint8_t* where = memory_.data() + command.address + 8 * w;
            if (command.read) {
                uint64_t value;
                std::memcpy(&value, where, 8);
                pending_.push_back({now_ + latency + w, value});
                ++wordsRead;
            } else {
                Write word = write_.front();
                write_.pop_front();
                for (unsigned b = 0; b < 8; ++b)
                    if (!(word.mask >> b & 1))
                        where[b] = static_cast<uint8_t>(word.data >> (8 * b));
                ++wordsWritten;
            }
        }
        if (!command.read) {
            queuedWrites_ -= command.words;
            pins.wrFull = write_.size() >= 64;
        }
        // The bus is taken for the data; a miss costs its precharge and activation as well.
        busyUntil_ = now_ + command.words + (miss ? timing_.rowMiss - timing_.rowHit : 0);
    }

    void showRead() {
        pins.rdEmpty = read_.empty();
        if (!read_.empty())
            pins.rdData = read_.front();
    }

    std::vector<uint8_t> memory_;
    Timing timing_;
    uint64_t now_ = 0, busyUntil_ = 0, nextRefresh_ = 780;
    uint32_t openRow_ = ~0u;
    bool lastWrote_ = false;
    size_t queuedWrites_ = 0;
    std::deque<Command> commands_;
    std::deque<Write> write_;
    std::deque<Word> pending_;
    std::deque<uint64_t> read_;
};

#endif
