// SPDX-License-Identifier: MIT
//
// link_variants: a test fixture for link layers of different kinds; it sends messages between them
// in both directions.

#pragma once

#include "../../support/delivery_check.h"
#include "../../support/environment.h"
#include "ice_messages.h"
#include "link_pair.h"
#include <algorithm>
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <tuple>

// A combination of layers: the names of the layers of sides a and b (CMakeLists.txt), and whether
// both have a key.
struct Variant {
    std::string a, b;
    bool hasKey = false;
    unsigned seed = 0;
};

inline void PrintTo(const Variant& v, std::ostream* out) {
    *out << v.a << "_" << v.b << (v.hasKey ? "_key" : "_open");
    if (v.seed)
        *out << "_" << v.seed;
}

// Returns combinations in which the vehicle has the full layer and a key, one per seed.
inline std::vector<Variant> keyed(unsigned seeds) {
    std::vector<Variant> all;
    for (unsigned seed = 0; seed < seeds; ++seed)
        all.push_back({"full", "full", true, seed});
    return all;
}

// Returns the combinations of keyed(), and those in which the vehicle has no key and the full or
// the minimal layer.
inline std::vector<Variant> vehicles(unsigned seeds) {
    std::vector<Variant> all = keyed(seeds);
    for (const char* vehicle : {"full", "minimal"})
        for (unsigned seed = 0; seed < seeds; ++seed)
            all.push_back({"full", vehicle, false, seed});
    return all;
}

inline const Layer& loadLayer(const std::string& name) {
    void* library = dlopen((VARIANTS + name + ".so").c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library)
        throw std::runtime_error(dlerror());
    return *static_cast<const Layer*>(dlsym(library, "layer"));
}

class Variants : public ::testing::TestWithParam<Variant>, public LinkPair {
protected:
    Variants()
        : LinkPair(testSeed() * 1000 + GetParam().seed,
                   Bytes(GetParam().hasKey ? LINK_KEY_BYTES : 0, 0x5A), loadLayer(GetParam().a),
                   loadLayer(GetParam().b)) {}

    static bool isMinimal() { return GetParam().b.find("minimal") == 0; }

    // Sends the next message of a side on a random channel. The message consists of random bytes,
    // or is an Ice message with these bytes as parameters, with increasing ids and with operations
    // that the peer knows.
    void offer(Side& from, Messages& sent, size_t most) {
        if (sent.size() >= most)
            return;
        const int channel = static_cast<int>(random.below(LINK_CHANNELS));
        const uint32_t kind = random.below(3), number = static_cast<U32>(sent.size());
        Bytes m(1 + random.below(random.below(4) ? usualSize : longestSize));
        for (auto& byte : m)
            byte = static_cast<uint8_t>(random.next());
        uint32_t& id = ids_[{&from, channel, kind}];
        if (kind && m.size() + 60 <= longestSize)
            m = kind == 1
                    ? IceMessages::reply(id + 1, m)
                    : IceMessages::request(id + 1, "uav",
                                           random.below(9) ? "known" : std::to_string(number), m);
        const Link_Status status = from.send(channel, m, number);
        id += status == LINK_OK;
        if (status == LINK_OK)
            sent.emplace_back(channel, m);
        else if (status == LINK_CLOSED) // the channel was closed by a new session
            from.open(channel);
    }
    // Sends messages in both directions until this number of messages has been sent and all have
    // been reported, or until the time has elapsed.
    template <class Meanwhile>
    bool traffic(size_t messages, uint64_t limitUs, Meanwhile meanwhile) {
        return until(
            [&] {
                offer(a, sentA, messages);
                offer(b, sentB, messages);
                meanwhile();
                return a.outcomes.size() == messages && b.outcomes.size() == messages;
            },
            limitUs);
    }
    bool traffic(size_t messages, uint64_t limitUs) {
        return traffic(messages, limitUs, [] {});
    }
    // Checks the received messages. They must be a subset of the sent messages, in order and
    // unchanged, and include all messages that were reported as delivered. Between full layers, a
    // short message may overtake a message on another channel.
    static void check(const Messages& sent, const Side& sender, const Side& receiver) {
        ASSERT_EQ(sender.outcomes.size(), sent.size()) << "messages not reported";
        DeliveryCheck delivery;
        auto stream = [](int channel) { return isMinimal() ? 0 : channel; };
        for (U32 id = 0; id < sent.size(); ++id) {
            delivery.sent(stream(sent[id].first), id, sent[id].second);
            if (sender.outcomes.at(id) != LINK_DELIVERED)
                (void)delivery.reported(id, false);
        }
        for (auto& [channel, message] : receiver.received)
            EXPECT_EQ(delivery.arrived(stream(channel), message), "");
        for (auto& [id, outcome] : sender.outcomes)
            if (outcome == LINK_DELIVERED) {
                EXPECT_EQ(delivery.reported(id, true), "");
            }
    }
    void checkBoth() {
        check(sentA, a, b);
        check(sentB, b, a);
    }
    void expectAllDelivered() {
        checkBoth();
        for (auto* side : {&a, &b})
            for (auto& [tag, outcome] : side->outcomes)
                EXPECT_EQ(outcome, LINK_DELIVERED) << tag;
    }

    Messages sentA, sentB;
    uint32_t usualSize = 60, longestSize = 500;
    Random random{testSeed() * 77 + GetParam().seed};

private:
    // last id that was used, by sender, channel and kind of message
    std::map<std::tuple<const Side*, int, uint32_t>, uint32_t> ids_;
};

// Returns the Link_Kind of a frame.
inline int kindOf(const Bytes& frame) {
    return frame[0] & LINK_CONTROL ? frame[2] >> 5 : LINK_KIND_DATA;
}

// Returns the frames in a packet.
inline std::vector<Bytes> framesOf(const Bytes& packet) {
    std::vector<Bytes> frames;
    for (size_t at = 0; at < packet.size() && packet[at] != LINK_FILL;) {
        size_t size = LINK_LENGTH(&packet[at]) + LINK_OVERHEAD;
        frames.emplace_back(packet.begin() + static_cast<long>(at),
                            packet.begin() + static_cast<long>(std::min(at + size, packet.size())));
        at += size;
    }
    return frames;
}
