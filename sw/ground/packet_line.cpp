// SPDX-License-Identifier: MIT
//
// packet_line: sends one packet at a time to the serial port, and reads all bytes that arrive.

#include "packet_line.h"

#include <algorithm>

namespace XBeeAT {

bool PacketLine::send(Sender& sender, const U8* frame, U32 size, U32 now) {
    U32 rn = sender.randomWait();
    for (const Sender* other : senders_)
        rn = other->isUp() ? std::max(rn, other->randomWait()) : rn;
    if (!out_.empty() || (!api_ && serial_.waiting()))
        return false;
    out_ = api_ ? api_->packet(sender.address(), frame, size, rn, now)
                : ApiModem::Bytes(frame, frame + size);
    sender.airUs = std::max(sender.airUs, airUs_);
    airUs_ = sender.airUs;
    sender.airUs += LINK_PACKET_US + size * LINK_BYTE_US;
    flush();
    return true;
}

ssize_t PacketLine::read(const Deliver& deliver, const Answer& answer) {
    U8 bytes[512];
    const ssize_t count = serial_.read(bytes, sizeof bytes);
    const size_t size = static_cast<size_t>(count);
    if (count > 0 && api_)
        api_->feed(bytes, size, deliver, answer);
    else if (count > 0)
        deliver(target_, bytes, size);
    return count;
}

void PacketLine::flush() {
    if (out_.empty())
        return;
    ssize_t count = serial_.write(out_.data(), out_.size());
    if (count > 0)
        out_.erase(out_.begin(), out_.begin() + count);
}

} // namespace XBeeAT
