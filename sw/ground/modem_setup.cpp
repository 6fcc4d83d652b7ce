// SPDX-License-Identifier: MIT
//
// modem_setup: AT commands, each reply checked.

#include "modem_setup.h"

#include <algorithm>
#include <cstdio>
#include <utility>
#include <vector>

namespace XBeeAT {

namespace {

const int rates[] = {1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200};
constexpr int factoryRate = 9600, replyMs = 500, tries = 3;
constexpr int mostGuard = 3300; // ms, of ATGT

int codeOf(int baud) {
    for (int code = 0; code < 8; ++code)
        if (rates[code] == baud)
            return code;
    return 7;
}

std::string hex(int value) {
    char text[16];
    std::snprintf(text, sizeof text, "%X", static_cast<unsigned>(value));
    return text;
}

bool endsIn(const std::string& text, const std::string& end) {
    return text.size() >= end.size() &&
           text.compare(text.size() - end.size(), end.size(), end) == 0;
}

} // namespace

bool ModemSetup::pause(int ms) {
    stopped_ = wait_(ms, false) < 0;
    return !stopped_;
}

// Returns which of `words` the reply ends in; "": none came in time. Bytes received by radio drain
// out before a reply, and may contain carriage returns.
std::string ModemSetup::readReply(int timeoutMs, std::initializer_list<std::string> words) {
    std::string reply;
    for (int leftUs = timeoutMs * 1000;;) {
        char byte;
        while (serial_.read(&byte, 1) == 1) {
            reply += byte;
            for (const std::string& word : words)
                if (endsIn(reply, word + '\r'))
                    return word;
        }
        if (leftUs <= 0)
            break;
        int passed = wait_((leftUs + 999) / 1000, true);
        stopped_ = passed < 0;
        if (stopped_)
            return "";
        leftUs -= passed;
    }
    silentMs_ = timeoutMs;
    return "";
}

// A wait in vain for an answer is the silence before the next +++ already.
bool ModemSetup::enterCommandMode(int guardMs) {
    int guard = guardMs + guardMs / 8 + 5;
    if (silentMs_ < guard && !pause(guard - silentMs_))
        return false;
    silentMs_ = 0;
    serial_.drop();
    if (serial_.write("+++", 3) != 3)
        return false;
    return readReply(guard + replyMs, {"OK"}) == "OK";
}

std::string ModemSetup::ask(const std::string& text, std::initializer_list<std::string> words) {
    serial_.drop();
    std::string line = "AT" + text + "\r";
    if (serial_.write(line.data(), line.size()) != static_cast<ssize_t>(line.size()))
        return "";
    std::string reply = readReply(replyMs, words);
    // A key is secret: its command is not logged.
    log_(2, "AT" + (text.compare(0, 2, "KY") ? text : text.substr(0, 2)) + ": " + reply);
    return reply;
}

bool ModemSetup::command(const std::string& text) {
    std::string reply;
    for (int attempt = 0; attempt < tries && !stopped_; ++attempt)
        if ((reply = ask(text, {"OK", "ERROR"})) == "OK")
            return true;
    if (!stopped_)
        trouble_ = "the modem on '" + settings_.device + "' " +
                   (reply == "ERROR" ? "refuses AT" : "does not answer to AT") + text.substr(0, 2);
    return false;
}

// Tries the target rate first, where a modem is that this has set up before, then the factory's.
// Then it tries both with a longer guard time, because a modem keeps its ATGT and a simulated one
// may be slower than the clock, then all rates. Times: docs/modem.md.
bool ModemSetup::find() {
    const int guard = settings_.guardMs, longer = std::min(3 * guard, mostGuard);
    std::vector<std::pair<int, int>> candidates = {{settings_.baud, guard},
                                                   {factoryRate, guard},
                                                   {settings_.baud, longer},
                                                   {factoryRate, longer}};
    for (int i = 7; i >= 0; --i)
        if (rates[i] != settings_.baud && rates[i] != factoryRate)
            candidates.emplace_back(rates[i], guard);
    silentMs_ = 0;
    for (auto [baud, guardMs] : candidates) {
        serial_.setSpeed(baud);
        bool found = enterCommandMode(guardMs);
        log_(2, "+++ at " + std::to_string(baud) + " baud: " + (found ? "OK" : "no answer"));
        if (found || stopped_)
            return found;
    }
    trouble_ =
        "no modem answers on '" + settings_.device +
        "': check its power and cable, the guard time (-g), or set XBeeAT.Setup=0 if it must "
        "not be set up";
    return false;
}

bool ModemSetup::run() {
    stopped_ = false;
    const Settings& s = settings_;
    if (!find() || !command("MY" + hex(s.source)) || !command("DH0") ||
        !command("DL" + hex(s.target)) || !command("CH" + hex(s.rfChannel)) ||
        !command("ID" + hex(s.pan)) || !command("RN2") || !command("RO3") ||
        (!s.modemKey.empty() && (!command("EE1") || !command("KY" + s.modemKey))))
        return false;
    encrypts_ = ask("EE", {"0", "1"}) == "1";
    if (!command("BD" + hex(codeOf(s.baud))) || !command("CN"))
        return false;
    serial_.setSpeed(rates[codeOf(s.baud)]);
    return pause(10); // the modem changes its rate after the last OK has left
}

} // namespace XBeeAT
