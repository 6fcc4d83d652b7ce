// SPDX-License-Identifier: MIT
//
// xbee: model of an XBee modem with 802.15.4 firmware (xbee_profile.h): command mode, packetizing,
// buffers, flow control, API frames, encryption, reset. Facts and limits: docs/modem.md.
//
// Time is in nanoseconds. advance(now) handles due events; nextEvent() returns the next time. The
// serial side is a SerialLine (pins or a pty), the radio side an RfChannel.

#pragma once

#include "mac.h"
#include "rf_packet.h"
#include "serial_line.h"
#include "xbee_parameters.h"
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <vector>

class XBee : public Mac::Modem, private SerialClient {
public:
    struct Options {
        std::string name = "xbee";
        std::string profile = "s1"; // modem: s1, s2c or xb3
        // duration of the boot, 50 to 500 ms depending on the modem's firmware
        uint64_t bootNs = 50'000'000;
        // parameters that differ from the factory settings, with their values
        std::map<std::string, uint32_t> set;
        std::string key; // KY, 32 hexadecimal digits
    };
    struct Counters {
        uint64_t bytesFromHost = 0, bytesToHost = 0;
        uint64_t overflow = 0; // bytes lost because the serial input buffer was full
        // number of bytes with a wrong stop bit, or at a baud rate too far from the modem's
        uint64_t framingErrors = 0;
        uint64_t commands = 0, refused = 0;
        uint64_t packetsSent = 0, packetsReceived = 0;
        // number of packets that were acknowledged and then lost, because the buffer to the host
        // was full
        uint64_t packetsDropped = 0;
        // number of packets that were encrypted while EE was 0 at this modem, or the reverse
        uint64_t packetsUnreadable = 0;
        // number of duplicates; number of API frames with a wrong checksum or type
        uint64_t duplicatesDropped = 0, badFrames = 0;
    };

    XBee(SerialLine& line, RfChannel& channel, Options options);
    ~XBee() override;
    XBee(const XBee&) = delete;
    XBee& operator=(const XBee&) = delete;

    void advance(uint64_t now);
    uint64_t nextEvent() const;

    // Sets the reset pin. `low` for at least 200 ns resets the modem.
    void resetPin(bool low, uint64_t now);
    // Switches the power. Settings that were not stored by WR are lost.
    void power(bool on, uint64_t now);
    // Makes the modem reply ERROR to this command, like a firmware without the command; "" disables
    // this.
    void refuseCommand(const std::string& letters) { refuse_ = letters; }

    const std::string& name() const { return options_.name; }
    uint32_t parameter(const std::string& letters) const { return active_.at(letters); }
    const XBeeProfile& profile() const { return profile_; }
    double baud() const;
    const std::string& key() const { return key_; } // 32 hex digits; "" if no key was set
    bool inCommandMode() const { return mode_ == Mode::Command; }
    bool cts() const { return cts_; }
    const Counters& counters() const { return counters_; }

    // ---- functions that the air and the MAC call ----
    bool hears(const RfPacket& packet) const override;
    Reception receive(const RfPacket& packet, uint64_t now) override;
    uint64_t busyUntil() const override { return busyUntil_; }
    void transmitted(uint64_t now, Mac::Fate fate) override;

private:
    enum class Mode { Off, Boot, Data, Command };
    using Parameters = std::map<std::string, uint32_t>;
    using Bytes = std::vector<uint8_t>;

    void fromHost(uint8_t byte, uint64_t now) override;
    void framingError(uint64_t now) override;
    bool nextToHost(uint8_t& byte) override;

    Parameters factory() const;
    size_t packetBytes() const;
    void boot(uint64_t now);
    void stopSending();
    void store(uint8_t byte);
    void dataByte(uint8_t byte, uint64_t now);
    void silence(uint64_t now);
    void sendPackets(uint64_t now);
    void launch(RfPacket packet, uint64_t now);
    void work(uint64_t now, bool encrypted);
    RfPacket addressed() const;
    void setRounds(RfPacket& packet) const;
    uint64_t serial() const;
    void updateCts();
    uint64_t charNs() const;
    uint64_t guardNs() const;

    // xbee_command.cpp
    void enterCommandMode(uint64_t now);
    void commandByte(uint8_t byte, uint64_t now);
    std::string execute(const std::string& line, uint64_t now);
    std::string executeOne(const std::string& command, uint64_t now);
    std::string order(const std::string& letters, uint64_t now);
    bool setParameter(const std::string& letters, uint32_t value);
    bool setKey(const std::string& value);
    void apply();
    void leaveCommandMode();
    void reply(const std::string& text);

    // xbee_api.cpp
    void apiByte(uint8_t byte, uint64_t now);
    void apiFrame(const Bytes& frame, uint64_t now);
    void apiCommand(const Bytes& frame, uint64_t now);
    void apiSend(const Bytes& frame, uint64_t now);
    void apiReply(const Bytes& frame);
    void apiReceived(const RfPacket& packet);
    void sendApiPacket(uint64_t now);

    SerialLine& line_;
    RfChannel& channel_;
    Options options_;
    const XBeeProfile& profile_;
    const std::map<std::string, XBeeParameter> table_; // limits of the parameters
    // parameters saved by WR; parameters set by commands but not applied yet; parameters in effect
    Parameters written_, pending_, active_;
    Mode mode_ = Mode::Off;
    uint64_t bootDone_ = 0, lastByte_ = 0, commandUntil_ = 0, resetLowSince_ = 0;
    bool resetLow_ = false;
    unsigned pluses_ = 0; // number of characters so far of a sequence that may enter command mode
    uint64_t firstPlus_ = 0;
    std::string commandLine_;
    std::deque<uint8_t> input_;  // bytes from the host that are not sent yet
    size_t flushCount_ = 0;      // number of bytes in input_ that must be sent now
    std::deque<uint8_t> output_; // bytes to the host
    double nextBaud_ = 0; // baud rate that the line takes after the bytes counted by atOldRate_
    // number of bytes that are still sent at the old rate; the last of them belongs to the OK of
    // the command
    size_t atOldRate_ = 0;
    bool inFlight_ = false, cts_ = true;
    Mac mac_;
    uint64_t busyUntil_ = 0;
    uint16_t sequence_ = 0;
    uint32_t frameCounter_ = 0;                 // number of encrypted packets since power-on
    std::map<uint16_t, uint16_t> lastSequence_; // last sequence number of each sender
    std::string refuse_;
    std::string key_, writtenKey_;
    // API
    struct ApiPacket {
        uint8_t id;
        RfPacket packet;
    };
    Bytes frame_;
    bool inFrame_ = false, escaped_ = false;
    std::deque<ApiPacket> apiQueue_;
    uint8_t apiId_ = 0; // frame id of the API packet in flight
    Counters counters_;
};
