// SPDX-License-Identifier: MIT
//
// api_modem: drives a modem in API mode. Each packet names its target, and the modem reports for
// each packet whether it was delivered. Frames: 0x7E, length (2 bytes), contents, checksum. If AP
// is 2, four byte values are escaped.
//
//   01 ID TARGET TARGET 00 DATA...          packet to send
//   89 ID STATUS                            result of this packet; 0: received by the other modem
//   81 SOURCE SOURCE RSSI OPTIONS DATA...   received packet
//   08 ID LETTER LETTER VALUE...            AT command
//   88 ID LETTER LETTER STATUS VALUE...     reply to this command
//   8A STATUS                               modem status, such as started

#pragma once

#include "key_file.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

extern "C" {
#include "link_config.h"
}

namespace XBeeAT {

class ApiFrames {
public:
    using Bytes = std::vector<uint8_t>;
    enum Type : uint8_t {
        Transmit = 0x01,
        Command = 0x08,
        Wide = 0x80, // type of a packet received from a modem that has no 16-bit address
        Packet = 0x81,
        Answer = 0x88,
        Status = 0x89,
        Event = 0x8A
    };
    // source address of packets from a modem that has no 16-bit address
    static constexpr int noAddress = -1;

    // `escapes`: true if the modem's AP is 2.
    explicit ApiFrames(bool escapes = false) : escapes_(escapes) {}

    // Returns a frame with these contents.
    Bytes pack(const Bytes& contents) const {
        Bytes frame = {delimiter};
        put(frame, static_cast<uint8_t>(contents.size() >> 8));
        put(frame, static_cast<uint8_t>(contents.size()));
        uint8_t sum = 0xFF;
        for (uint8_t byte : contents) {
            put(frame, byte);
            sum = static_cast<uint8_t>(sum - byte);
        }
        put(frame, sum);
        return frame;
    }
    Bytes packet(uint8_t id, uint16_t target, const uint8_t* data, size_t size) const {
        Bytes contents = {Transmit, id, static_cast<uint8_t>(target >> 8),
                          static_cast<uint8_t>(target), 0};
        contents.insert(contents.end(), data, data + size);
        return pack(contents);
    }
    Bytes command(uint8_t id, const std::string& letters, const Bytes& value) const {
        Bytes contents = {Command, id};
        contents.insert(contents.end(), letters.begin(), letters.end());
        contents.insert(contents.end(), value.begin(), value.end());
        return pack(contents);
    }
    // Parses bytes from the modem. Passes the data of a received packet to `data(source, bytes,
    // count)` as the bytes arrive, without waiting for the frame's checksum, because the link
    // checks the data itself. Calls `frame` with the contents of each other frame. After a wrong
    // checksum, searches for the next frame, starting at the byte after the delimiter.
    template <class Data, class Frame>
    void feed(const uint8_t* bytes, size_t count, Data data, Frame frame) {
        in_.insert(in_.end(), bytes, bytes + count);
        size_t at = 0;
        while (at < in_.size()) {
            if (in_[at] != delimiter) {
                ++at;
                continue;
            }
            size_t used = read(at);
            const size_t end = contents_.size(), head = headOf(end ? contents_[0] : 0);
            if (head && end > std::max(head, given_)) {
                const size_t from = std::max(head, given_);
                data(sourceOf(head), contents_.data() + from, end - from);
                given_ = end;
            }
            if (used == 0)
                break;
            at += used;
            given_ = 0;
            if (!head && isWhole_)
                frame(contents_);
        }
        in_.erase(in_.begin(), in_.begin() + static_cast<std::ptrdiff_t>(at));
    }
    void clear() {
        in_.clear();
        given_ = 0;
    }

private:
    static constexpr uint8_t delimiter = 0x7E, escape = 0x7D, escapeXor = 0x20;
    // largest size of a frame's contents, bytes: a packet from a 64-bit address, with a margin
    static constexpr size_t longest = 120;

