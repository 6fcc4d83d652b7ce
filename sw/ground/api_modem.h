// SPDX-License-Identifier: MIT
//
// api_modem: a modem in API mode: packets go to it with a target, and it answers for each.

#ifndef GROUND_API_MODEM_H
#define GROUND_API_MODEM_H

#include "api_frames.h"
#include "contention.h"

#include <deque>

namespace XBeeAT {

class ApiModem {
public:
    // `target`: the peer's address; all others' packets are dropped, unless it is that of all.
    ApiModem(bool escapes, int target, bool encrypts = false)
        : frames_(escapes), contention_(encrypts), target_(target) {}

    // Returns the bytes for the line that send a packet, and first set RN if it must change.
    ApiFrames::Bytes packet(const uint8_t* data, size_t size, uint32_t now) {
        ApiFrames::Bytes bytes;
        contention_.sent(size, now);
        if (contention_.changes(now))
            bytes = frames_.command(0, "RN", {contention_.exponent()});
        id_ = id_ == 0xFF ? 1 : id_ + 1; // 0 would ask for no answer
        waiting_.push_back(id_);
        const auto frame = frames_.packet(id_, static_cast<uint16_t>(target_), data, size);
        bytes.insert(bytes.end(), frame.begin(), frame.end());
        return bytes;
    }
    // Takes bytes from the line. Calls `data(bytes, count)` with the peer's, and `answer(isThere)`
    // for each packet that was sent, in their order: the peer's modem has it, or it is lost.
    template <class Data, class Answer>
    void feed(const uint8_t* bytes, size_t count, uint32_t now, Data data, Answer answer) {
        frames_.feed(
            bytes, count,
            [&](int source, const uint8_t* heard, size_t size) {
                contention_.heard(size, now);
                if (source == target_ || source == ApiFrames::nobody || target_ == everybody)
                    data(heard, size);
            },
            [&](const ApiFrames::Bytes& frame) {
                if (frame[0] != ApiFrames::Status || frame.size() != 3 ||
                    std::find(waiting_.begin(), waiting_.end(), frame[1]) == waiting_.end())
                    return;
                if (frame[2])
                    contention_.lost(now);
                for (bool isLast = false; !isLast; answer(isLast && frame[2] == 0)) {
                    isLast = waiting_.front() == frame[1]; // the line lost the others' answers
                    waiting_.pop_front();
                }
            });
    }

private:
    static constexpr int everybody = 0xFFFF;

    ApiFrames frames_;
    Contention contention_;
    int target_;
    uint8_t id_ = 0;
    std::deque<uint8_t> waiting_; // numbers of packets without an answer
};

} // namespace XBeeAT

#endif
