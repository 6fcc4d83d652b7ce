// SPDX-License-Identifier: MIT
//
// modem_setup: sets up the modem by AT commands, and checks each reply.

#include "modem_setup.h"
#include "api_modem.h"

#include <algorithm>
#include <cstdio>
#include <utility>
#include <vector>

namespace XBeeAT {

namespace {

const int rates[] = {1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200};
constexpr int factoryRate = 9600, fastestRate = 250000, replyMs = 500, tries = 3;
// time-out for a reply in API mode, ms; the transmission time on the line is added
constexpr int apiReplyMs = 100;
constexpr int mostGuard = 3300; // largest guard time of a modem (ATGT), ms

// Returns the value of the parameter BD for a baud rate: a code for standard rates, otherwise the
// rate itself.
int codeOf(int baud) {
    for (int code = 0; code < 8; ++code)
        if (rates[code] == baud)
            return code;
    return baud;
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

// Waits for a reply that ends with one of `words`, and returns this word; returns "" after a
// time-out. Bytes received by radio may precede the reply, and may contain carriage returns.
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

// Sends +++ after the guard time, and returns whether the modem answers OK. If the modem does not
// answer, the time spent waiting counts as silence before the next +++.
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
    if (isApi_)
        return askApi(text.substr(0, 2), text.substr(2), replyMs);
    serial_.drop();
    std::string line = "AT" + text + "\r";
    if (serial_.write(line.data(), line.size()) != static_cast<ssize_t>(line.size()))
        return "";
    std::string reply = readReply(replyMs, words);
    // The modem's key is secret, so the log contains the command KY without its value.
    log_(2, "AT" + (text.compare(0, 2, "KY") ? text : text.substr(0, 2)) + ": " + reply);
    return reply;
}

// Sets a parameter of a modem in API mode; without a value, reads the parameter. Returns OK, ERROR
// or the value in hexadecimal; "" if no reply arrives in time. With `endsLine`, a carriage return
// is sent after the frame. A modem in API mode ignores the carriage return. A modem in command mode
// takes the frame for a command line and rejects this command; the function then returns "COMMAND".
std::string ModemSetup::askApi(const std::string& letters, const std::string& value, int timeoutMs,
                               bool endsLine) {
    constexpr uint8_t id = 0xA5;
    ApiFrames frames(escapes_);
    const std::string digits = (value.size() % 2 ? "0" : "") + value;
    ApiFrames::Bytes bytes;
    for (size_t i = 0; i < digits.size(); i += 2)
        bytes.push_back(static_cast<uint8_t>(std::stoi(digits.substr(i, 2), nullptr, 16)));
    serial_.drop();
    auto request = frames.command(id, letters, bytes);
    if (endsLine)
        request.push_back('\r');
    if (serial_.write(request.data(), request.size()) != static_cast<ssize_t>(request.size()))
        return "";
    std::string reply, text;
    for (int leftUs = timeoutMs * 1000; reply.empty();) {
        uint8_t byte;
        while (reply.empty() && serial_.read(&byte, 1) == 1) {
            text += static_cast<char>(byte);
            if (endsLine && text == "ERROR\r")
                reply = "COMMAND";
            frames.feed(
                &byte, 1, [](int, const uint8_t*, size_t) {},
                [&](const ApiFrames::Bytes& answer) {
                    if (answer.size() < 5 || answer[0] != ApiFrames::Answer || answer[1] != id ||
                        letters != std::string{char(answer[2]), char(answer[3])})
                        return;
                    reply = answer[4] ? "ERROR" : answer.size() == 5 ? "OK" : "";
                    for (size_t i = 5; i < answer.size() && !answer[4]; ++i)
                        reply += hex(answer[i]);
                });
        }
        if (!reply.empty() || leftUs <= 0)
            break;
        const int passed = wait_((leftUs + 999) / 1000, true);
        stopped_ = passed < 0;
        if (stopped_)
            return "";
        leftUs -= passed;
    }
    log_(2, "AT" + letters + (letters == "KY" ? "" : value) + ", API: " + reply);
    return reply;
}

bool ModemSetup::command(const std::string& text) {
    for (int attempt = 0; attempt < tries && !stopped_; ++attempt)
        if ((reply_ = ask(text, {"OK", "ERROR"})) == "OK")
            return true;
    if (!stopped_)
        trouble_ = "the modem on '" + settings_.device + "' " +
                   (reply_ == "ERROR" ? "refuses AT" : "does not answer AT") + text.substr(0, 2);
    return false;
}

// Returns whether a modem answers at this rate without +++. This is the case if the modem is in API
// mode, or if it is still in command mode because a program was killed during the set-up. The
// question contains no byte that AP 2 would escape.
bool ModemSetup::findWithoutGuard(int baud) {
    serial_.setSpeed(rate_ = baud);
    const int ms = apiReplyMs + 190000 / baud;
    const std::string reply = askApi("AP", "", ms, true);
    silentMs_ = reply.empty() ? ms : 0;
    isApi_ = reply == "1" || reply == "2";
    escapes_ = reply == "2";
    return isApi_ || reply == "COMMAND";
}

// Searches for the modem. First tries the rate in the settings, because a modem that was set up
// before has this rate, and then the factory's rate. Then tries both rates with a longer guard
// time: a modem may have kept a longer ATGT, and a simulated modem may run slower than the clock.
// Finally tries all rates. Times: docs/modem.md.
bool ModemSetup::find() {
    const int guard = settings_.guardMs, longer = std::min(3 * guard, mostGuard);
    std::vector<std::pair<int, int>> candidates = {{settings_.baud, guard},
                                                   {factoryRate, guard},
                                                   {settings_.baud, longer},
                                                   {factoryRate, longer}};
    for (int i = 7; i >= 0; --i)
        if (rates[i] != settings_.baud && rates[i] != factoryRate)
            candidates.emplace_back(rates[i], guard);
    // A modem in API mode or in command mode ignores +++, so such a modem is tried first. The time
    // spent waiting for its answer counts as silence before the +++ that follows.
    for (int baud : {settings_.baud, factoryRate})
        if (findWithoutGuard(baud) || stopped_)
            return !stopped_;
    for (auto [baud, guardMs] : candidates) {
        serial_.setSpeed(rate_ = baud);
        bool found = enterCommandMode(guardMs);
        log_(2, "+++ at " + std::to_string(baud) + " baud: " + (found ? "OK" : "no answer"));
        if (found || stopped_)
            return found;
    }
    for (int baud : {fastestRate, rates[7], rates[6], rates[5], rates[4], factoryRate, rates[2],
                     rates[1], rates[0]})
        if (findWithoutGuard(baud) || stopped_)
            return !stopped_;
    trouble_ = "no modem answers on '" + settings_.device +
               "': check its power, its cable and the guard time (-g); set XBeeAT.Setup=0 if the "
               "modem must not be configured";
    return false;
}

bool ModemSetup::run() {
    stopped_ = isApi_ = escapes_ = false;
    const Settings& s = settings_;
    if (!find() || !command("MY" + hex(s.source)) || !command("DH0") ||
        !command("DL" + hex(s.target)) || !command("CH" + hex(s.rfChannel)) ||
        !command("ID" + hex(s.pan)) || !command("RN2") || !command("RO3") ||
        (!s.modemKey.empty() && (!command("EE1") || !command("KY" + s.modemKey))))
        return false;
    encrypts_ = ask("EE", {"0", "1"}) == "1";
    return isApi_ ? finishApi() : finish();
}

// Leaves command mode. Switches to API mode if the settings request this mode and the modem
// supports it.
bool ModemSetup::finish() {
    const bool api = settings_.isApi && ask("AP1", {"OK", "ERROR"}) == "OK";
    if (!command("BD" + hex(codeOf(settings_.baud))) || !command("CN"))
        return false;
    serial_.setSpeed(rate_ = settings_.baud);
    isApi_ = api;
    return pause(10); // the modem changes its rate after it has sent the last OK
}

// Sets rate and mode of a modem that was found in API mode. If the settings request API mode,
// leaves AP unchanged, which may be 1 or 2. A modem that rejects transparent mode stays in API
// mode; this is not a failure. Each setting takes effect at once, so the reply may arrive at the
// old or the new rate.
bool ModemSetup::finishApi() {
    const int found = rate_;
    for (int attempt = 0; attempt < tries && rate_ != settings_.baud; ++attempt) {
        (void)askApi("BD", hex(codeOf(settings_.baud)), apiReplyMs);
        if (stopped_ || !pause(10) ||
            (!findWithoutGuard(settings_.baud) && !findWithoutGuard(found) && stopped_))
            return false;
    }
    if (!isApi_ || rate_ != settings_.baud) {
        trouble_ = "the modem on '" + settings_.device + "' does not answer at " +
                   std::to_string(settings_.baud) + " baud";
        return false;
    }
    if (settings_.isApi)
        return true;
    if (command("AP0"))
        isApi_ = escapes_ = false;
    else if (reply_ == "ERROR")
        log_(0, trouble_ + "0 and stays in API mode; this does not affect the vehicle");
    return !isApi_ || reply_ == "ERROR";
}

} // namespace XBeeAT
