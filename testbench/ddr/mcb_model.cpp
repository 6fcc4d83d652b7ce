// SPDX-License-Identifier: MIT
//
// mcb_model: the part of McbModel with the FIFOs of the user port and the execution of its
// commands.

#include "mcb_model.h"
#include <cstring>

void McbModel::takeInputs() {
    if (pins.rdEn) {
        if (read_.empty()) {
            pins.rdError = true;
            throw McbError("MCB: read of an empty FIFO");
        }
        read_.pop();
    }
    if (pins.wrEn) {
        if (writeCount_ >= dataDepth)
            throw McbError("MCB: write FIFO overflow");
        write_.push({pins.wrData, pins.wrMask});
        ++writeCount_;
    }
    if (pins.cmdEn)
        takeCommand();
    show();
}

void McbModel::takeCommand() {
    if (now_ < timing_.calibration)
        throw McbError("MCB: command before calibration is done");
    if (commands_.full())
        throw McbError("MCB: command FIFO overflow");
    unsigned words = pins.cmdBl + 1u;
    bool refresh = (pins.cmdInstr & 4) != 0, read = (pins.cmdInstr & 1) != 0;
    if (pins.cmdBl >= 64)
        throw McbError("MCB: burst of more than 64 words");
    if (!refresh) {
        if (pins.cmdByteAddr % 8)
            throw McbError("MCB: address not aligned to 8 bytes");
        if (pins.cmdByteAddr + size_t(8) * words > memory_.size())
            throw McbError("MCB: address " + std::to_string(pins.cmdByteAddr) +
                           " beyond the memory");
        if (!read && promised_ + words > write_.size()) {
            pins.wrUnderrun = pins.wrError = true;
            throw McbError("MCB: write command before its data");
        }
        promised_ += read ? 0 : words;
    }
    commands_.push(
        {now_ + timing_.commandWay, pins.cmdByteAddr, pins.cmdInstr, static_cast<uint8_t>(words)});
    nextEvent_ = std::min(nextEvent_, now_ + timing_.commandWay);
}

// Moves the words and starts the commands that are due, then computes the time of the next event.
void McbModel::work() {
    pins.calibDone = now_ >= timing_.calibration;
    while (!releases_.empty() && releases_.front().at <= now_) {
        writeCount_ -= releases_.front().words;
        releases_.pop();
    }
    while (!coming_.empty() && coming_.front().at <= now_) {
        if (read_.full()) {
            pins.rdOverflow = pins.rdError = true;
            throw McbError("MCB: read FIFO overflow");
        }
        read_.push(coming_.front().data);
        coming_.pop();
    }
    while (!commands_.empty() && commands_.front().at <= now_ &&
           free_ < (now_ + 1) * memoryClocks) {
        start(commands_.front());
        commands_.pop();
    }
    nextEvent_ = pins.calibDone ? ~0ull : timing_.calibration;
    if (!releases_.empty())
        nextEvent_ = std::min(nextEvent_, releases_.front().at);
    if (!coming_.empty())
        nextEvent_ = std::min(nextEvent_, coming_.front().at);
    if (!commands_.empty())
        nextEvent_ = std::min(nextEvent_, std::max(commands_.front().at, free_ / memoryClocks));
    show();
}

void McbModel::start(const Command& command) {
    uint64_t at = std::max(free_, now_ * memoryClocks);
    if (command.instruction & 4) {
        free_ = device_.refreshNow(at);
        return;
    }
    bool read = command.instruction & 1;
    uint32_t address = command.address;
    unsigned burstBytes = device_.part().burstBytes;
    for (unsigned left = command.words; left > 0;) {
        unsigned words = std::min(left, (burstBytes - address % burstBytes) / 8);
        if (lastWasRead_ && !read)
            at = std::max(at, readEnd_ + readToWrite);
        else if (lastWasRead_ && !device_.isOpen(address))
            at = std::max(at, readEnd_);
        lastWasRead_ = read;
        uint64_t cas = device_.access(at, read, address);
        read ? readBurst(address, words, cas) : writeBurst(address, words, cas);
        address += 8 * words;
        left -= words;
        at = cas + 1;
    }
    if (command.instruction & 2)
        device_.autoPrecharge(address - 8);
    free_ = at;
}

