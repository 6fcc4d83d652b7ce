// SPDX-License-Identifier: MIT
//
// serial_line: serial lines between a modem and its host: UART pins of a design, a pty for a
// program, or C++ in the same process.

#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <vector>

constexpr uint64_t never = ~uint64_t(0);

// The modem as the client of a line: it accepts and returns bytes.
class SerialClient {
public:
    virtual void fromHost(uint8_t byte, uint64_t now) = 0;
    virtual void framingError(uint64_t now) = 0;
    // Sets `byte` to the modem's next byte for the host. Returns false if there is none.
    virtual bool nextToHost(uint8_t& byte) = 0;

protected:
    ~SerialClient() = default;
};

class SerialLine {
public:
    virtual ~SerialLine() = default;
    void attach(SerialClient* client) { client_ = client; }
    // Sets the bit time in ns. It takes effect when no byte is on the line.
    virtual void setBitTime(double ns) { bitNs_ = ns; }
    virtual void setCts(bool accepts) { cts_ = accepts; }
    // Sets whether the host's RTS can stop the modem (D6). A line without RTS ignores this.
    void setHeedRts(bool heeds) { heedsRts_ = heeds; }
    virtual void advance(uint64_t now) = 0;
    virtual uint64_t nextEvent() const = 0;
    // Reports that the modem has bytes to send, which nextToHost returns.
    virtual void wake(uint64_t now) = 0;

protected:
    SerialClient* client_ = nullptr;
    double bitNs_ = 1e9 / 9600;
    bool cts_ = true, heedsRts_ = false;
};

// Serial pins of a design. setTxd reports each change of the design's TXD; RXD and CTS are outputs
// of this class.
class UartPins : public SerialLine {
public:
    void setTxd(bool level, uint64_t now) {
        receive(now);
        level_ = level;
        if (!level && rxBit_ == 0 && armed_) {
            rxBit_ = 1;
            rxStart_ = static_cast<double>(now);
            rxAt_ = rxStart_ + bitNs_ / 2;
        }
        armed_ = armed_ || level;
    }
    void setBitTime(double ns) override {
        wantedBitNs_ = ns;
        if (rxBit_ == 0 && txBit_ == 0)
            bitNs_ = ns;
    }
    bool rxd() const { return txLevel_; }
    bool ctsN() const { return !cts_; }
    void setRts(bool mayTalk, uint64_t now) {
        rts_ = mayTalk;
        wake(now);
    }

    void advance(uint64_t now) override {
        receive(now);
        while (txBit_ && txAt_ <= static_cast<double>(now))
            shift();
        if (rxBit_ == 0 && txBit_ == 0)
            bitNs_ = wantedBitNs_;
    }
    // Returns the time of the next event: the next stop bit of a byte from the design, or the next
    // RXD edge. Nothing else can happen between two edges of TXD.
    uint64_t nextEvent() const override {
        double at = 1e300;
        if (rxBit_)
            at = rxAt_ + (stopBit - rxBit_) * bitNs_;
        if (txBit_)
            at = std::min(at, nextEdge());
        return at > 1e299 ? never : static_cast<uint64_t>(at);
    }
    void wake(uint64_t now) override {
        if (txBit_ == 0 && mayTalk())
            startByte(static_cast<double>(now));
    }

private:
    // index of the stop bit; bit 1 is the start bit, bits 2 to 9 are data
    static constexpr unsigned stopBit = 10;

    bool mayTalk() const { return rts_ || !heedsRts_; }
    // Samples TXD up to `now`; TXD has not changed since the last call.
    void receive(uint64_t now) {
        while (rxBit_ && rxAt_ <= static_cast<double>(now))
            sample(now);
    }
    void sample(uint64_t now) {
        if (rxBit_ == 1 && level_) {
            rxBit_ = 0; // a glitch
            return;
        }
        if (rxBit_ >= 2 && rxBit_ <= 9)
            rxByte_ = static_cast<uint8_t>(rxByte_ >> 1 | (level_ ? 0x80 : 0));
        if (rxBit_ == stopBit) {
            rxBit_ = 0;
            armed_ = level_;
            level_ ? client_->fromHost(rxByte_, now) : client_->framingError(now);
            return;
        }
        ++rxBit_;
        rxAt_ += bitNs_;
    }
    void startByte(double at) {
        if (!client_->nextToHost(txByte_))
            return;
        txLevel_ = false;
        txBit_ = 1;
        txAt_ = at + bitNs_;
    }
    // Returns the level after the start bit or a data bit.
    bool levelAfter(unsigned bit) const { return bit > 8 || (txByte_ >> (bit - 1) & 1); }
    double nextEdge() const {
        unsigned bit = txBit_;
        while (bit < stopBit && levelAfter(bit) == txLevel_)
            ++bit;
        return txAt_ + (bit - txBit_) * bitNs_;
    }
    void shift() {
        double at = txAt_;
        if (txBit_ < stopBit) {
            txLevel_ = levelAfter(txBit_);
        } else {
            txBit_ = 0;
            setBitTime(wantedBitNs_);
            if (mayTalk())
                startByte(at);
            return;
        }
        ++txBit_;
        txAt_ = at + bitNs_;
    }

