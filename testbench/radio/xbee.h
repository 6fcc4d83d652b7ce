// SPDX-License-Identifier: MIT
//
// xbee: models an XBee modem with 802.15.4 firmware (xbee_profile.h): command mode, packetizing,
// buffers, flow control, API frames, encryption, reset. Facts and limits: docs/modem.md.
//
// Times are in nanoseconds. advance(now) handles the events that are due; nextEvent() returns the
// time of the next event. The serial side is a SerialLine (pins or a pty), the radio side is an
// RfChannel.

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
        // parameters that differ from the factory settings: name and value
        std::map<std::string, uint32_t> set;
        std::string key; // encryption key (KY), 32 hexadecimal digits
    };
    struct Counters {
        uint64_t bytesFromHost = 0, bytesToHost = 0;
        uint64_t overflow = 0; // bytes lost because the serial input buffer was full
        // number of bytes with a wrong stop bit, or with a baud rate too different from the modem's
        // baud rate
        uint64_t framingErrors = 0;
        uint64_t commands = 0, refused = 0;
        uint64_t packetsSent = 0, packetsReceived = 0;
        // number of packets that were acknowledged and then lost because the buffer to the host was
        // full
        uint64_t packetsDropped = 0;
        // number of packets that were encrypted although EE is 0 at this modem, or unencrypted
        // although EE is 1
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

    // Sets the level of the reset pin. A low level of at least 200 ns resets the modem.
    void resetPin(bool low, uint64_t now);
    // Switches the power. Settings that were not stored by WR are lost.
    void power(bool on, uint64_t now);
    // Makes the modem reply ERROR to this command, as if its firmware lacked the command; "" ends
    // this.
    void refuseCommand(const std::string& letters) { refuse_ = letters; }

    const std::string& name() const { return options_.name; }
    uint32_t parameter(const std::string& letters) const { return active_.at(letters); }
    const XBeeProfile& profile() const { return profile_; }
    double baud() const;
    // Returns the key, 32 hexadecimal digits; "" if no key was set.
    const std::string& key() const { return key_; }
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
    // number of characters received so far of the sequence that enters command mode
    unsigned pluses_ = 0;
    uint64_t firstPlus_ = 0;
    std::string commandLine_;
    std::deque<uint8_t> input_; // bytes from the host that have not been sent on the air yet
    // number of bytes in input_ that must be sent without waiting for more bytes
    size_t flushCount_ = 0;
    std::deque<uint8_t> output_; // bytes that wait to be sent to the host
    double nextBaud_ = 0;        // baud rate after the change, see atOldRate_
    // number of bytes that must still be sent to the host at the old rate; the last of them belong
    // to the OK for the command that changed the rate
    size_t atOldRate_ = 0;
    bool inFlight_ = false, cts_ = true;
    Mac mac_;
    uint64_t busyUntil_ = 0;
    uint16_t sequence_ = 0;
    uint32_t frameCounter_ = 0; // number of encrypted packets since power-on
    // sequence number of the last packet from each sender
    std::map<uint16_t, uint16_t> lastSequence_;
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
    uint8_t apiId_ = 0; // frame id of the API frame that is being sent
    Counters counters_;
};