void McbModel::readBurst(uint32_t address, unsigned words, uint64_t cas) {
    readEnd_ = cas + device_.part().cl + 4;
    uint64_t at = (readEnd_ + memoryClocks - 1) / memoryClocks + timing_.dataWay;
    for (unsigned w = 0; w < words; ++w) {
        uint64_t value;
        std::memcpy(&value, memory_.data() + reached(address + 8 * w), 8);
        coming_.push({at, isFaulty_ ? seen(value) : value});
    }
    wordsRead += words;
}

void McbModel::writeBurst(uint32_t address, unsigned words, uint64_t cas) {
    for (unsigned w = 0; w < words; ++w) {
        uint8_t* where = memory_.data() + reached(address + 8 * w);
        const Write& word = write_.front();
        const uint8_t mask = isFaulty_ ? masked(word.mask) : word.mask;
        for (unsigned b = 0; b < 8; ++b)
            if (!(mask >> b & 1))
                where[b] = static_cast<uint8_t>(word.data >> (8 * b));
        write_.pop();
    }
    releases_.push({(cas + device_.part().cwl) / memoryClocks + 1, words});
    promised_ -= words;
    wordsWritten += words;
}

// Returns `value` as it appears on lines that are shorted to each other: if one of the shorted
// `lines` is low, all of them are low.
static uint32_t joined(uint32_t value, uint32_t lines) {
    return lines && (value & lines) != lines ? value & ~lines : value;
}

// Returns the address that a faulty memory accesses instead of `address`. Bits 10..1 are the
// column, 13..11 the bank, 26..14 the row.
uint32_t McbModel::reached(uint32_t address) const {
    if (!isFaulty_)
        return address;
    auto line = [this](uint32_t value) {
        return joined(value & ~uint32_t(lines_.addressLow), lines_.addressShort);
    };
    const uint32_t column = address >> 1 & 0x3FF, bank = address >> 11 & 7, row = address >> 14;
    return (line(column & ~7u) & 0x3F8) << 1 | (column & 7) << 1 |
           joined(bank & ~uint32_t(lines_.bankLow), lines_.bankShort) << 11 |
           (line(row) & 0x1FFF) << 14;
}

uint64_t McbModel::seen(uint64_t word) const {
    uint64_t result = 0;
    for (unsigned beat = 0; beat < 4; ++beat) {
        uint32_t bits = static_cast<uint16_t>(word >> 16 * beat);
        bits = joined((bits | lines_.dqHigh) & ~uint32_t(lines_.dqLow), lines_.dqShort);
        noise_ = noise_ * 6364136223846793005u + 1442695040888963407u;
        for (unsigned lane = 0; lane < 2; ++lane)
            if (lines_.strobeOpen >> lane & 1)
                bits = (bits & ~(0xFFu << 8 * lane)) | (noise_ >> 40 & 0xFF) << 8 * lane;
        result |= uint64_t(bits) << 16 * beat;
    }
    return result;
}

uint8_t McbModel::masked(uint8_t mask) const {
    const unsigned low = lines_.maskLow * 0x55u, high = lines_.maskHigh * 0x55u;
    return static_cast<uint8_t>((mask | high) & ~low);
}

void McbModel::show() {
    pins.cmdFull = commands_.full();
    pins.cmdEmpty = commands_.empty();
    pins.wrFull = writeCount_ >= dataDepth;
    pins.wrEmpty = writeCount_ == 0;
    pins.wrCount = static_cast<uint8_t>(writeCount_);
    pins.rdFull = read_.full();
    pins.rdEmpty = read_.empty();
    pins.rdCount = static_cast<uint8_t>(read_.size());
    if (!read_.empty())
        pins.rdData = read_.front();
}
