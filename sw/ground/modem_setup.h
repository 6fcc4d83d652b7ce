// SPDX-License-Identifier: MIT
//
// modem_setup: finds the baud rate of the modem on a serial port, and configures the modem by AT
// commands.

#pragma once

#include "serial_port.h"
#include "settings.h"
#include <initializer_list>

namespace XBeeAT {

class ModemSetup {
public:
    // Waits for `ms`; with `forBytes`, returns earlier if the port has bytes to read. Returns the
    // elapsed time in us. A negative result aborts the set-up.
    using Wait = std::function<int(int ms, bool forBytes)>;

    ModemSetup(SerialPort& serial, const Settings& settings, const Log& log, Wait wait)
        : serial_(serial), settings_(settings), log_(log), wait_(std::move(wait)) {}

    // Configures the modem. Returns false on failure; trouble() then returns the reason, which is
    // empty if `wait` has aborted the set-up. Takes about two guard times if the modem has the
    // rate of the settings, and one more guard time for each wrong rate that is tried.
    bool run();
    // Results of run(). encrypts: the modem encrypts packets (EE is on). isApi: the modem uses API
    // frames (AP is not 0). escapes: bytes in these frames are escaped (AP is 2).
    bool encrypts() const { return encrypts_; }
    bool isApi() const { return isApi_; }
    bool escapes() const { return escapes_; }
    const std::string& trouble() const { return trouble_; }

private:
    bool find();
    bool findWithoutGuard(int baud);
    bool enterCommandMode(int guardMs);
    bool pause(int ms);
    bool command(const std::string& text);
    std::string ask(const std::string& text, std::initializer_list<std::string> words);
    std::string askApi(const std::string& letters, const std::string& value, int timeoutMs,
                       bool endsLine = false);
    bool finish();
    bool finishApi();
    std::string readReply(int timeoutMs, std::initializer_list<std::string> words);

    SerialPort& serial_;
    const Settings& settings_;
    const Log& log_;
    Wait wait_;
    std::string trouble_, reply_; // reply to the last command
    bool stopped_ = false, encrypts_ = false, isApi_ = false, escapes_ = false;
    int rate_ = 0;     // baud rate of the port
    int silentMs_ = 0; // time since the last byte was sent, ms
};

} // namespace XBeeAT
