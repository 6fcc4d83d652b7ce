// SPDX-License-Identifier: MIT
//
// secure_test: sessions with a key, and an attacker without it: a third radio that hears
// everything and sends any bytes.

#include "link_pair.h"
#include "variant.h"
#include <algorithm>
#include <cstdlib>
#include <gtest/gtest.h>

namespace {

const Bytes key(LINK_KEY_BYTES, 0x5A), otherKey(LINK_KEY_BYTES, 0x5B);

// A ground with the full layer, a vehicle with the full or the minimal one, and the attacker
// between. Messages carry their number, so that a lost, doubled or forged one shows at once.
class Attacked : public ::testing::TestWithParam<std::tuple<std::string, int>>, public Radio {
protected:
    Attacked() : Radio("full", std::get<0>(GetParam()), seed(), key) {}
    static uint64_t seed() {
        return testSeed() * 100 + static_cast<uint64_t>(std::get<1>(GetParam()));
    }

    // The attacker hears all new packets of a side.
    void listen() {
        for (size_t side = 0; side < 2; ++side) {
            Peer& from = side ? b_ : a_;
            for (auto& [time, packet] : from.air)
                if (time > heardUntil_[side])
                    for (Bytes& frame : framesOf(packet)) {
                        // The modem controller counts a packet's bytes by its first one.
                        EXPECT_EQ(frame.size(), LINK_LENGTH(frame) + LINK_OVERHEAD);
                        recorded_.push_back({&from == &a_, std::move(frame)});
                    }
            if (!from.air.empty())
                heardUntil_[side] = from.air.back().first;
        }
    }
    void attack(Peer& to, const Bytes& bytes) {
        to.receive(to.link(), bytes.data(), static_cast<U32>(bytes.size()), us());
        ++hostile_;
    }
    const Bytes& any() {
        return recorded_[random_.below(static_cast<uint32_t>(recorded_.size()))].bytes;
    }

