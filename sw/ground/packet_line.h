// SPDX-License-Identifier: MIT
//
// packet_line: sends and receives packets through the modem on a serial port, in API mode or
// transparent mode. Several senders (peers) share the time on the air.

#pragma once

#include "api_modem.h"
#include "serial_port.h"

#include <functional>
#include <memory>
#include <vector>

extern "C" {
#include "link.h"
}

namespace XBeeAT {

class PacketLine {
public:
    // Interface of a peer that sends packets on this line.
    class Sender {
    public:
        explicit Sender(int address) : address_(address) {}
        virtual ~Sender() = default;
        int address() const { return address_; }
        virtual bool isUp() const = 0;      // returns whether the peer has a session
        virtual U32 randomWait() const = 0; // returns RN for the peer's traffic

        uint64_t airUs = 0; // air time that this sender has used, microseconds

    private:
        const int address_;
    };
    using Deliver = std::function<void(int source, const U8* bytes, size_t size)>;
    using Answer = std::function<void(bool isThere)>;

    explicit PacketLine(SerialPort& serial) : serial_(serial) {}

    // Adds a sender. The new sender starts with the air time of the sender that sent last; starting
    // with 0, it would get all the air time at first.
    void join(Sender& sender) {
        sender.airUs = airUs_;
        senders_.push_back(&sender);
    }
    // Starts the line after the modem has been set up. With `isApi`, the modem reports a result for
    // each packet. `target` is the modem's parameter DL.
    void start(bool isApi, bool escapes, int target) {
        out_.clear();
        target_ = target;
        api_ = isApi ? std::make_unique<ApiModem>(escapes) : nullptr;
    }
    bool isApi() const { return api_ != nullptr; }
    // Returns whether packets of a sender can reach the sender's target. Without API mode, this is
    // true only for the address in DL.
    bool reaches(const Sender& sender, bool hasLink) const {
        return api_ || (sender.address() == target_ && hasLink);
    }

    // Sends a packet if the line is free. Returns whether the packet was accepted.
    bool send(Sender& sender, const U8* frame, U32 size, U32 now);
    // Reads the available bytes. Calls `deliver` for received bytes, and `answer` when the
    // result of a sent packet has arrived. Returns the result of read().
    ssize_t read(const Deliver& deliver, const Answer& answer);
    // Calls `answer(false)` for each packet without a result after LINK_ANSWER_LAST.
    void expire(U32 now, const Answer& answer) {
        if (api_)
            api_->expire(now, [&] { answer(false); });
    }
    // Writes the bytes that the port has not accepted yet.
    void flush();
    bool isFlushed() const { return out_.empty(); }

private:
    SerialPort& serial_;
    std::vector<Sender*> senders_;
    std::unique_ptr<ApiModem> api_; // null in transparent mode
    std::vector<U8> out_;           // bytes of the packet that the port has not accepted yet
    uint64_t airUs_ = 0;            // air time of the sender that sent last, microseconds
    int target_ = 0;
};

} // namespace XBeeAT