    // Returns the offset of the data in the contents of a frame; 0 if the frame is not a received
    // packet.
    static size_t headOf(uint8_t type) { return type == Packet ? 5 : type == Wide ? 11 : 0; }
    int sourceOf(size_t head) const {
        return head == 5 ? contents_[1] << 8 | contents_[2] : noAddress;
    }
    void put(Bytes& frame, uint8_t byte) const {
        const bool isEscaped =
            escapes_ && (byte == delimiter || byte == escape || byte == 0x11 || byte == 0x13);
        if (isEscaped)
            frame.push_back(escape);
        frame.push_back(isEscaped ? byte ^ escapeXor : byte);
    }
    // Reads the part of a frame that has arrived so far. `at` is the offset of the frame's
    // delimiter. Returns the number of bytes used, or 0 if the frame is incomplete.
    size_t read(size_t at) {
        // length and contents of the current frame; for a complete frame, also its checksum
        Bytes& plain = contents_;
        isWhole_ = false;
        plain.clear();
        size_t length = 0, used = 0, i = at + 1;
        for (; i < in_.size() && !used; ++i) {
            uint8_t byte = in_[i];
            if (escapes_ && byte == delimiter) {
                used = i - at; // an unescaped delimiter is the start of another frame
                break;
            }
            if (escapes_ && byte == escape) {
                if (++i == in_.size())
                    break;
                byte = in_[i] ^ escapeXor;
            }
            plain.push_back(byte);
            if (plain.size() == 2) {
                length = size_t(plain[0]) << 8 | plain[1];
                if (length == 0 || length > longest)
                    used = 1;
            } else if (plain.size() == length + 3 && plain.size() > 2) {
                uint8_t sum = 0;
                for (size_t b = 2; b < plain.size(); ++b)
                    sum = static_cast<uint8_t>(sum + plain[b]);
                isWhole_ = sum == 0xFF;
                used = isWhole_ ? i + 1 - at : 1;
                plain.pop_back();
            }
        }
        plain.erase(plain.begin(),
                    plain.begin() + std::min<std::ptrdiff_t>(2, std::ptrdiff_t(plain.size())));
        return used;
    }

    bool escapes_;
    Bytes in_;             // bytes received, starting at the delimiter of the current frame
    Bytes contents_;       // contents of the last frame read
    bool isWhole_ = false; // true if the frame is complete and has a correct checksum
    // number of bytes of the current frame's contents that were already handled
    size_t given_ = 0;
};

// A modem in API mode. Times are in microseconds, 32 bits wide, and wrap around.
class ApiModem {
public:
    using Bytes = ApiFrames::Bytes;

    explicit ApiModem(bool escapes) : frames_(escapes) {}

    // Returns the bytes that make the modem send a packet. If RN differs from the RN of the
    // previous packet, the bytes first set the modem's RN.
    Bytes packet(int target, const uint8_t* data, size_t size, uint32_t rn, uint32_t now) {
        Bytes bytes;
        if (rn != rn_)
            bytes = frames_.command(0, "RN", {static_cast<uint8_t>(rn)});
        rn_ = rn;
        // for a broadcast, the frame id is 0 and the modem reports no result
        const bool isAnswered = target != everybody;
        if (isAnswered) {
            id_ = id_ == 0xFF ? 1 : id_ + 1;
            waiting_.push_back({id_, now});
        }
        const auto frame =
            frames_.packet(isAnswered ? id_ : 0, static_cast<uint16_t>(target), data, size);
        bytes.insert(bytes.end(), frame.begin(), frame.end());
        return bytes;
    }
    // Processes bytes from the modem. Calls `data(source, bytes, count)` with the bytes of packets,
    // and `answer(isThere)` for each sent packet, in order.
    template <class Data, class Answer>
    void feed(const uint8_t* bytes, size_t count, const Data& data, const Answer& answer) {
        frames_.feed(bytes, count, data, [&](const Bytes& frame) {
            if (frame[0] != ApiFrames::Status || frame.size() != 3 ||
                std::none_of(waiting_.begin(), waiting_.end(),
                             [&](const Packet& p) { return p.id == frame[1]; }))
                return;
            for (bool isLast = false; !isLast;) {
                // the results of earlier packets in the list were lost on the serial line; these
                // packets count as lost
                isLast = waiting_.front().id == frame[1];
                waiting_.pop_front();
                answer(isLast && frame[2] == 0);
            }
        });
    }
    // Calls `lost()` for each packet without a result after LINK_ANSWER_LAST.
    template <class Lost> void expire(uint32_t now, const Lost& lost) {
        for (; !waiting_.empty() && now - waiting_.front().at >= LINK_ANSWER_LAST; lost())
            waiting_.pop_front();
    }

private:
    struct Packet {
        uint8_t id;
        uint32_t at; // time at which the packet was passed to the modem
    };
    ApiFrames frames_;
    // current RN of the modem; at first, the value that was written during the set-up
    uint32_t rn_ = LINK_WAIT_SHARED;
    uint8_t id_ = 0;
    std::deque<Packet> waiting_; // packets without a result, oldest first
};

} // namespace XBeeAT
