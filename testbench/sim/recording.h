// SPDX-License-Identifier: MIT
//
// recording: stores all inputs of a flight, with their times, in a file, so that it can be flown
// again bit by bit, without the ground's program.
//
// The simulator is deterministic except for the bytes of the ground's program on its serial port,
// and their times. The file is JSON Lines, one object each:
//   {"flight": {flight.json}, "clkHz": n, "hashes": {file: hash}}   the first line
//   {"ns": time, "up": "hexadecimal"}        bytes from the program to its modem
//   {"ns": time, "spoilt": n}                bytes with a wrong stop bit
//   {"ns": time, "down": n}                  bytes that the modem handed to the program
//   {"ns": time, "digest": "hexadecimal"}    of all bus accesses until then, each 100 ms
//   {"ns": time, "end": {...}}               the flight's final state; missing if it was killed

#ifndef RECORDING_H
#define RECORDING_H

#include "serial_line.h"
#include <fstream>
#include <nlohmann/json.hpp>

// A hash that grows with each bus access: its clock, address, value and direction (FNV-1a).
class AccessDigest {
public:
    void add(uint64_t clock, uint32_t address, uint32_t value, bool isWrite);
    std::string text() const;

private:
    uint64_t hash_ = 0xCBF29CE484222325;
};

// Stands between a modem and its line, passes all bytes on and records them. A line of the file is
// written when the next begins, so a killed simulator leaves its work.
class RecordedLine : public SerialLine, SerialClient {
public:
    // Throws std::runtime_error if the file cannot be written.
    RecordedLine(SerialLine& line, const std::string& file, const nlohmann::json& head);

    void note(uint64_t ns, const char* what, const nlohmann::json& value);

    void setBitTime(double ns) override { line_.setBitTime(ns); }
    void setCts(bool accepts) override { line_.setCts(accepts); }
    void advance(uint64_t now) override;
    uint64_t nextEvent() const override { return line_.nextEvent(); }
    void wake(uint64_t now) override { line_.wake(now); }

private:
    void fromHost(uint8_t byte, uint64_t now) override;
    void framingError(uint64_t now) override;
    bool nextToHost(uint8_t& byte) override;
    void count(const char* what);
    void put(const nlohmann::json& line);
    void write();

    SerialLine& line_;
    std::ofstream file_;
    uint64_t now_ = 0;
    // The content of the line under way, of `now_`.
    const char* what_ = nullptr;
    std::string bytes_;
    unsigned count_ = 0;
};

// A recording, read back: the line of a modem without its program.
class ReplayedLine : public SerialLine {
public:
    // Throws std::runtime_error, with the line, if the file is malformed.
    explicit ReplayedLine(const std::string& file);

    const nlohmann::json& head() const { return head_; }
    uint64_t endNs() const { return endNs_; }
    // Throws std::runtime_error, with the place, if the flight differs from the recorded one, by a
    // digest or its final state.
    void compare(uint64_t ns, const char* what, const nlohmann::json& value);
    bool isWhole() const { return whole_; }

    void advance(uint64_t now) override;
    uint64_t nextEvent() const override { return at_ < moves_.size() ? moves_[at_].ns : never; }
    void wake(uint64_t) override {}

private:
    struct Move {
        uint64_t ns;
        std::vector<uint8_t> up;
        unsigned spoilt, down;
    };
    nlohmann::json head_;
    std::vector<Move> moves_;
    std::vector<nlohmann::json> marks_; // digests and the end
    size_t at_ = 0, mark_ = 0;
    uint64_t endNs_ = 0, agreedNs_ = 0;
    bool whole_ = false;
};

#endif
