// SPDX-License-Identifier: MIT
//
// xbee_command: the part of XBee that handles command mode.

#include "xbee.h"
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>

namespace {

constexpr size_t keyDigits = 32; // 128 bits
constexpr uint64_t msNs = 1'000'000;

bool isHex(const std::string& text, size_t most) {
    return !text.empty() && text.size() <= most &&
           text.find_first_not_of("0123456789ABCDEFabcdef") == std::string::npos;
}

} // namespace

// Enters command mode. The OK follows after all received data has been sent to the host.
void XBee::enterCommandMode(uint64_t now) {
    mode_ = Mode::Command;
    flushCount_ = input_.size();
    commandUntil_ = now + active_.at("CT") * 100 * msNs;
    reply("OK\r");
    line_.wake(now);
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
    counters_.refused += answer.find("ERROR") != std::string::npos;
    reply(answer);
    line_.wake(now);
}

bool XBee::setParameter(const std::string& letters, uint32_t value) {
    auto found = table_.find(letters);
    if (found == table_.end() || !found->second.writable || value < found->second.lowest ||
        value > found->second.highest)
        return false;
    if (letters == "BD" && value > profile_.highestCode && value < profile_.lowestRate)
        return false;
    if (letters == "BD" && value > profile_.highestCode)
        value =
            // the modem stores the nearest rate that it can generate
            static_cast<uint32_t>(std::lround(xbeeBaud(profile_, value)));
    pending_[letters] = value;
    if (letters == "EC" || letters == "EA")
        active_[letters] = value;
    return true;
}

// Sets the key. A key can be set but not read, so a query returns an error.
bool XBee::setKey(const std::string& value) {
    if (!isHex(value, keyDigits))
        return false;
    key_ = std::string(keyDigits - value.size(), '0') + value;
    return true;
}

// Executes a command that has no value. Returns "" if it is unknown.
std::string XBee::order(const std::string& letters, uint64_t now) {
    if (letters == "CN") {
        leaveCommandMode();
    } else if (letters == "AC") {
        apply();
    } else if (letters == "WR") {
        written_ = pending_;
        writtenKey_ = key_;
    } else if (letters == "RE") {
        pending_ = factory();
        for (auto& [own, value] : options_.set)
            if (!table_.at(own).writable)
                pending_[own] = value; // RE does not change the serial number
        key_.clear();
    } else if (letters == "FR") {
        boot(now); // the OK is sent at the old rate, before the boot
    } else {
        return "";
    }
    return "OK\r";
}

// Executes one line. A line with several commands, such as ATDL2,WR,CN, gets a reply for each. The
// line AT without a command gets OK.
std::string XBee::execute(const std::string& line, uint64_t now) {
    if (line.size() < 2 || std::toupper(static_cast<unsigned char>(line[0])) != 'A' ||
        std::toupper(static_cast<unsigned char>(line[1])) != 'T')
        return "ERROR\r";
    if (line.size() == 2)
        return "OK\r";
    std::string answers;
    for (size_t at = 2, end = 0; end != std::string::npos; at = end + 1) {
        end = line.find(',', at);
        answers += executeOne(line.substr(at, end - at), now);
    }
    return answers;
}

std::string XBee::executeOne(const std::string& command, uint64_t now) {
    if (command.size() < 2)
        return "ERROR\r";
    std::string letters = command.substr(0, 2), value = command.substr(2);
    value.erase(0, value.find_first_not_of(' '));
    if (value.size() > 2 && value[0] == '0' && (value[1] == 'x' || value[1] == 'X'))
        value.erase(0, 2);
    for (char& c : letters)
        c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    // refuse_ contains a command, or a command and one value
    if (letters == refuse_ || letters + value == refuse_)
        return "ERROR\r";
    std::string answer = value.empty() ? order(letters, now) : "";
    if (answer.empty() && letters == "KY")
        answer = setKey(value) ? "OK\r" : "ERROR\r";
    if (answer.empty() && !value.empty())
        answer =
            isHex(value, 8) &&
                    setParameter(letters, static_cast<uint32_t>(std::stoul(value, nullptr, 16)))
                ? "OK\r"
                : "ERROR\r";
    if (answer.empty()) {
        auto parameter = pending_.find(letters);
        char text[16] = "ERROR\r";
        if (parameter != pending_.end())
            std::snprintf(text, sizeof text, "%X\r", parameter->second);
        answer = text;
    }
    if (answer != "ERROR\r")
        commandUntil_ = std::max(commandUntil_, now + active_.at("CT") * 100 * msNs);
    return answer;
}

// Applies the changed settings. A new baud rate (BD) takes effect after the OK has been sent
// (XBee::advance).
void XBee::apply() {
    active_ = pending_;
    line_.setHeedRts(active_.at("D6") == 1);
    updateCts();
}

void XBee::leaveCommandMode() {
    apply();
    mode_ = Mode::Data;
    commandLine_.clear();
}