    // One hostile packet of a random kind to a random side. Nothing in it is a frame that its
    // receiver has not heard from its peer before, but for what `replay` may bring: exact copies.
    void hostile() {
        Peer& to = random_.below(2) ? a_ : b_;
        Bytes frame = any();
        switch (random_.below(8)) {
        case 0: // replay, reflection, reordering: an unchanged packet of either side, at any time
            break;
        case 1: // several of them in a row
            for (const Bytes& more : {any(), any()})
                frame.insert(frame.end(), more.begin(), more.end());
            break;
        case 2: // one bit
            frame[random_.below(static_cast<uint32_t>(frame.size()))] ^=
                static_cast<uint8_t>(1u << random_.below(8));
            break;
        case 3: // cut
            frame.resize(1 + random_.below(static_cast<uint32_t>(frame.size())));
            break;
        case 4: // the attacker's header around a heard payload
            for (size_t i = 0; i < LINK_HEADER && i < frame.size(); ++i)
                if (random_.below(2))
                    frame[i] = static_cast<uint8_t>(random_.next());
            break;
        case 5: { // a control frame: ACK, HELLO, HELLO-ACK, CONFIRM (or RST), BYE, PING; guessed
                  // tag
            static const uint8_t sizes[] = {1, 8, 16, 16, 0, 0};
            uint32_t kind = random_.below(6);
            frame = {static_cast<uint8_t>(0x80 | (sizes[kind] + LINK_TAG_MORE)),
                     static_cast<uint8_t>(LINK_IS_HANDSHAKE(kind) ? LINK_VERSION : random_.next()),
                     static_cast<uint8_t>(kind << 5 | (random_.next() & 0x1F))};
            const Bytes& heard = any();
            for (size_t i = 0; i < sizes[kind] + LINK_TAG; ++i)
                frame.push_back(i < sizes[kind] && i + 3 < heard.size()
                                    ? heard[i + 3]
                                    : static_cast<uint8_t>(random_.next()));
            break;
        }
        case 6: // a data frame in order, guessed
            frame = Bytes(LINK_SECURE_OVERHEAD +
                          random_.below(LINK_MAX_FRAME - LINK_SECURE_OVERHEAD + 1));
            for (auto& byte : frame)
                byte = static_cast<uint8_t>(random_.next());
            frame[0] = static_cast<uint8_t>(frame.size() - LINK_OVERHEAD);
            break;
        default: // the open protocol's RST, HELLO and PING
            frame = {static_cast<uint8_t>(random_.below(2) ? 0x80 : 0x84),
                     LINK_VERSION,
                     static_cast<uint8_t>(random_.next()),
                     1,
                     2,
                     3,
                     4};
            frame.resize(LINK_LENGTH(frame) ? 7 : 3);
            U32 crc = link_crc(LINK_NO_SEED, frame.data(), static_cast<U32>(frame.size()));
            frame.push_back(static_cast<uint8_t>(crc >> 8));
            frame.push_back(static_cast<uint8_t>(crc));
        }
        attack(to, frame);
    }
    void offer(Peer& from, std::vector<std::pair<int, Bytes>>& sent, size_t most) {
        Bytes m(4 + random_.below(random_.below(4) ? 30 : 400), static_cast<uint8_t>(sent.size()));
        for (size_t i = 0; i < 4; ++i)
            m[i] = static_cast<uint8_t>(sent.size() >> 8 * i);
        if (sent.size() < most) {
            Link_Status status = from.send(1, m, static_cast<U32>(sent.size()));
            if (status == LINK_OK)
                sent.emplace_back(1, m);
            else if (status == LINK_CLOSED)
                from.open(1);
        }
    }
    // Sends hostile packets as often as the layer can bear: the minimal one finds the next frame
    // only after 25 ms of silence.
    void maybeHostile() {
        if (!recorded_.empty() && random_.chance(std::get<0>(GetParam()) == "full" ? 0.5 : 0.02))
            hostile();
    }
    // Messages both ways.
    bool traffic(size_t messages, bool isAttacked, uint64_t limitUs) {
        return until(
            [&] {
                offer(a_, sentA_, messages);
                offer(b_, sentB_, messages);
                listen();
                if (isAttacked)
                    maybeHostile();
                return a_.outcomes.size() >= messages && b_.outcomes.size() >= messages;
            },
            limitUs);
    }
    void expectAllArrivedOnce() {
        EXPECT_TRUE(b_.received == sentA_) << b_.received.size() << " of " << sentA_.size();
        EXPECT_TRUE(a_.received == sentB_) << a_.received.size() << " of " << sentB_.size();
        for (auto* side : {&a_, &b_})
            for (auto& [tag, outcome] : side->outcomes)
                EXPECT_EQ(outcome, LINK_DELIVERED) << tag;
    }
    static unsigned ups(const Peer& side) {
        return static_cast<unsigned>(std::count(side.events.begin(), side.events.end(), "up"));
    }

