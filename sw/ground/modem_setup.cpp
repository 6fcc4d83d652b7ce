// SPDX-License-Identifier: MIT
//
// modem_setup: the engine's first task: find the modem's baud rate and set it up by AT commands.

#include "engine.h"

#include <algorithm>
#include <asm/termbits.h> // struct termios2: any rate, 111,111 too
#include <cerrno>
#include <cstdio>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

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

} // namespace

void Engine::setSpeed(int baud) {
    termios2 t{};
    if (ioctl(serial_, TCGETS2, &t) != 0)
        return; // no terminal: bytes go through as they are
    t.c_iflag = 0;
    t.c_oflag = 0;
    t.c_lflag = 0;
    t.c_cflag = CS8 | CREAD | CLOCAL | BOTHER | BOTHER << IBSHIFT;
    t.c_ospeed = t.c_ispeed = static_cast<speed_t>(baud == 115200 ? 111111 : baud);
    t.c_cc[VMIN] = 0;
    t.c_cc[VTIME] = 0;
    ioctl(serial_, TCSETS2, &t);
}

bool Engine::waitMs(int ms) {
    // A port that is gone ends the wait, too: where its simulator has ended, time stands still.
    pollfd fds[] = {{wakePipe_[0], POLLIN, 0}, {serial_, 0, 0}};
    const U32 begin = clock_.nowUs(), us = static_cast<U32>(ms) * 1000;
    for (;;) {
        {
            std::lock_guard<std::mutex> lock(mutex_);
            if (stop_)
                return false;
        }
        U32 passed = clock_.nowUs() - begin;
        if (passed >= us)
            return true;
        char bytes[64];
        if (clock_.wait(fds, 2, us - passed) > 0 && fds[0].revents)
            (void)!read(wakePipe_[0], bytes, sizeof bytes);
        if (fds[1].revents)
            return false;
    }
}

// Up to the carriage return; what came by then if it does not come.
std::string Engine::readReply(int timeoutMs) {
    std::string reply;
    for (int waited = 0; waited <= timeoutMs; waited += 5) {
        char byte;
        while (read(serial_, &byte, 1) == 1) {
            if (byte == '\r')
                return reply;
            reply += byte;
        }
        if (!waitMs(5))
            return reply;
    }
    return reply;
}

bool Engine::enterCommandMode(int guardMs) {
    int guard = guardMs + guardMs / 8 + 5;
    if (!waitMs(guard))
        return false;
    ioctl(serial_, TCFLSH, TCIFLUSH);
    if (write(serial_, "+++", 3) != 3)
        return false;
    std::string reply = readReply(guard + replyMs);
    return reply.size() >= 2 && reply.compare(reply.size() - 2, 2, "OK") == 0;
}

bool Engine::command(const std::string& text) {
    std::string line = "AT" + text + "\r";
    for (int attempt = 0; attempt < tries; ++attempt) {
        if (write(serial_, line.data(), line.size()) != static_cast<ssize_t>(line.size()))
            return false;
        std::string reply = readReply(replyMs);
        // A key is a secret.
        log_(2, "AT" + (text.compare(0, 2, "KY") ? text : text.substr(0, 2)) + ": " + reply);
        if (reply == "OK")
            return true;
    }
    log_(0, "the modem on '" + settings_.device + "' refuses AT" + text.substr(0, 2));
    return false;
}

// At the target rate and the factory's first; then there with a longer guard time, because a modem
// keeps what it was once told (ATGT), and a simulated one may be slower than the clock; then at all
// rates.
bool Engine::findModem() {
    const int guard = settings_.guardMs, longer = std::min(3 * guard, mostGuard);
    std::vector<std::pair<int, int>> candidates = {{settings_.baud, guard},
                                                   {factoryRate, guard},
                                                   {settings_.baud, longer},
                                                   {factoryRate, longer}};
    for (int i = 7; i >= 0; --i)
        if (rates[i] != settings_.baud && rates[i] != factoryRate)
            candidates.emplace_back(rates[i], guard);
    for (auto [baud, guardMs] : candidates) {
        setSpeed(baud);
        bool found = enterCommandMode(guardMs);
        log_(2, "+++ at " + std::to_string(baud) + " baud: " + (found ? "OK" : "no answer"));
        if (found)
            return true;
        std::lock_guard<std::mutex> lock(mutex_);
        if (stop_)
            return false;
    }
    return false;
}

bool Engine::setUpModem() {
    if (!findModem() || !command("MY" + hex(settings_.source)) || !command("DH0") ||
        !command("DL" + hex(settings_.target)) || !command("CH" + hex(settings_.rfChannel)) ||
        !command("ID" + hex(settings_.pan)) || !command("RO3") ||
        (!settings_.key.empty() && (!command("EE1") || !command("KY" + settings_.key))) ||
        !command("BD" + hex(codeOf(settings_.baud))) || !command("CN"))
        return false;
    setSpeed(rates[codeOf(settings_.baud)]);
    return waitMs(10); // the modem changes its rate after the last OK has left
}

} // namespace XBeeAT
