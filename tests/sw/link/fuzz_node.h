// SPDX-License-Identifier: MIT
//
// fuzz_node: a link for a fuzzer, with its program and its radio.

#ifndef LINK_FUZZ_NODE_H
#define LINK_FUZZ_NODE_H

#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

extern "C" {
#include "link.h"
}

using Bytes = std::vector<uint8_t>;

struct Node {
    std::unique_ptr<Link> link{new Link};
    std::deque<Bytes> out; // frames that are on their way
    uint32_t nonce = 1;
    uint64_t sum = 0; // a sum, which reads every byte handed over
    bool busy = false;
};

inline Node& node(void* c) {
    return *static_cast<Node*>(c);
}

inline const Link_Port port = {
    [](void* c, const U8* f, U32 n) {
        if (n < LINK_OVERHEAD || n > LINK_MAX_FRAME)
            __builtin_trap();
        if (node(c).out.size() > 50)
            return 1;
        node(c).out.emplace_back(f, f + n);
        return 0;
    },
    [](void* c) { return node(c).nonce = node(c).nonce * 1664525u + 1013904223u; },
    [](void* c, int channel, const U8* d, U32 n) {
        if (n < 1 || n > LINK_MAX_MESSAGE || channel < 0 || channel >= LINK_CHANNELS)
            __builtin_trap();
        for (U32 i = 0; i < n; ++i)
            node(c).sum += d[i];
        return node(c).busy ? 1 : 0;
    },
    [](void* c, int channel, int isOpen) {
        node(c).sum += static_cast<uint64_t>(channel + isOpen);
    },
    [](void* c, Link_State state) { node(c).sum += state; },
    [](void* c, int, U32 tag, Link_Outcome) { node(c).sum += tag; },
    [](void* c) { ++node(c).sum; }};

// The frame with its checksum.
inline Bytes checked(Bytes frame, U32 key) {
    const U32 crc = link_crc(key, frame.data(), static_cast<U32>(frame.size()));
    frame.push_back(static_cast<uint8_t>(crc >> 8));
    frame.push_back(static_cast<uint8_t>(crc));
    return frame;
}

#endif
