// SPDX-License-Identifier: MIT
//
// recording: stores all inputs of a flight, with their times, in a file, so that the flight can be
// replayed exactly, without the ground program.
//
// The simulator is deterministic except for the bytes that the ground program sends on its serial
// port, and their times. The file has JSON Lines, with one object in each line:
//   {"flight": {flight.json}, "clkHz": n, "bridge": name, "hashes": {file: hash}}   the first line
//   {"ns": time, "up": "hexadecimal"}        bytes from the program to its modem
//   {"ns": time, "spoilt": n}                number of bytes with a wrong stop bit
//   {"ns": time, "down": n}                  number of bytes that the modem gave to the program
//   {"ns": time, "digest": "hexadecimal"}    hash of all bus accesses so far, every 100 ms
//   {"ns": time, "end": {...}}               final state of the flight; missing if the simulator
//                                            was killed

#pragma once

#include "serial_line.h"
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <sys/stat.h>
#include <unistd.h>

// Writes the events of a flight, with their times, as JSON Lines, for the mission's page and other
// tools. One object in each line:
//   {"ns": t, "packet": bytes, "from": "ground" or "uav", "lost": bool}   end of a packet
//   {"ns": t, "slot": n, "events": bits}   the processor has read these events of slot n; `bits`
//                                          is never 0
//   {"ns": t, "task": name}    the firmware switches to this task (Cortex-M3 only)
//   {"ns": t, "accesses": {"n": count}}    register accesses to slots in the 10 ms after t
class Events {
public:
    explicit Events(const std::string& file) : file_(file) {}

    void packet(uint64_t ns, size_t bytes, bool fromGround, bool lost) {
        put({{"ns", ns},
             {"packet", bytes},
             {"from", fromGround ? "ground" : "uav"},
             {"lost", lost}});
    }

    void task(uint64_t ns, const std::string& name) { put({{"ns", ns}, {"task", name}}); }

    // Records one access to a register. `word` is 16 times the slot, plus the word in the slot.
    void access(uint64_t ns, uint32_t word, uint32_t value, bool isWrite) {
        constexpr uint64_t binNs = 10'000'000;
        constexpr uint32_t event = 1;
        if (ns >= begin_ + binNs) {
            flush();
            begin_ = ns - ns % binNs;
        }
        ++accesses_[word / 16 % accesses_.size()];
        if (word % 16 == event && !isWrite && value != 0)
            put({{"ns", ns}, {"slot", word / 16}, {"events", value}});
    }

    // Writes the counted accesses.
    void flush() {
        nlohmann::json counts;
        for (size_t slot = 0; slot < accesses_.size(); ++slot)
            if (accesses_[slot])
                counts[std::to_string(slot)] = accesses_[slot];
        accesses_ = {};
        if (!counts.is_null())
            put({{"ns", begin_}, {"accesses", counts}});
    }

private:
    void put(const nlohmann::json& line) { file_ << line.dump() << std::endl; }

    std::ofstream file_;
    uint64_t begin_ = 0;
    std::array<unsigned, 64> accesses_{};
};

// Computes a hash of all bus accesses: clock, address, value and direction (FNV-1a).
class AccessDigest {
public:
    void add(uint64_t clock, uint32_t address, uint32_t value, bool isWrite) {
        for (uint64_t word : {clock, uint64_t(address) << 32 | value, uint64_t(isWrite)})
            hash_ = (hash_ ^ word) * 0x100000001B3;
    }
    std::string text() const { return fmt::format("{:016x}", hash_); }

private:
    uint64_t hash_ = 0xCBF29CE484222325;
};

// A serial line that is inserted between a modem and its real line: passes on all bytes and records
// them. A line of the file is written when the next line of the file begins, so the recording is
// usable even if the simulator is killed.
class RecordedLine : public SerialLine, SerialClient {
    using json = nlohmann::json;

public:
    // Opens the file and writes its first line, `head`. Throws std::runtime_error if the file
    // cannot be written.
    RecordedLine(SerialLine& line, const std::string& file, const json& head) : line_(line) {
        // only the owner may read the file, because the flight description may contain the modem's
        // key
        const int fd = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
        if (fd < 0 || fchmod(fd, 0600) != 0)
            throw std::runtime_error("cannot write '" + file + "': " + std::strerror(errno));
        close(fd);
        file_.open(file);
        line.attach(this);
        file_ << head.dump() << std::endl;
        if (!file_)
            throw std::runtime_error("cannot write '" + file + "': " + std::strerror(errno));
    }

    void note(uint64_t ns, const char* what, const json& value) {
        write();
        put({{"ns", ns}, {what, value}});
    }

