// SPDX-License-Identifier: MIT
//
// xbee: the modem's firmware, as its manual describes it.

#include "xbee.h"
#include "rf_channel.h"
#include <algorithm>
#include <cstddef>
#include <cstdio>

namespace {

constexpr size_t inputBytes = 202, outputBytes = 202;
constexpr size_t ctsOffAt = 17, ctsOnAt = 34; // bytes free
constexpr size_t packetBytes = 100, packetBytesEncrypted = 95;
constexpr size_t keyDigits = 32; // 128 bits
constexpr uint64_t msNs = 1'000'000, resetNs = 200;
constexpr uint64_t plusWindowNs = 1000 * msNs; // the three characters come within a second

struct Limits {
    uint32_t lowest, highest;
};

// Parameters that can be set, and what they take.
const std::map<std::string, Limits> settable = {
    {"MY", {0, 0xFFFF}},  {"DH", {0, 0xFFFFFFFF}}, {"DL", {0, 0xFFFFFFFF}}, {"ID", {0, 0xFFFF}},
    {"CH", {0x0B, 0x1A}}, {"BD", {0, 0x3D090}},    {"RO", {0, 0xFF}},       {"RN", {0, 3}},
    {"MM", {0, 3}},       {"RR", {0, 6}},          {"EE", {0, 1}},          {"GT", {2, 3300}},
    {"CT", {2, 0xFFFF}},  {"CC", {0, 0xFF}},       {"D6", {0, 5}},          {"D7", {0, 5}},
    {"AP", {0, 0}}};

} // namespace

XBee::Parameters XBee::factory() {
    return {{"MY", 0}, {"DH", 0},    {"DL", 0},        {"ID", 0x3332},     {"CH", 0x0C},
            {"BD", 3}, {"RO", 3},    {"RN", 0},        {"MM", 0},          {"RR", 0},
            {"EE", 0}, {"GT", 1000}, {"CT", 100},      {"CC", '+'},        {"D6", 0},
            {"D7", 1}, {"AP", 0},    {"SH", 0x13A200}, {"SL", 0x40000000}, {"DB", 0x28}};
}

XBee::XBee(SerialLine& line, RfChannel& channel, Options options)
    : line_(line), channel_(channel), options_(std::move(options)), written_(factory()) {
    for (auto& [letters, value] : options_.set)
        written_.at(letters) = value;
    active_ = pending_ = written_;
    line_.attach(this);
    channel_.join(this);
    boot(0);
    bootDone_ = 0; // powered long ago
}

XBee::~XBee() {
    channel_.leave(this);
}

double XBee::baud() const {
    static const double rates[] = {1200, 2400, 4800, 9600, 19200, 38400, 57600, 1e6 / 9};
    uint32_t bd = active_.at("BD");
    return bd < 8 ? rates[bd] : bd;
}

uint64_t XBee::charNs() const {
    return static_cast<uint64_t>(10e9 / baud());
}
uint64_t XBee::guardNs() const {
    return active_.at("GT") * msNs;
}

void XBee::boot(uint64_t now) {
    active_ = pending_ = written_;
    mode_ = Mode::Boot;
    bootDone_ = now + options_.bootNs;
    lastByte_ = now;
    pluses_ = 0;
    flushCount_ = 0;
    input_.clear();
    output_.clear();
    commandLine_.clear();
    line_.setBitTime(1e9 / baud());
    cts_ = true;
    line_.setCts(true);
}

void XBee::resetPin(bool low, uint64_t now) {
    if (low == resetLow_)
        return;
    resetLow_ = low;
    if (low)
        resetLowSince_ = now;
    else if (now - resetLowSince_ >= resetNs && mode_ != Mode::Off)
        boot(now);
}

void XBee::power(bool on, uint64_t now) {
    if (!on) {
        mode_ = Mode::Off;
        input_.clear();
        output_.clear();
    } else if (mode_ == Mode::Off) {
        boot(now);
    }
}

