// SPDX-License-Identifier: MIT
//
// spartan6_boot: interprets the packets of a bitstream (UG380, tables 5-23 to 5-30). The CRC of 22
// bits is documented only by public programs that read bitstreams (prjcombine).

#include "spartan6_boot.h"
#include <random>

namespace {

enum Register : unsigned {
    Crc = 0,
    Fdri = 3,
    Cmd = 5,
    Cor1 = 10,
    Lout = 9,
    IdCode = 14,
    Csbo = 18,
    General1 = 19
};
enum Command : uint16_t { Wcfg = 1, Start = 5, Rcrc = 7, Desync = 13, Iprog = 14 };
constexpr uint16_t crcBypass = 0x10;                            // bit in COR1 that disables the CRC
constexpr uint32_t noCrc = 0x9876DEFC, watchdogClocks = 0xFFFF; // CWDT's default

void addCrc(uint32_t& crc, unsigned reg, uint16_t word) {
    crc <<= 1;
    if (crc & 0x400000)
        crc ^= 0x409081;
    crc ^= word | reg << 16;
}

} // namespace

void Spartan6Boot::configure(const std::vector<uint8_t>& flash) {
    // duration of clearing the configuration memory, clocks; about a millisecond
    constexpr uint64_t clearing = 2000;
    running.reset();
    isStuck = false;
    strikes = 0;
    clocks = 0;
    reads.clear();
    uint32_t address = 0;
    // The FPGA tries three addresses: the header, the MultiBoot bitstream, the golden bitstream.
    for (unsigned stage = 0; stage < 3; ++stage) {
        if (stage)
            address = uint32_t(general_[2 * stage - 1] & 0xFF) << 16 | general_[2 * stage - 2];
        End end = End::Failed;
        for (unsigned i = 0; i < 3 && end == End::Failed; ++i) {
            clocks += clearing;
            reads.push_back({address, clocks, clocks});
            // clocks in which the read instruction and the address are sent to the flash
            clocks += 32;
            end = load(flash, address);
            reads.back().to = end == End::Stuck ? ~0ull : clocks;
            strikes += end == End::Failed;
        }
        if (end == End::Done)
            running = address;
        isStuck = end == End::Stuck;
        if (end == End::Done || end == End::Stuck || (stage == 0 && end == End::Failed))
            return;
    }
}

Spartan6Boot::End Spartan6Boot::load(const std::vector<uint8_t>& flash, uint32_t address) {
    size_t at = address;
    const auto read = [&](unsigned bytes) {
        uint32_t value = 0;
        for (; bytes; --bytes, clocks += 8)
            value = value << 8 | (at < flash.size() ? flash[at++] : 0xFF);
        return value;
    };
    uint32_t last = 0;
    for (const uint64_t begun = clocks; last != 0xAA995566; last = last << 8 | read(1))
        if (clocks - begun > watchdogClocks)
            return End::Failed;
    uint32_t crc = 0;
    bool isStarted = false, hasCrc = true, isOurs = false;
    while (at < flash.size()) {
        const uint32_t header = read(2);
        const unsigned type = header >> 13, operation = header >> 11 & 3, reg = header >> 5 & 63;
        uint32_t count = header & 31;
        if (type == 1 && operation == 0)
            continue; // NOP
        if ((type != 1 && type != 2) || operation != 2)
            return End::Stuck;
        if (type == 2)
            count = read(4);
        uint32_t value = 0;
        for (uint32_t i = 0; i < count && at < flash.size(); ++i) {
            const auto data = static_cast<uint16_t>(read(2));
            value = value << 16 | data;
            if (reg != Crc && reg != Lout && reg != Csbo)
                addCrc(crc, reg, data);
        }
        if (reg == Fdri) { // frame data is followed by the CRC, without a separate command
            if (!isOurs)
                return End::Failed;
            value = read(4);
        }
        if (reg == Crc || reg == Fdri) {
            if (value != (hasCrc ? crc : noCrc))
                return End::Failed;
        } else if (reg == Cor1) {
            hasCrc = !(value & crcBypass);
        } else if (reg == IdCode) {
            isOurs = (value & 0x0FFFFFFF) == (idCode & 0x0FFFFFFF);
        } else if (reg >= General1 && reg < General1 + 4) {
            general_[reg - General1] = static_cast<uint16_t>(value);
        } else if (reg == Cmd && value == Rcrc) {
            crc = 0;
        } else if (reg == Cmd && value == Start) {
            isStarted = true;
        } else if (reg == Cmd && value == Iprog) {
            return End::Iprog;
        } else if (reg == Cmd && value == Desync) {
            return isStarted ? End::Done : End::Stuck;
        }
    }
    return End::Stuck; // the configuration never ends after this fault
}

std::vector<uint8_t> standInBitstream(uint32_t seed, uint32_t frameWords, uint32_t idCode) {
    std::vector<uint8_t> bits(16, 0xFF);
    uint32_t crc = 0;
    const auto put = [&bits](uint32_t word) {
        bits.push_back(static_cast<uint8_t>(word >> 8));
        bits.push_back(static_cast<uint8_t>(word));
    };
    const auto put32 = [&](uint32_t value) {
        put(value >> 16);
        put(value);
    };
    const auto write = [&](unsigned reg, const std::vector<uint16_t>& words) {
        put(1 << 13 | 2 << 11 | reg << 5 | static_cast<uint32_t>(words.size()));
        for (uint16_t word : words) {
            put(word);
            addCrc(crc, reg, word);
        }
    };
    put32(0xAA995566);
    write(Cmd, {Rcrc});
    crc = 0;
    write(IdCode, {static_cast<uint16_t>(idCode >> 16), static_cast<uint16_t>(idCode)});
    // ISE writes about this number of words between the sync word and the frames
    for (int i = 0; i < 32; ++i)
        put(0x2000);
    write(Cmd, {Wcfg});
    put(2 << 13 | 2 << 11 | Fdri << 5);
    put32(frameWords);
    std::mt19937 random(seed);
    for (uint32_t i = 0; i < frameWords; ++i) {
        // Most frames of a real design are empty, so most words here are 0.
        const auto word = i % 64 < 16 ? static_cast<uint16_t>(random()) : uint16_t(0);
        put(word);
        addCrc(crc, Fdri, word);
    }
    put32(crc);
    write(Cmd, {Start});
    put(1 << 13 | 2 << 11 | Crc << 5 | 2);
    put32(crc);
    write(Cmd, {Desync});
    for (int i = 0; i < 16; ++i)
        put(0x2000);
    return bits;
}