    void setBitTime(double ns) override { line_.setBitTime(ns); }
    void setCts(bool accepts) override { line_.setCts(accepts); }
    void advance(uint64_t now) override {
        if (now != now_)
            write();
        now_ = now;
        line_.advance(now);
    }
    uint64_t nextEvent() const override { return line_.nextEvent(); }
    void wake(uint64_t now) override { line_.wake(now); }

private:
    void fromHost(uint8_t byte, uint64_t now) override {
        count("up");
        bytes_ += fmt::format("{:02x}", byte);
        client_->fromHost(byte, now);
    }
    void framingError(uint64_t now) override {
        count("spoilt");
        client_->framingError(now);
    }
    bool nextToHost(uint8_t& byte) override {
        if (!client_->nextToHost(byte))
            return false;
        count("down");
        return true;
    }
    // Counts one byte of kind `what`. Begins a new line of the file if the kind or the time
    // differs from the current line.
    void count(const char* what) {
        if (what_ && std::strcmp(what_, what) != 0)
            write();
        what_ = what;
        ++count_;
    }
    void put(const json& line) {
        if (!file_)
            return;
        file_ << line.dump() << std::endl;
        if (!file_)
            std::fprintf(stderr, "icesoc-sim: the recording of this flight ends here: %s\n",
                         std::strerror(errno));
    }
    void write() {
        if (!what_)
            return;
        put({{"ns", now_}, {what_, bytes_.empty() ? json(count_) : json(bytes_)}});
        what_ = nullptr;
        bytes_.clear();
        count_ = 0;
    }

    SerialLine& line_;
    std::ofstream file_;
    uint64_t now_ = 0;
    // kind of the line that is being collected; its time is `now_`
    const char* what_ = nullptr;
    std::string bytes_;
    unsigned count_ = 0;
};

// Replays a recording in place of the program at a modem's line.
class ReplayedLine : public SerialLine {
    using json = nlohmann::json;

public:
    // Reads a recording. Throws std::runtime_error with the line number if the file is malformed.
    explicit ReplayedLine(const std::string& file) {
        std::ifstream in(file);
        std::string text;
        if (!std::getline(in, text))
            throw std::runtime_error("cannot read '" + file +
                                     "': expected the folder of a recorded flight");
        size_t number = 1;
        try {
            head_ = json::parse(text);
            if (!head_.at("flight").is_object())
                throw std::runtime_error("it was recorded by another version of the simulator");
            while (!whole_ && std::getline(in, text) &&
                   !in.eof()) { // an incomplete last line is ignored
                ++number;
                json line = json::parse(text);
                endNs_ = line.at("ns");
                whole_ = line.contains("end");
                if (whole_ || line.contains("digest")) {
                    marks_.push_back(line);
                    continue;
                }
                Move move{endNs_, {}, line.value("spoilt", 0U), line.value("down", 0U)};
                const std::string up = line.value("up", "");
                for (size_t i = 0; i + 1 < up.size(); i += 2)
                    move.up.push_back(
                        static_cast<uint8_t>(std::stoul(up.substr(i, 2), nullptr, 16)));
                moves_.push_back(move);
            }
        } catch (const std::exception& e) {
            throw std::runtime_error(fmt::format(
                "'{}': expected the recording of a flight, line {}: {}", file, number, e.what()));
        }
    }

    const json& head() const { return head_; }
    uint64_t endNs() const { return endNs_; }
    // Throws std::runtime_error with the time if a digest or the final state differs from the
    // recorded flight.
    void compare(uint64_t ns, const char* what, const json& value) {
        if (mark_ == marks_.size())
            return;
        const json& mark = marks_[mark_++];
        if (mark.at("ns") != ns || !mark.contains(what) || mark.at(what) != value)
            throw std::runtime_error(fmt::format(
                "the replay differs from the recorded flight between {:.3f} and {:.3f} s. Chip, "
                "firmware, simulator and key must be the same as in the recorded flight",
                static_cast<double>(agreedNs_) / 1e9, static_cast<double>(ns) / 1e9));
        agreedNs_ = ns;
    }
    bool isWhole() const { return whole_; }

    void advance(uint64_t now) override {
        for (; at_ < moves_.size() && moves_[at_].ns <= now; ++at_) {
            const Move& move = moves_[at_];
            for (uint8_t byte : move.up)
                client_->fromHost(byte, now);
            for (unsigned n = 0; n < move.spoilt; ++n)
                client_->framingError(now);
            uint8_t byte;
            for (unsigned n = 0; n < move.down; ++n)
                (void)client_->nextToHost(byte);
        }
    }
    uint64_t nextEvent() const override { return at_ < moves_.size() ? moves_[at_].ns : never; }
    void wake(uint64_t) override {}

private:
    struct Move {
        uint64_t ns;
        std::vector<uint8_t> up;
        unsigned spoilt, down;
    };
    json head_;
    std::vector<Move> moves_;
    std::vector<json> marks_; // lines with the recorded digests and the final state
    size_t at_ = 0, mark_ = 0;
    uint64_t endNs_ = 0, agreedNs_ = 0;
    bool whole_ = false;
};