void XBee::store(uint8_t byte) {
    if (input_.size() >= inputBytes)
        ++counters_.overflow;
    else
        input_.push_back(byte);
    updateCts();
}

void XBee::updateCts() {
    size_t room = inputBytes - input_.size();
    bool cts = cts_ ? room > ctsOffAt : room >= ctsOnAt;
    if (active_.at("D7") != 1)
        cts = true;
    if (cts != cts_) {
        cts_ = cts;
        line_.setCts(cts);
    }
}

void XBee::fromHost(uint8_t byte, uint64_t now) {
    if (mode_ == Mode::Off || mode_ == Mode::Boot)
        return;
    ++counters_.bytesFromHost;
    if (mode_ == Mode::Command)
        commandByte(byte, now);
    else
        dataByte(byte, now);
    lastByte_ = now;
}

void XBee::framingError(uint64_t now) {
    ++counters_.framingErrors;
    lastByte_ = now;
}

void XBee::dataByte(uint8_t byte, uint64_t now) {
    bool silentBefore = now - lastByte_ >= guardNs();
    if (byte == active_.at("CC") &&
        ((pluses_ == 0 && silentBefore) ||
         (pluses_ > 0 && pluses_ < 3 && now - lastByte_ < plusWindowNs))) {
        ++pluses_;
        return;
    }
    for (; pluses_; --pluses_)
        store(static_cast<uint8_t>(active_.at("CC"))); // they were data
    store(byte);
    sendPackets(now);
}

void XBee::sendPackets(uint64_t now) {
    size_t most = active_.at("EE") ? packetBytesEncrypted : packetBytes;
    if (inFlight_ || input_.empty() || mode_ == Mode::Off)
        return;
    size_t count = 0;
    if (input_.size() >= most)
        count = most;
    else if (active_.at("RO") == 0)
        count = input_.size();
    else if (flushCount_)
        count = std::min(flushCount_, input_.size());
    if (count == 0)
        return;
    RfPacket packet;
    packet.from = static_cast<uint16_t>(active_.at("MY"));
    packet.to = static_cast<uint16_t>(active_.at("DL"));
    packet.pan = static_cast<uint16_t>(active_.at("ID"));
    packet.channel = static_cast<uint8_t>(active_.at("CH"));
    packet.bytes.assign(input_.begin(), input_.begin() + static_cast<std::ptrdiff_t>(count));
    input_.erase(input_.begin(), input_.begin() + static_cast<std::ptrdiff_t>(count));
    flushCount_ -= std::min(flushCount_, count);
    inFlight_ = true;
    ++counters_.packetsSent;
    updateCts();
    channel_.transmit(this, std::move(packet), now);
}

void XBee::transmitted(uint64_t now) {
    inFlight_ = false;
    sendPackets(now);
}

bool XBee::receive(const RfPacket& packet, uint64_t now) {
    if (mode_ == Mode::Off || mode_ == Mode::Boot)
        return false;
    if (output_.size() + packet.bytes.size() > outputBytes) {
        ++counters_.packetsDropped;
        return false;
    }
    ++counters_.packetsReceived;
    output_.insert(output_.end(), packet.bytes.begin(), packet.bytes.end());
    line_.wake(now);
    return true;
}

bool XBee::nextToHost(uint8_t& byte) {
    if (output_.empty())
        return false;
    byte = output_.front();
    output_.pop_front();
    ++counters_.bytesToHost;
    return true;
}

void XBee::reply(const std::string& text) {
    output_.insert(output_.end(), text.begin(), text.end());
}

void XBee::commandByte(uint8_t byte, uint64_t now) {
    if (byte != '\r') {
        if (commandLine_.size() < 64)
            commandLine_ += static_cast<char>(byte);
        return;
    }
    std::string line;
    line.swap(commandLine_);
    ++counters_.commands;
    std::string answer = execute(line, now);
    counters_.refused += answer == "ERROR\r";
    reply(answer);
    line_.wake(now);
}

