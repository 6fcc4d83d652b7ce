// SPDX-License-Identifier: MIT
//
// mischief: makes frames that an attacker can send without the key. These are recorded frames,
// unchanged, altered, truncated or joined; control frames and data with a guessed tag; and frames
// of the unencrypted protocol.

#pragma once

#include "random.h"
#include <functional>
#include <vector>

extern "C" {
#include "link.h"
}

// Returns hostile bytes of a random kind. `any` returns a recorded packet. Only unchanged copies of
// recorded frames have a valid tag.
inline std::vector<uint8_t> mischief(Random& random,
                                     const std::function<const std::vector<uint8_t>&()>& any) {
    auto byte = [&] { return static_cast<uint8_t>(random.next()); };
    std::vector<uint8_t> frame = any();
    switch (random.below(8)) {
    case 0: // an unchanged frame at any time: replay, reflection, reordering
        break;
    case 1: // several recorded frames in a row
        for (const std::vector<uint8_t>& more : {any(), any()})
            frame.insert(frame.end(), more.begin(), more.end());
        break;
    case 2: // one bit
        frame[random.below(static_cast<uint32_t>(frame.size()))] ^=
            static_cast<uint8_t>(1u << random.below(8));
        break;
    case 3: // cut
        frame.resize(1 + random.below(static_cast<uint32_t>(frame.size())));
        break;
    case 4: // the header is the attacker's, the payload is recorded
        for (size_t i = 0; i < LINK_HEADER && i < frame.size(); ++i)
            if (random.below(2))
                frame[i] = byte();
        break;
    // a control frame with a guessed tag: ACK, HELLO, HELLO-ACK, CONFIRM (or RST), BYE, PING
    case 5: {
        static const uint8_t sizes[] = {
            1, LINK_NONCE_BYTES, LINK_ANSWER_BYTES, LINK_ANSWER_BYTES, 0, 0};
        uint32_t kind = random.below(6);
        frame = {static_cast<uint8_t>(0x80 | (sizes[kind] + LINK_TAG_MORE)),
                 LINK_IS_HANDSHAKE(kind) ? static_cast<uint8_t>(LINK_VERSION) : byte(),
                 static_cast<uint8_t>(kind << 5 | (byte() & 0x1F))};
        const std::vector<uint8_t>& heard = any();
        for (size_t i = 0; i < sizes[kind] + LINK_TAG; ++i)
            frame.push_back(i < sizes[kind] && i + 3 < heard.size() ? heard[i + 3] : byte());
        break;
    }
    case 6: // the data frame that is expected next, with a guessed tag
        frame.resize(LINK_SECURE_OVERHEAD +
                     random.below(LINK_MAX_FRAME - LINK_SECURE_OVERHEAD + 1));
        for (uint8_t& each : frame)
            each = byte();
        frame[0] = static_cast<uint8_t>(frame.size() - LINK_OVERHEAD);
        break;
    default: // RST, HELLO and PING of the unencrypted protocol
        frame = {
            static_cast<uint8_t>(random.below(2) ? 0x80 : 0x84), LINK_VERSION, byte(), 1, 2, 3, 4};
        frame.resize(LINK_LENGTH(frame) ? 7 : 3);
        U32 crc = link_crc(LINK_NO_SEED, frame.data(), static_cast<U32>(frame.size()));
        frame.push_back(static_cast<uint8_t>(crc >> 8));
        frame.push_back(static_cast<uint8_t>(crc));
    }
    return frame;
}

// Returns 20 bytes that an attacker appends to packets. They are not a frame, but look like the
// beginnings of HELLOs of this version, so that the receiver spends time on searching them while
// the next frame waits.
inline std::vector<uint8_t> lure(uint8_t version) {
    std::vector<uint8_t> bytes = {0xFF};
    while (bytes.size() < 20)
        bytes.insert(bytes.end(), {LINK_CONTROL | (LINK_NONCE_BYTES + LINK_TAG_MORE), version,
                                   LINK_KIND_BITS(LINK_KIND_HELLO)});
    bytes.resize(20);
    return bytes;
}
