// SPDX-License-Identifier: MIT
//
// recorded_test: checks that the current link layer understands the packets of earlier releases.
//
// recorded/link-VERSION-KIND.txt contains the packets of a session between a ground station (a) and
// a vehicle (b): time of arrival in microseconds, sender, bytes. One side runs the current code,
// and gets the packets of the recorded peer, with the same random numbers and the same calls of its
// program. It must deliver the peer's messages, and must be informed that its own messages arrived.
//
// A change that makes this test fail changes the wire format (docs/compatibility.md): increase
// LINK_VERSION, and record the packets of the new version with RECORD=1 in the environment. Do not
// replace a recording of an existing version, unless only the order of random numbers or the times
// of sending have changed. Before you replace it in this case, check that the old code and the new
// code can communicate.

#include "ice_messages.h"
#include "link_pair.h"

#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>

namespace {

struct Packet {
    uint64_t at;
    char from;
    Bytes bytes;
};
using Packets = std::vector<Packet>;

const Bytes key = {3, 1, 4, 1, 5, 9, 2, 6, 5, 3, 5, 8, 9, 7, 9, 3};
using IceMessages::message;
constexpr uint64_t start = 0xFFFF0000u, length = 4'000'000;

std::string fileOf(const std::string& kind) {
    return RECORDED "/link-" + std::to_string(LINK_VERSION) + "-" + kind + ".txt";
}

// Returns the messages of a side: requests of the ground, or replies of the vehicle (two with a
// value and one with an exception), and other bytes. The Ice headers of requests and replies are
// compressed; the other bytes are sent unchanged.
std::vector<Bytes> messagesOf(char side) {
    std::vector<Bytes> messages;
    if (side == 'b')
        messages.push_back(message(3, {})); // validates the connection
    for (uint8_t n = 1; n <= 3; ++n) {
        const Bytes request = {n,   0,   0, 0, 5,  'm', 'e', 't', 'e', 'r', 0, 0, 3, 'a',
                               'd', 'd', 0, 0, 10, 0,   0,   0,   1,   1,   n, 0, 0, 0};
        const Bytes reply = {n, 0, 0, 0, 0, 7, 0, 0, 0, 1, 1, n};
        const Bytes exception = {n, 0, 0, 0, 5, 2, 'n', 'o'};
        messages.push_back(side == 'a' ? message(0, request)
                                       : message(2, n == 3 ? exception : reply));
    }
    for (size_t size : {1u, 40u, 1000u}) {
        Bytes m(size);
        for (size_t i = 0; i < size; ++i)
            m[i] = static_cast<uint8_t>(i * 7 + static_cast<size_t>(side));
        messages.push_back(m);
    }
    if (side == 'a')
        messages.push_back(message(4, {})); // closes the connection
    return messages;
}

// A side with its program. The ground opens a channel, and both sides send a message every 200 ms.
struct Program {
    Program(char called, const uint64_t& now, const Bytes& withKey)
        : name(called),
          side(layer, now, called == 'a' ? 3 : 4, withKey, called == 'a' ? LINK_GROUND | 1u : 1u) {}

    void step(uint64_t since) {
        if (since == 0 && name == 'a')
            side.start();
        side.poll();
        const uint64_t first = name == 'a' ? 1'000'000 : 1'100'000;
        if (!side.isUp() || since < first || (since - first) % 200'000 != 0)
            return;
        const std::vector<Bytes> messages = messagesOf(name);
        if (sent == 0 && name == 'a')
            side.open(0);
        if (sent < messages.size()) {
            EXPECT_EQ(side.send(0, messages[sent], sent), LINK_OK);
            ++sent;
        }
    }

    char name;
    Side side;
    U32 sent = 0;
};

// Delivers to `to` the packets that arrive not later than `now`, and records them.
void deliver(Program& from, Program& to, uint64_t now, Packets& packets) {
    while (!from.side.air.empty() && from.side.air.front().arrives <= now) {
        packets.push_back({now, from.name, from.side.air.front().bytes});
        from.side.air.pop_front();
        to.side.receive(packets.back().bytes);
    }
}

void expectDelivered(const Program& program) {
    Messages expected;
    for (const Bytes& m : messagesOf(program.name == 'a' ? 'b' : 'a'))
        expected.emplace_back(0, m);
    EXPECT_EQ(program.side.received, expected) << program.name;
    EXPECT_EQ(program.side.sessions(), 1u);
    EXPECT_EQ(program.side.outcomes.size(), messagesOf(program.name).size());
    for (auto& [tag, outcome] : program.side.outcomes)
        EXPECT_EQ(outcome, LINK_DELIVERED) << tag;
}

// Runs a session with the current code, and writes its packets to a file.
void record(const std::string& kind, const Bytes& withKey) {
    uint64_t now = start;
    Packets packets;
    Program a('a', now, withKey), b('b', now, withKey);
    for (; now < start + length; now += 1000) {
        deliver(a, b, now, packets);
        deliver(b, a, now, packets);
        a.step(now - start);
        b.step(now - start);
    }
    expectDelivered(a);
    expectDelivered(b);
    std::ofstream file(fileOf(kind));
    for (const Packet& p : packets) {
        file << p.at - start << ' ' << p.from << ' ';
        for (uint8_t byte : p.bytes)
            file << "0123456789abcdef"[byte >> 4] << "0123456789abcdef"[byte & 15];
        file << '\n';
    }
}

Packets read(const std::string& name) {
    std::ifstream file(name);
    Packets packets;
    std::string line, hex;
    while (std::getline(file, line)) {
        Packet p;
        std::istringstream words(line);
        words >> p.at >> p.from >> hex;
        p.at += start;
        for (size_t i = 0; i + 1 < hex.size(); i += 2)
            p.bytes.push_back(static_cast<uint8_t>(std::stoi(hex.substr(i, 2), nullptr, 16)));
        packets.push_back(p);
    }
    return packets;
}

// Runs one side with the current code, and gives it the recorded packets of the other side.
void replay(char name, const std::string& kind, const Bytes& withKey) {
    const Packets packets = read(fileOf(kind));
    ASSERT_FALSE(packets.empty()) << "expected a recording in " << fileOf(kind)
                                  << "; RECORD=1 in the environment makes one";
    uint64_t now = start;
    Program program(name, now, withKey);
    size_t next = 0;
    for (; now < start + length; now += 1000) {
        for (; next < packets.size() && packets[next].at <= now; ++next)
            if (packets[next].from != name)
                program.side.receive(packets[next].bytes);
        program.step(now - start);
    }
    expectDelivered(program);
}

// Replays a session for one side. If RECORD is in the environment, records the session first.
void check(char name, bool isKeyed) {
    const std::string kind = isKeyed ? "keyed" : "clear";
    const Bytes withKey = isKeyed ? key : Bytes();
    if (std::getenv("RECORD"))
        record(kind, withKey);
    replay(name, kind, withKey);
}

TEST(Recorded, TheCurrentVehicleUnderstandsTheGround) {
    check('b', false);
}

TEST(Recorded, TheCurrentVehicleUnderstandsTheGroundUnderAKey) {
    check('b', true);
}

TEST(Recorded, TheCurrentGroundUnderstandsTheVehicle) {
    check('a', false);
}

TEST(Recorded, TheCurrentGroundUnderstandsTheVehicleUnderAKey) {
    check('a', true);
}

} // namespace
