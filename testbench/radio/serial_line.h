// SPDX-License-Identifier: MIT
//
// serial_line: serial lines between a modem and its host. The host is a design (UART pins), a
// program (pseudo-terminal), or C++ code in the same process.

#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <vector>

constexpr uint64_t never = ~uint64_t(0);

// Interface of the modem at a line: the line gives it bytes and takes bytes from it.
class SerialClient {
public:
    virtual void fromHost(uint8_t byte, uint64_t now) = 0;
    virtual void framingError(uint64_t now) = 0;
    // Sets `byte` to the next byte from the modem to the host. Returns false without one.
    virtual bool nextToHost(uint8_t& byte) = 0;

protected:
    ~SerialClient() = default;
};

class SerialLine {
public:
    virtual ~SerialLine() = default;
    void attach(SerialClient* client) { client_ = client; }
    // Sets the bit time, ns. The change takes effect when no byte is being transferred.
    virtual void setBitTime(double ns) { bitNs_ = ns; }
    virtual void setCts(bool accepts) { cts_ = accepts; }
    // Sets whether the host can stop the modem by RTS (D6). A line without RTS ignores this
    // setting.
    void setHeedRts(bool heeds) { heedsRts_ = heeds; }
    virtual void advance(uint64_t now) = 0;
    virtual uint64_t nextEvent() const = 0;
    // Called when the modem has bytes to send; nextToHost returns these bytes.
    virtual void wake(uint64_t now) = 0;

protected:
    SerialClient* client_ = nullptr;
    double bitNs_ = 1e9 / 9600;
    bool cts_ = true, heedsRts_ = false;
};

// A line to the UART pins of a design. setTxd must be called for each change of the design's TXD;
// this class drives RXD and CTS.
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
        wantedBitNs_ = ns * drift_;
        if (rxBit_ == 0 && txBit_ == 0)
            bitNs_ = wantedBitNs_;
    }
    // Sets the rate of the design clock, as a factor of its nominal rate. Times of this class are
    // counted in the design's clocks.
    void drift(double factor) {
        wantedBitNs_ *= factor / drift_;
        drift_ = factor;
        if (rxBit_ == 0 && txBit_ == 0)
            bitNs_ = wantedBitNs_;
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
    // edge of RXD. Between two events, only an edge of TXD needs attention, and setTxd reports such
    // edges.
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
    // number of the stop bit; bit 1 is the start bit, bits 2 to 9 are the data bits
    static constexpr unsigned stopBit = 10;

    bool mayTalk() const { return rts_ || !heedsRts_; }
    // Samples TXD up to `now`. TXD must not have changed since the last call.
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
    // Returns the level of RXD or TXD after the start bit or a data bit.
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
            if (rxBit_ == 0)
                bitNs_ = wantedBitNs_;
            if (mayTalk())
                startByte(at);
            return;
        }
        ++txBit_;
        txAt_ = at + bitNs_;
    }

    bool level_ = true, txLevel_ = true, rts_ = true, armed_ = true;
    unsigned rxBit_ = 0, txBit_ = 0;
    double drift_ = 1; // rate of the design clock, as a factor of its nominal rate
    double wantedBitNs_ = bitNs_, rxStart_ = 0, rxAt_ = 0, txAt_ = 0;
    uint8_t rxByte_ = 0, txByte_ = 0;
};

// A line without a wire, to C++ code in the same process. This code calls send() and reads
// `received`.
class HostLine : public SerialLine {
public:
    void send(const std::vector<uint8_t>& bytes, uint64_t now) {
        for (uint8_t byte : bytes)
            client_->fromHost(byte, now);
    }
    std::vector<uint8_t> received;
    bool paused = false; // true: nothing is sent to the C++ code
    bool cts() const { return cts_; }

    void advance(uint64_t) override {
        uint8_t byte;
        while (!paused && client_->nextToHost(byte))
            received.push_back(byte);
    }
    uint64_t nextEvent() const override { return never; }
    void wake(uint64_t) override { advance(0); }
};

// A line to a program: a pseudo-terminal that the program opens like a serial port. Bytes move at
// the modem's baud rate. While CTS is off, no bytes are read from the program; this is the flow
// control. If the program sets a speed that differs from the modem's by more than 4.5 %, bytes are
// damaged, as on a wire.
class PtyLine : public SerialLine {
public:
    PtyLine(); // throws std::system_error
    ~PtyLine() override;
    PtyLine(const PtyLine&) = delete;
    PtyLine& operator=(const PtyLine&) = delete;
    const std::string& path() const { return path_; }

    // Numbers of bytes that a program may report: written bytes and read bytes. With these numbers,
    // no byte is late only because the machine is busy (testbench/radio/ground_step.h).
    struct Count {
        // returns the number of the program's session, in which counts start at 0; 0 if no program
        // counts
        std::function<uint64_t()> keeper;
        std::function<void(uint64_t keeper, size_t bytes)> toProgram;
        std::function<uint64_t()> fromProgram;
    };
    void keepCount(Count count) { count_ = std::move(count); }
    // Returns the number of counted bytes that the line has carried.
    uint64_t carried() const { return fetched_ - std::min<uint64_t>(fetched_, ahead_.size()); }

    void advance(uint64_t now) override;
    uint64_t nextEvent() const override { return nextPoll_; }
    void wake(uint64_t now) override;

private:
    bool speedFits() const;
    // Returns the largest age of bytes that are read now from an idle wire, ns: two poll periods
    // plus the time of one byte.
    double lookBack() const { return 1e6 + 10 * bitNs_; }
    void readAhead(uint64_t now);
    size_t fetch(uint8_t* bytes, size_t room);
    void readHost(uint64_t now);
    void writeHost(uint64_t now);

    // keeper_: slave side of the pty; it stays open so that the pty does not hang up when a program
    // closes it
    int master_ = -1, keeper_ = -1;
    std::string path_;
    uint64_t nextPoll_ = 0;
    double rxFree_ = 0, txFree_ = 0; // times at which the wire is free again, in each direction
    std::vector<uint8_t> unwritten_;
    Count count_;
    bool txIdle_ = true;
    uint64_t counter_ = 0;      // session of the program to which the counts belong
    uint64_t fetched_ = 0;      // number of counted bytes that were read from the pty
    std::deque<uint8_t> ahead_; // bytes that were read but that the wire has not carried yet
};

// Connects two serial lines directly, without modems, by a wire in each direction.
class Cable {
public:
    // `bitNs` is the bit time of both hosts, ns. `carried` is called for each byte, with the line
    // that sent the byte.
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
        // a byte with a wrong stop bit is dropped; the link detects the loss by its checksum
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
        std::deque<uint8_t> bytes; // bytes on their way to this line
    };
    End ends_[2];
};