    struct Heard {
        bool isFromA;
        Bytes bytes;
    };
    std::vector<Heard> recorded_;
    std::vector<std::pair<int, Bytes>> sentA_, sentB_;
    uint64_t heardUntil_[2] = {0, 0};
    uint64_t hostile_ = 0;
    Random random_{seed() * 31 + 5};
};

// HOSTILE=10000000 sends more, nearly all of them to the full layer.
TEST_P(Attacked, NothingHostileIsAcceptedAndNothingLegalLostOrDoubled) {
    const char* more = std::getenv("HOSTILE");
    const uint64_t most = (more ? std::strtoull(more, nullptr, 10) : 60000) /
                          (std::get<0>(GetParam()) == "full" ? 2 : 20);
    ASSERT_TRUE(connect());
    for (size_t messages = 20; hostile_ < most; messages += 20)
        ASSERT_TRUE(traffic(messages, true, 600'000'000)) << hostile_ << " hostile packets";
    expectAllArrivedOnce();
    EXPECT_EQ(ups(a_), 1u);
    EXPECT_EQ(ups(b_), 1u);
    RecordProperty("packets", static_cast<int>(hostile_));
    std::printf("%llu hostile packets, %zu + %zu messages\n",
                static_cast<unsigned long long>(hostile_), sentA_.size(), sentB_.size());
}

// Recordings of earlier sessions, before reboots of both sides, have no effect either.
TEST_P(Attacked, RecordingsOfEarlierSessionsAreWorthNothing) {
    for (unsigned boot = 0; boot < 6; ++boot) {
        size_t before[2] = {a_.received.size(), b_.received.size()};
        Peer& side = boot % 2 ? a_ : b_;
        side.boot();
        a_.start(a_.link(), us());
        until(
            [&] {
                listen();
                maybeHostile();
                return false;
            },
            12'000'000); // longer than the other side's session
        EXPECT_EQ(a_.received.size(), before[0]);
        EXPECT_EQ(b_.received.size(), before[1]);
        ASSERT_TRUE(until([&] { return bothUp(); }, 30'000'000)) << "boot " << boot;
        sentA_.clear(), sentB_.clear();
        a_.outcomes.clear(), b_.outcomes.clear();
        a_.received.clear(), b_.received.clear();
        ASSERT_TRUE(traffic(20, true, 60'000'000)) << "boot " << boot;
        expectAllArrivedOnce();
    }
}

// Before each kind of frame arrives, copies with each single bit wrong arrive.
TEST_P(Attacked, AFrameWithAnyBitWrongIsRefused) {
    std::map<int, unsigned> kinds;
    auto flip = [&] {
        for (auto [from, to] : {std::pair(&a_, &b_), std::pair(&b_, &a_)})
            for (auto& [time, packet] : from->air)
                for (const Bytes& frame : framesOf(packet)) {
                    int kind = frame[0] & LINK_CONTROL ? frame[2] >> 5 : int(LINK_KIND_DATA);
                    if (kinds[kind]++ > 2)
                        continue;
                    auto rest = [&] { // what is kept of half a frame is dropped
                        now_ += 26'000;
                        to->poll(to->link(), us());
                    };
                    rest();
                    for (size_t bit = 0; bit < frame.size() * 8; ++bit) {
                        Bytes wrong = frame;
                        wrong[bit / 8] ^= static_cast<uint8_t>(1u << bit % 8);
                        size_t had = to->received.size(), events = to->events.size();
                        // (The minimal layer does not count.)
                        U32 good = to->statistics(to->link())->framesReceived;
                        attack(*to, wrong);
                        EXPECT_EQ(to->received.size(), had) << "kind " << kind << ", bit " << bit;
                        EXPECT_EQ(to->events.size(), events) << "kind " << kind << ", bit " << bit;
                        EXPECT_EQ(to->statistics(to->link())->framesReceived, good)
                            << "kind " << kind << ", bit " << bit;
                        if (bit < 8) // another length
                            rest();
                    }
                }
        return false;
    };
    a_.start(a_.link(), us());
    ASSERT_TRUE(until([&] { return flip() || bothUp(); }, 30'000'000));
    sentA_.clear();
    until(
        [&] {
            offer(a_, sentA_, 3);
            offer(b_, sentB_, 3);
            return flip();
        },
        8'000'000); // with a PING
    b_.stop(b_.link(), us());
    until([&] { return flip(); }, 100'000);
    for (int kind : {0, 1, 2, 3, 4, 5, 8})
        EXPECT_TRUE(kinds.count(kind)) << "no frame of kind " << kind << " has crossed";
}

// The session survives a flood of HELLOs that were once good, and few get an answer.
TEST_P(Attacked, AFloodOfHellosCostsFewAnswersAndNoSession) {
    std::vector<Bytes> hellos;
    for (unsigned boot = 0; boot < 12; ++boot) {
        a_.boot();
        recorded_.clear();
        a_.start(a_.link(), us());
        until([&] { return listen(), a_.isUp() && b_.isUp(); }, 12'000'000);
        for (const Heard& heard : recorded_)
            if ((heard.bytes[0] & LINK_CONTROL) && heard.bytes[2] >> 5 == LINK_KIND_HELLO)
                hellos.push_back(heard.bytes);
    }
    ASSERT_GE(hellos.size(), 12u);
    run(20'000'000); // both are in the last session
    ASSERT_TRUE(bothUp());
    a_.events.clear(), b_.events.clear();
    unsigned answers = 0;
    uint64_t counted[2] = {0, 0};
    const uint64_t start = now_;
    ASSERT_TRUE(until(
        [&] {
            offer(a_, sentA_, 200);
            offer(b_, sentB_, 200);
            for (auto* side : {&a_, &b_}) {
                attack(*side, hellos[random_.below(static_cast<uint32_t>(hellos.size()))]);
                for (auto& [time, packet] : side->air)
                    if (time > counted[side == &b_])
                        for (const Bytes& frame : framesOf(packet))
                            answers +=
                                (frame[0] & LINK_CONTROL) && frame[2] >> 5 == LINK_KIND_HELLO_ACK;
                if (!side->air.empty())
                    counted[side == &b_] = side->air.back().first;
            }
            return a_.outcomes.size() == 200 && b_.outcomes.size() == 200;
        },
        600'000'000));
    expectAllArrivedOnce();
    EXPECT_EQ(ups(a_) + ups(b_), 0u);
    EXPECT_LE(answers, 2 * (now_ - start) / LINK_ANSWER_EVERY + 2);
    std::printf("%llu HELLOs in %.1f s: %u answers\n", static_cast<unsigned long long>(hostile_),
                static_cast<double>(now_ - start) / 1e6, answers);
}

// A delayed frame that arrives long after its sender has gone finds no session.
TEST_P(Attacked, WhoOnlyReplaysDoesNotKeepASessionAlive) {
    ASSERT_TRUE(connect());
    ASSERT_TRUE(traffic(10, false, 60'000'000));
    until([&] { return listen(), false; }, 6'000'000); // a PING among it
    setWeather(1, 0, 0);                               // A is gone
    ASSERT_TRUE(until(
        [&] {
            for (const Heard& heard : recorded_)
                if (heard.isFromA)
                    attack(b_, heard.bytes);
            return !b_.isUp();
        },
        10'000'000));
}

// A's CONFIRM is held back, A starts again: the old CONFIRM comes too late for a session, whether A
// has a new one by then or is gone.
TEST_P(Attacked, AConfirmThatWasHeldBackMakesNoSession) {
    for (bool isGone : {false, true}) {
        recorded_.clear();
        a_.boot(), b_.boot();
        a_.start(a_.link(), us());
        ASSERT_TRUE(until([&] { return listen(), a_.isUp(); }, 5'000'000));
        a_.poll(a_.link(), us());
        listen();
        Bytes held = recorded_.back().bytes;
        ASSERT_EQ(held[2] >> 5, LINK_KIND_CONFIRM);
        a_.boot(); // nothing of it arrives
        if (isGone) {
            run(LINK_NONCE_LIFE);
        } else {
            a_.start(a_.link(), us());
            ASSERT_TRUE(until([&] { return bothUp(); }, 5'000'000));
        }
        const unsigned before = ups(b_);
        attack(b_, held);
        EXPECT_EQ(ups(b_), before) << (isGone ? "A is gone" : "A has a new session");
        EXPECT_EQ(b_.isUp(), !isGone);
    }
}

// An attack on new sessions: the attacker hears the traffic and adds 20 bytes to each packet, or
// sends them blindly. They are a byte of no frame and a seeming HELLO, of this version or another.
class Hindered : public Attacked {
protected:
    static Bytes lure(uint8_t version) {
        Bytes bytes = {0xFF};
        while (bytes.size() < 20)
            bytes.insert(bytes.end(), {LINK_CONTROL | (LINK_NONCE_BYTES + LINK_TAG_MORE), version,
                                       LINK_KIND_BITS(LINK_KIND_HELLO)});
        bytes.resize(20);
        return bytes;
    }
    void restart(bool bothCall) {
        for (Peer* side : {&a_, &b_}) {
            side->boot();
            heardUntil_[side == &b_] = side->sent;
        }
        setWeather(0.1, 0, 0);
        a_.start(a_.link(), us());
        if (bothCall)
            b_.start(b_.link(), us());
    }
    // Sends bytes to both sides when a packet has crossed, or is lost.
    void addBehindAll(const Bytes& bytes) {
        for (Peer* from : {&a_, &b_})
            if (uint64_t& heard = heardUntil_[from == &b_]; from->sent > heard) {
                heard = from->sent;
                for (Peer* to : {&a_, &b_})
                    to->air.emplace_back(std::max(from->free, to->free) + 8000, bytes);
            }
    }
    static constexpr uint64_t most = 20'000'000; // us until a session is there
};

TEST_P(Hindered, WhoAddsBytesToEachPacketPreventsNoSession) {
    for (uint8_t version : {LINK_VERSION, 0u})
        for (bool bothCall : {false, true})
            for (int run = 0; run < 5; ++run) {
                restart(bothCall);
                EXPECT_TRUE(until([&] { return addBehindAll(lure(version)), bothUp(); }, most))
                    << "version " << int(version) << ", both call: " << bothCall;
            }
}

TEST_P(Hindered, WhoSendsBlindlyPreventsNoSession) {
    for (uint8_t version : {LINK_VERSION, 0u})
        for (int run = 0; run < 5; ++run) {
            restart(run % 2);
            uint64_t next = now_;
            EXPECT_TRUE(until(
                [&] {
                    for (; next <= now_; next += 50'000)
                        for (Peer* side : {&a_, &b_})
                            attack(*side, lure(version));
                    return bothUp();
                },
                most))
                << "version " << int(version);
        }
}

// A side that starts again has a session within a second, however often its peer, which believes
// in the session before, hears HELLOs of that session and of an earlier one.
TEST_P(Hindered, OldHellosDelayARestartByLessThanASecond) {
    auto isHello = [](const Bytes& f) {
        return (f[0] & LINK_CONTROL) && f[2] >> 5 == LINK_KIND_HELLO;
    };
    for (bool isGround : {true, false}) // the side that starts again
        for (uint64_t every : {100'000, 10'000, 2000}) {
            Peer &side = isGround ? a_ : b_, &other = isGround ? b_ : a_;
            std::vector<Bytes> old;
            uint64_t next = now_, start = now_;
            a_.start(a_.link(), us());
            for (int restart = 0; restart < 3; ++restart) {
                ASSERT_TRUE(until([&] { return bothUp(); }, 30'000'000));
                run(3'000'000);
                side.boot();
                side.start(side.link(), us());
                ASSERT_TRUE(other.isUp());
                next = start = now_;
                EXPECT_TRUE(until(
                    [&] {
                        if (now_ % 100'000 < 1000) { // the minimal layer calls when it hears some
                            a_.open(1);
                            a_.send(1, {1}, static_cast<U32>(now_));
                        }
                        for (auto& [time, packet] : side.air)
                            if (restart < 2 && isHello(packet))
                                old.push_back(packet);
                        for (; restart == 2 && next <= now_; next += every)
                            for (const Bytes& hello : {old.front(), old.back()})
                                attack(other, hello), attack(side, hello);
                        return bothUp() && (restart == 2 || old.size() > unsigned(restart));
                    },
                    1'000'000))
                    << (isGround ? "ground" : "vehicle") << ", each " << every << " us";
            }
            std::printf("%s restarted, an old HELLO each %llu us: session after %.2f s\n",
                        isGround ? "ground" : "vehicle", static_cast<unsigned long long>(every),
                        static_cast<double>(now_ - start) / 1e6);
            run(15'000'000);
            EXPECT_TRUE(bothUp());
        }
}

INSTANTIATE_TEST_SUITE_P(Vehicles, Attacked,
                         ::testing::Combine(::testing::Values("full", "minimal"),
                                            ::testing::Range(0, 2)));
INSTANTIATE_TEST_SUITE_P(Vehicles, Hindered,
                         ::testing::Combine(::testing::Values("full", "minimal"),
                                            ::testing::Range(0, 2)));

} // namespace
