// SPDX-License-Identifier: MIT
//
// litedram_model: commands into the bank's queue, data at its time.

#include "litedram_model.h"
#include <cstring>

bool LitedramModel::ready(uint32_t cmdAddr) const {
    bool locked =
        !commands_.empty() && device_.bank(commands_.front().address) != device_.bank(cmdAddr * 8);
    return pins.initDone && !commands_.full() && !locked;
}

void LitedramModel::cycle() {
    takeCommand();
    if (pins.wdataReady)
        takeWrite();
    if (pins.rdataValid && !pins.rdataReady)
        throw LitedramError("LiteDRAM: a word was read, and nobody took it");
    ++now_;
    issue();
    fetch();

    pins.initDone = now_ >= timing_.initialisation;
    pins.wdataReady = !order_.empty() && order_.front().at <= now_; // the front is a write
    pins.rdataValid = !reads_.empty() && reads_.front().at <= now_;
    if (pins.rdataValid) {
        pins.rdataData = reads_.front().data;
        reads_.pop();
        ++wordsRead;
    }
}

void LitedramModel::takeCommand() {
    if (waited_ && (!pins.cmdValid || pins.cmdAddr != waitedAddr_ || pins.cmdWe != waitedWe_))
        throw LitedramError("LiteDRAM: a command was changed while it waited");
    waited_ = pins.cmdValid && !pins.cmdReady;
    waitedAddr_ = pins.cmdAddr;
    waitedWe_ = pins.cmdWe;
    if (!pins.cmdValid || !pins.cmdReady)
        return;
    if (pins.cmdAddr >= memory_.size() / 8)
        throw LitedramError("LiteDRAM: address beyond the memory");
    commands_.push({now_ + timing_.commandWay, pins.cmdAddr * 8, pins.cmdWe});
}

void LitedramModel::takeWrite() {
    if (!pins.wdataValid)
        throw LitedramError("LiteDRAM: a word is to be written, and there is none");
    uint8_t* where = memory_.data() + order_.front().address;
    for (unsigned b = 0; b < 8; ++b)
        if (pins.wdataWe >> b & 1)
            where[b] = static_cast<uint8_t>(pins.wdataData >> (8 * b));
    order_.pop();
    ++wordsWritten;
}

// Takes at most one command of the port a clock, when the device can take it.
void LitedramModel::issue() {
    if (commands_.empty() || commands_.front().at > now_ || free_ >= (now_ + 1) * memoryClocks)
        return;
    const Command& command = commands_.front();
    uint64_t cas =
        device_.access(std::max(free_, now_ * memoryClocks), !command.write, command.address);
    free_ = cas + memoryClocks;
    const Ddr3Part& part = device_.part();
    uint64_t at = command.write
                      ? std::max(cas / memoryClocks, now_) + timing_.writeWay
                      : (cas + part.cl + 4 + memoryClocks - 1) / memoryClocks + timing_.readWay;
    order_.push({at, command.address, command.write});
    commands_.pop();
}

void LitedramModel::fetch() {
    for (; !order_.empty() && !order_.front().write; order_.pop()) {
        uint64_t value;
        std::memcpy(&value, memory_.data() + order_.front().address, 8);
        reads_.push({order_.front().at, value});
    }
}
