// SPDX-License-Identifier: MIT
//
// xbee_api: the part of XBee that handles API frames. A frame consists of 0x7E, length (2 bytes),
// type, contents and checksum. With AP 2 some bytes are escaped.

#include "xbee.h"

namespace {

constexpr uint8_t delimiter = 0x7E, escape = 0x7D, escapeXor = 0x20;
// largest number of bytes that a frame contains in addition to its data
constexpr size_t longestHead = 23;

bool mustEscape(uint8_t byte) {
    return byte == delimiter || byte == escape || byte == 0x11 || byte == 0x13;
}

uint8_t sum(const uint8_t* bytes, size_t count) {
    uint8_t total = 0;
    for (size_t i = 0; i < count; ++i)
        total = static_cast<uint8_t>(total + bytes[i]);
    return total;
}

} // namespace

void XBee::apiByte(uint8_t byte, uint64_t now) {
    bool escapes = active_.at("AP") == 2;
    if (byte == delimiter && (escapes || !inFrame_)) {
        inFrame_ = true; // in escaped mode, a delimiter always starts a frame
        escaped_ = false;
        frame_.clear();
        return;
    }
    if (!inFrame_)
        return;
    if (escapes && byte == escape && !escaped_) {
        escaped_ = true;
        return;
    }
    frame_.push_back(escaped_ ? byte ^ escapeXor : byte);
    escaped_ = false;
    const size_t longestFrame = longestHead + profile_.packetBytes;
    size_t length = frame_.size() >= 2 ? size_t(frame_[0]) << 8 | frame_[1] : longestFrame;
    if (frame_.size() >= 2 && (length == 0 || length > longestFrame)) {
        inFrame_ = false;
        ++counters_.badFrames;
    } else if (frame_.size() == length + 3) {
        inFrame_ = false;
        if (sum(&frame_[2], length + 1) != 0xFF)
            ++counters_.badFrames;
        else
            apiFrame({frame_.begin() + 2, frame_.end() - 1}, now);
    }
}

void XBee::apiFrame(const Bytes& frame, uint64_t now) {
    switch (frame[0]) {
    case 0x00: // transmit request to a 64-bit address
    case 0x01: // 16-bit address
        apiSend(frame, now);
        break;
    case 0x08: // AT command
    case 0x09: // AT command; its value takes effect with the command AC
        apiCommand(frame, now);
        break;
    default:
        ++counters_.badFrames;
    }
}

void XBee::apiSend(const Bytes& frame, uint64_t now) {
    size_t address = frame[0] == 0x00 ? 8 : 2, head = 2 + address + 1;
    if (frame.size() <= head || frame.size() - head > packetBytes()) {
        ++counters_.badFrames;
        if (frame.size() > head && frame[1] && profile_.tooLongStatus)
            apiReply({0x89, frame[1], profile_.tooLongStatus});
        return;
    }
    RfPacket packet = addressed();
    packet.wide = frame[0] == 0x00;
    packet.to64 = 0;
    for (size_t i = 0; i < address; ++i)
        packet.to64 = packet.to64 << 8 | frame[2 + i];
    packet.to = static_cast<uint16_t>(packet.to64);
    if (packet.wide && packet.to64 == 0xFFFF)
        packet.wide = false; // 64-bit broadcast address
    const uint8_t options = frame[head - 1];
    const bool noAck = options & 0x01;
    if (options & 0x04)
        packet.pan = RfPacket::allPans;
    if (noAck || packet.isBroadcast())
        packet.acknowledged = false;
    setRounds(packet);
    packet.bytes.assign(frame.begin() + static_cast<std::ptrdiff_t>(head), frame.end());
    apiQueue_.push_back({frame[1], std::move(packet)});
    updateCts();
    sendPackets(now);
}

void XBee::sendApiPacket(uint64_t now) {
    ApiPacket next = std::move(apiQueue_.front());
    apiQueue_.pop_front();
    updateCts();
    apiId_ = next.id;
    launch(std::move(next.packet), now);
}

// Executes an AT command and replies with a frame 0x88. Its status is 0 OK, 1 ERROR, 2 invalid
// command, or 3 invalid value.
void XBee::apiCommand(const Bytes& frame, uint64_t now) {
    if (frame.size() < 4) {
        ++counters_.badFrames;
        return;
    }
    ++counters_.commands;
    std::string letters(frame.begin() + 2, frame.begin() + 4);
    uint32_t value = 0;
    std::string key;
    for (size_t i = 4; i < frame.size(); ++i) {
        value = value << 8 | frame[i];
        key += "0123456789ABCDEF"[frame[i] >> 4];
        key += "0123456789ABCDEF"[frame[i] & 15];
    }
    Bytes answer = {0x88, frame[1], frame[2], frame[3], 0};
    auto parameter = pending_.find(letters);
    const bool isRefused =
        letters == refuse_ || (frame.size() > 4 && letters + std::to_string(value) == refuse_);
    const bool known = parameter != pending_.end() && !isRefused;
    if (letters == "KY") {
        answer[4] = setKey(key) ? 0 : 3;
    } else if (frame.size() > 4) {
        answer[4] = !known ? 2 : setParameter(letters, value) ? 0 : 3;
        if (answer[4] == 0 && frame[0] == 0x08)
            apply();
    } else if (known) {
        unsigned bytes = table_.at(letters).highest > 0xFFFF ? 4
                         : table_.at(letters).highest > 0xFF ? 2
                                                             : 1;
        while (bytes--)
            answer.push_back(static_cast<uint8_t>(parameter->second >> (8 * bytes)));
    } else if (isRefused || order(letters, now).empty()) {
        answer[4] = 2;
    }
    counters_.refused += answer[4] != 0;
    if (frame[1] != 0) // with frame id 0 the host requests no reply
        apiReply(answer);
    line_.wake(now);
}

void XBee::apiReply(const Bytes& frame) {
    Bytes bytes = {static_cast<uint8_t>(frame.size() >> 8), static_cast<uint8_t>(frame.size())};
    bytes.insert(bytes.end(), frame.begin(), frame.end());
    bytes.push_back(static_cast<uint8_t>(0xFF - sum(frame.data(), frame.size())));
    output_.push_back(delimiter);
    for (uint8_t byte : bytes) {
        bool escaped = active_.at("AP") == 2 && mustEscape(byte);
        if (escaped)
            output_.push_back(escape);
        output_.push_back(escaped ? byte ^ escapeXor : byte);
    }
}

// Reports a received packet to the host: a frame 0x81 for a 16-bit source address or 0x80 for a
// 64-bit source address, with source, RSSI, options and data.
void XBee::apiReceived(const RfPacket& packet) {
    Bytes frame = {static_cast<uint8_t>(packet.from64 ? 0x80 : 0x81)};
    for (int byte = packet.from64 ? 7 : 1; byte >= 0; --byte)
        frame.push_back(
            static_cast<uint8_t>((packet.from64 ? packet.serial : packet.from) >> (8 * byte)));
    frame.push_back(static_cast<uint8_t>(active_.at("DB")));
    frame.push_back(static_cast<uint8_t>((packet.isBroadcast() ? 2 : 0) |
                                         (packet.pan == RfPacket::allPans ? 4 : 0)));
    frame.insert(frame.end(), packet.bytes.begin(), packet.bytes.end());
    apiReply(frame);
}