    bool level_ = true, txLevel_ = true, rts_ = true, armed_ = true;
    unsigned rxBit_ = 0, txBit_ = 0;
    double wantedBitNs_ = bitNs_, rxStart_ = 0, rxAt_ = 0, txAt_ = 0;
    uint8_t rxByte_ = 0, txByte_ = 0;
};

// A line without a wire. The host is C++ code in the same process, which calls send and reads
// `received`.
class HostLine : public SerialLine {
public:
    void send(const std::vector<uint8_t>& bytes, uint64_t now) {
        for (uint8_t byte : bytes)
            client_->fromHost(byte, now);
    }
    std::vector<uint8_t> received;
    bool paused = false; // true: nothing is sent to the host
    bool cts() const { return cts_; }

    void advance(uint64_t) override {
        uint8_t byte;
        while (!paused && client_->nextToHost(byte))
            received.push_back(byte);
    }
    uint64_t nextEvent() const override { return never; }
    void wake(uint64_t) override { advance(0); }
};

// A pseudo-terminal, for programs that talk to a serial port. Bytes move at the modem's baud rate;
// while CTS is off, no bytes are read, which is the flow control. If the speed set by the program
// differs from the modem's by more than 4.5 %, bytes are damaged, as on a wire.
class PtyLine : public SerialLine {
public:
    PtyLine(); // throws std::system_error
    ~PtyLine() override;
    PtyLine(const PtyLine&) = delete;
    PtyLine& operator=(const PtyLine&) = delete;
    const std::string& path() const { return path_; }

    // A program may report how many bytes it has written and read; then no byte is late only
    // because the machine is busy (testbench/radio/ground_step.h).
    struct Count {
        // returns the number of the program's session, or 0 without a session; counts start at 0 in
        // each session
        std::function<uint64_t()> keeper;
        std::function<void(uint64_t keeper, size_t bytes)> toProgram;
        std::function<uint64_t()> fromProgram;
    };
    void keepCount(Count count) { count_ = std::move(count); }
    // Returns how many of the counted bytes the line has carried.
    uint64_t carried() const { return fetched_ - std::min<uint64_t>(fetched_, ahead_.size()); }

    void advance(uint64_t now) override;
    uint64_t nextEvent() const override { return nextPoll_; }
    void wake(uint64_t now) override;

private:
    bool speedFits() const;
    // Returns the time (ns) in which an idle wire may have carried bytes that were not noticed: one
    // poll period and one byte.
    double lookBack() const { return 1e6 + 10 * bitNs_; }
    void readAhead(uint64_t now);
    size_t fetch(uint8_t* bytes, size_t room);
    void readHost(uint64_t now);
    void writeHost(uint64_t now);

    // keeper_: the slave side of the pty, kept open so that closing it elsewhere causes no hang-up
    int master_ = -1, keeper_ = -1;
    std::string path_;
    uint64_t nextPoll_ = 0;
    double rxFree_ = 0, txFree_ = 0; // times at which the wire is free, in each direction
    std::vector<uint8_t> unwritten_;
    Count count_;
    bool txIdle_ = true;
    uint64_t counter_ = 0;      // session of the program to which the counts belong
    uint64_t fetched_ = 0;      // number of counted bytes fetched
    std::deque<uint8_t> ahead_; // bytes read that the wire has not carried yet
};

// Connects two serial lines by a wire in each direction, without modems.
class Cable {
public:
    // `bitNs`: bit time of both hosts. `carried` is called for each byte with the line that sent
    // it.
    Cable(SerialLine& first, SerialLine& second, double bitNs,
          std::function<void(const SerialLine& from)> carried)
        : ends_{{first, carried}, {second, carried}} {
        ends_[0].other = &ends_[1];
        ends_[1].other = &ends_[0];
        for (End& end : ends_) {
            end.line.attach(&end);
            end.line.setBitTime(bitNs);
            end.line.setHeedRts(true);
        }
    }
    Cable(const Cable&) = delete;
    Cable& operator=(const Cable&) = delete;

    void advance(uint64_t now) {
        for (End& end : ends_)
            end.line.advance(now);
    }
    uint64_t nextEvent() const {
        return std::min(ends_[0].line.nextEvent(), ends_[1].line.nextEvent());
    }

private:
    struct End : SerialClient {
        End(SerialLine& l, std::function<void(const SerialLine&)> c)
            : line(l), carried(std::move(c)) {}
        void fromHost(uint8_t byte, uint64_t now) override {
            other->bytes.push_back(byte);
            carried(line);
            other->line.wake(now);
        }
        // drops the byte; the check of the link detects the loss
        void framingError(uint64_t) override {}
        bool nextToHost(uint8_t& byte) override {
            if (bytes.empty())
                return false;
            byte = bytes.front();
            bytes.pop_front();
            return true;
        }
        SerialLine& line;
        std::function<void(const SerialLine&)> carried;
        End* other = nullptr;
        std::deque<uint8_t> bytes; // bytes on their way to this end
    };
    End ends_[2];
};
