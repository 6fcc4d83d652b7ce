// SPDX-License-Identifier: MIT
//
// mcb_model: the user port's FIFOs, and the path of commands through them.

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

// Does all work that is due: moves words, starts commands. Then computes the next due time.
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
        std::memcpy(&value, memory_.data() + address + 8 * w, 8);
        coming_.push({at, value});
    }
    wordsRead += words;
}

void McbModel::writeBurst(uint32_t address, unsigned words, uint64_t cas) {
    for (unsigned w = 0; w < words; ++w) {
        uint8_t* where = memory_.data() + address + 8 * w;
        const Write& word = write_.front();
        for (unsigned b = 0; b < 8; ++b)
            if (!(word.mask >> b & 1))
                where[b] = static_cast<uint8_t>(word.data >> (8 * b));
        write_.pop();
    }
    releases_.push({(cas + device_.part().cwl) / memoryClocks + 1, words});
    promised_ -= words;
    wordsWritten += words;
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