std::string XBee::setParameter(const std::string& letters, const std::string& value) {
    auto limits = settable.find(letters);
    if (limits == settable.end() || value.size() > 8 ||
        value.find_first_not_of("0123456789ABCDEFabcdef") != std::string::npos)
        return "ERROR\r";
    uint32_t number = static_cast<uint32_t>(std::stoul(value, nullptr, 16));
    if (number < limits->second.lowest || number > limits->second.highest)
        return "ERROR\r";
    pending_[letters] = number;
    return "OK\r";
}

// Write-only: a question is refused.
std::string XBee::setKey(const std::string& value) {
    if (value.empty() || value.size() > keyDigits ||
        value.find_first_not_of("0123456789ABCDEFabcdef") != std::string::npos)
        return "ERROR\r";
    key_ = std::string(keyDigits - value.size(), '0') + value;
    return "OK\r";
}

std::string XBee::execute(const std::string& line, uint64_t now) {
    if (line.size() < 4 || (line[0] != 'A' && line[0] != 'a') || (line[1] != 'T' && line[1] != 't'))
        return "ERROR\r";
    std::string letters = line.substr(2, 2), value = line.substr(4);
    for (char& c : letters)
        c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    if (letters == refuse_)
        return "ERROR\r";
    commandUntil_ = now + active_.at("CT") * 100 * msNs;
    if (letters == "CN") {
        leaveCommandMode();
        return "OK\r";
    }
    if (letters == "AC") {
        apply();
        return "OK\r";
    }
    if (letters == "WR") {
        written_ = pending_;
        return "OK\r";
    }
    if (letters == "RE") {
        pending_ = factory();
        return "OK\r";
    }
    if (letters == "FR") {
        leaveCommandMode();
        mode_ = Mode::Boot;
        bootDone_ = now + options_.bootNs;
        pending_ = active_ = written_;
        return "OK\r";
    }
    if (letters == "KY")
        return setKey(value);
    if (!value.empty())
        return setParameter(letters, value);
    auto parameter = pending_.find(letters);
    if (parameter == pending_.end())
        return "ERROR\r";
    char text[16];
    std::snprintf(text, sizeof text, "%X\r", parameter->second);
    return text;
}

// BD takes effect after the OK has left: the line's bit time changes when it is idle.
void XBee::apply() {
    active_ = pending_;
}

void XBee::leaveCommandMode() {
    apply();
    mode_ = Mode::Data;
    commandLine_.clear();
}

uint64_t XBee::nextEvent() const {
    uint64_t at = line_.nextEvent();
    if (mode_ == Mode::Boot)
        at = std::min(at, bootDone_);
    if (mode_ == Mode::Command)
        at = std::min(at, commandUntil_);
    if (mode_ == Mode::Data && pluses_)
        at = std::min(at, lastByte_ + guardNs());
    if (mode_ == Mode::Data && flushCount_ < input_.size())
        at = std::min(at, lastByte_ + active_.at("RO") * charNs());
    return at;
}

void XBee::advance(uint64_t now) {
    line_.advance(now);
    if (mode_ == Mode::Boot && now >= bootDone_) {
        mode_ = Mode::Data;
        lastByte_ = now;
    }
    if (mode_ == Mode::Command && now >= commandUntil_)
        leaveCommandMode();
    if (mode_ == Mode::Data && pluses_ && now - lastByte_ >= guardNs()) {
        if (pluses_ == 3) {
            mode_ = Mode::Command;
            flushCount_ = input_.size();
            commandUntil_ = now + active_.at("CT") * 100 * msNs;
            reply("OK\r");
            line_.wake(now);
        } else {
            for (unsigned i = 0; i < pluses_; ++i)
                store(static_cast<uint8_t>(active_.at("CC")));
        }
        pluses_ = 0;
        sendPackets(now);
    }
    if (mode_ == Mode::Data && flushCount_ < input_.size() &&
        now - lastByte_ >= active_.at("RO") * charNs()) {
        flushCount_ = input_.size();
        sendPackets(now);
    }
    if (output_.empty())
        line_.setBitTime(1e9 / baud());
}
