// SPDX-License-Identifier: MIT
//
// timed_line: a serial line to a modem that takes a wire's time for each byte, and heeds CTS.

#ifndef TIMED_LINE_H
#define TIMED_LINE_H

#include "serial_line.h"
#include <algorithm>
#include <deque>

class TimedLine : public SerialLine {
public:
    void send(const uint8_t* bytes, size_t count, uint64_t now) {
        if (out_.empty())
            outFree_ = std::max(outFree_, static_cast<double>(now));
        out_.insert(out_.end(), bytes, bytes + count);
    }
    size_t waiting() const { return out_.size(); }
    std::vector<uint8_t> received;
    bool hangs = false; // its host: nothing moves

    void advance(uint64_t now) override {
        if (hangs)
            return;
        const double byteNs = 10 * bitNs_, time = static_cast<double>(now);
        while (!out_.empty() && cts_ && outFree_ + byteNs <= time) {
            outFree_ += byteNs;
            client_->fromHost(out_.front(), now);
            out_.pop_front();
        }
        if (!out_.empty() && !cts_)
            outFree_ = std::max(outFree_, time);
        while (busy_ && inDone_ <= time) {
            received.push_back(byte_);
            busy_ = client_->nextToHost(byte_);
            inDone_ += byteNs;
        }
    }
    uint64_t nextEvent() const override {
        if (hangs)
            return never;
        double at = busy_ ? inDone_ : 1e300;
        if (!out_.empty())
            at = std::min(at, outFree_ + 10 * bitNs_);
        return at > 1e299 ? never : static_cast<uint64_t>(at) + 1;
    }
    void wake(uint64_t now) override {
        if (busy_ || !client_->nextToHost(byte_))
            return;
        busy_ = true;
        inDone_ = static_cast<double>(now) + 10 * bitNs_;
    }

private:
    std::deque<uint8_t> out_;
    double outFree_ = 0, inDone_ = 0;
    bool busy_ = false;
    uint8_t byte_ = 0;
};

#endif
