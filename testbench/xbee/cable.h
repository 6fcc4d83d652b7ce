// SPDX-License-Identifier: MIT
//
// cable: joins two serial lines by a wire each way, where no modems are between them.

#pragma once

#include "serial_line.h"

class Cable {
public:
    // `bitNs`: the bit time of both hosts. `carried` is called for each byte, with the line that it
    // came from.
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
        void framingError(uint64_t) override {} // a broken byte; the link's check finds the loss
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
        std::deque<uint8_t> bytes; // on their way to this end
    };
    End ends_[2];
};
