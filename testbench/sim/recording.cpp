// SPDX-License-Identifier: MIT
//
// recording: writes and reads the lines of a flight.

#include "recording.h"
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <stdexcept>
#include <sys/stat.h>
#include <unistd.h>

using nlohmann::json;

void AccessDigest::add(uint64_t clock, uint32_t address, uint32_t value, bool isWrite) {
    for (uint64_t word : {clock, uint64_t(address) << 32 | value, uint64_t(isWrite)})
        hash_ = (hash_ ^ word) * 0x100000001B3;
}

std::string AccessDigest::text() const {
    return fmt::format("{:016x}", hash_);
}

RecordedLine::RecordedLine(SerialLine& line, const std::string& file, const json& head)
    : line_(line) {
    // The flight's description may hold the modem's key: nobody else may read the file.
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

void RecordedLine::put(const json& line) {
    if (!file_)
        return;
    file_ << line.dump() << std::endl;
    if (!file_)
        std::fprintf(stderr, "icesoc-sim: the recording of this flight ends here: %s\n",
                     std::strerror(errno));
}

void RecordedLine::note(uint64_t ns, const char* what, const json& value) {
    write();
    put({{"ns", ns}, {what, value}});
}

void RecordedLine::write() {
    if (!what_)
        return;
    put({{"ns", now_}, {what_, bytes_.empty() ? json(count_) : json(bytes_)}});
    what_ = nullptr;
    bytes_.clear();
    count_ = 0;
}

// Counts a byte of this kind; of another kind, or at another time, it begins a new line.
void RecordedLine::count(const char* what) {
    if (what_ && std::strcmp(what_, what) != 0)
        write();
    what_ = what;
    ++count_;
}

void RecordedLine::advance(uint64_t now) {
    if (now != now_)
        write();
    now_ = now;
    line_.advance(now);
}

void RecordedLine::fromHost(uint8_t byte, uint64_t now) {
    count("up");
    bytes_ += fmt::format("{:02x}", byte);
    client_->fromHost(byte, now);
}

void RecordedLine::framingError(uint64_t now) {
    count("spoilt");
    client_->framingError(now);
}

bool RecordedLine::nextToHost(uint8_t& byte) {
    if (!client_->nextToHost(byte))
        return false;
    count("down");
    return true;
}

ReplayedLine::ReplayedLine(const std::string& file) {
    std::ifstream in(file);
    std::string text;
    if (!std::getline(in, text))
        throw std::runtime_error("cannot read '" + file +
                                 "': is that where a flight was recorded?");
    size_t number = 1;
    try {
        head_ = json::parse(text);
        if (!head_.at("flight").is_object())
            throw std::runtime_error("another version wrote it");
        while (!whole_ && std::getline(in, text) && !in.eof()) { // the last line may be cut short
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
                move.up.push_back(static_cast<uint8_t>(std::stoul(up.substr(i, 2), nullptr, 16)));
            moves_.push_back(move);
        }
    } catch (const std::exception& e) {
        throw std::runtime_error(
            fmt::format("'{}' is no recording of a flight: line {}: {}", file, number, e.what()));
    }
}

void ReplayedLine::advance(uint64_t now) {
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

void ReplayedLine::compare(uint64_t ns, const char* what, const json& value) {
    if (mark_ == marks_.size())
        return;
    const json& mark = marks_[mark_++];
    if (mark.at("ns") != ns || !mark.contains(what) || mark.at(what) != value)
        throw std::runtime_error(fmt::format(
            "this is not the flight that was recorded: it departs between {:.3f} and {:.3f} s. "
            "Chip, firmware, simulator and key must be the same as then",
            static_cast<double>(agreedNs_) / 1e9, static_cast<double>(ns) / 1e9));
    agreedNs_ = ns;
}
