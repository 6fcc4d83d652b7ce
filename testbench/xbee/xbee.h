// SPDX-License-Identifier: MIT
//
// xbee: model of an XBee 802.15.4 (series 1) modem in transparent mode: command mode, packetizing,
// buffers, flow control, reset. Facts and what is left out: docs/modem.md.
//
// Time is in nanoseconds. advance(now) does what is due; nextEvent() says when that will be. The
// serial side is a SerialLine (pins or a pty), the radio side an RfChannel.

#ifndef XBEE_H
#define XBEE_H

#include "serial_line.h"
#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <vector>

class RfChannel;

struct RfPacket {
    uint16_t from = 0, to = 0, pan = 0;
    uint8_t channel = 0;
    std::vector<uint8_t> bytes;
};

class XBee : private SerialClient {
public:
    struct Options {
        std::string name = "xbee";
        uint64_t bootNs = 50'000'000;        // 50..500 ms by firmware
        std::map<std::string, uint32_t> set; // parameters that differ from the factory's
    };
    struct Counters {
        uint64_t bytesFromHost = 0, bytesToHost = 0;
        uint64_t overflow = 0;      // bytes lost: the serial input buffer was full
        uint64_t framingErrors = 0; // wrong stop bit, or the host's baud rate is too far off
        uint64_t commands = 0, refused = 0;
        uint64_t packetsSent = 0, packetsReceived = 0, packetsDropped = 0;
    };

    XBee(SerialLine& line, RfChannel& channel, Options options);
    ~XBee();
    XBee(const XBee&) = delete;
    XBee& operator=(const XBee&) = delete;

    void advance(uint64_t now);
    uint64_t nextEvent() const;

    // The reset pin: `low` for at least 200 ns resets.
    void resetPin(bool low, uint64_t now);
    // Power off and on: settings that were not written by WR are lost.
    void power(bool on, uint64_t now);
    // Answers ERROR to this command, as a firmware that lacks it does ("" for none).
    void refuseCommand(const std::string& letters) { refuse_ = letters; }

    const std::string& name() const { return options_.name; }
    uint32_t parameter(const std::string& letters) const { return active_.at(letters); }
    double baud() const;
    const std::string& key() const { return key_; } // 32 hex digits, "" if none was set
    bool inCommandMode() const { return mode_ == Mode::Command; }
    const Counters& counters() const { return counters_; }

    // From the channel. False: no room in the buffer to the host; the sender tries again.
    bool receive(const RfPacket& packet, uint64_t now);
    void transmitted(uint64_t now); // the packet in flight has left, or was given up

private:
    enum class Mode { Off, Boot, Data, Command };
    using Parameters = std::map<std::string, uint32_t>;

    void fromHost(uint8_t byte, uint64_t now) override;
    void framingError(uint64_t now) override;
    bool nextToHost(uint8_t& byte) override;

    static Parameters factory();
    void boot(uint64_t now);
    void store(uint8_t byte);
    void dataByte(uint8_t byte, uint64_t now);
    void commandByte(uint8_t byte, uint64_t now);
    std::string execute(const std::string& line, uint64_t now);
    std::string setParameter(const std::string& letters, const std::string& value);
    std::string setKey(const std::string& value);
    void apply();
    void leaveCommandMode();
    void sendPackets(uint64_t now);
    void updateCts();
    void reply(const std::string& text);
    uint64_t charNs() const;
    uint64_t guardNs() const;

    SerialLine& line_;
    RfChannel& channel_;
    Options options_;
    Parameters written_, pending_, active_; // by WR; by commands; in force
    Mode mode_ = Mode::Off;
    uint64_t bootDone_ = 0, lastByte_ = 0, commandUntil_ = 0, resetLowSince_ = 0;
    bool resetLow_ = false;
    unsigned pluses_ = 0; // of a sequence that may lead to command mode
    std::string commandLine_;
    std::deque<uint8_t> input_;  // from the host, to be sent
    size_t flushCount_ = 0;      // bytes of it that must leave now
    std::deque<uint8_t> output_; // to the host
    bool inFlight_ = false, cts_ = true;
    std::string refuse_, key_;
    Counters counters_;
};

#endif
