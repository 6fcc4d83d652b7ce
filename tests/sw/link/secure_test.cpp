// SPDX-License-Identifier: MIT
//
// secure_test: tests sessions with a key under attack. The attacker does not have the key, but has
// a third radio, which hears everything and can send any bytes.

#include "link_variants.h"
#include "mischief.h"

extern "C" {
#include "link_broadcast.h"
#include "link_codec_keyed.h"
}

namespace {

// A ground station, a vehicle, and an attacker between them.
class Attacked : public Variants {
protected:
    // Records all new packets of both sides, as an attacker could.
    void listen() {
        for (size_t side = 0; side < 2; ++side) {
            Side& from = side ? b : a;
            for (auto& packet : from.air)
                if (packet.arrives > heardUntil_[side])
                    for (Bytes& frame : framesOf(packet.bytes)) {
                        // The modem controller gets the length of a packet from its first byte.
                        EXPECT_EQ(frame.size(), LINK_LENGTH(frame) + LINK_OVERHEAD);
                        recorded_.push_back({side == 0, std::move(frame)});
                    }
            if (!from.air.empty())
                heardUntil_[side] = from.air.back().arrives;
        }
    }
    void attack(Side& to, const Bytes& bytes) {
        to.receive(bytes);
        ++hostile_;
    }
    // Sends one hostile packet to one of the two sides, chosen at random.
    void hostile() {
        Side& to = random.below(2) ? a : b;
        attack(to, mischief(random, [this]() -> const Bytes& {
                   return recorded_[random.below(static_cast<uint32_t>(recorded_.size()))].bytes;
               }));
    }
    void maybeHostile() {
        if (!recorded_.empty() && random.chance(0.5))
            hostile();
    }
    // Sends messages in both directions under attack. Returns true if all of them were delivered in
    // time.
    bool attackedTraffic(size_t messages, uint64_t limitUs) {
        return traffic(messages, limitUs, [&] {
            listen();
            maybeHostile();
        });
    }

    struct Heard {
        bool isFromA;
        Bytes bytes;
    };
    std::vector<Heard> recorded_;
    uint64_t heardUntil_[2] = {0, 0};
    uint64_t hostile_ = 0;
};

// HOSTILE=10000000 sets the number of hostile packets; each of the two seeds gets half of them.
TEST_P(Attacked, NoForgedMessageIsAcceptedAndNoValidMessageIsLostOrDuplicated) {
    const auto most = static_cast<uint64_t>(numberFromEnvironment("HOSTILE", 60'000) / 2);
    ASSERT_TRUE(connect());
    for (size_t messages = 20; hostile_ < most; messages += 20)
        ASSERT_TRUE(attackedTraffic(messages, 600'000'000)) << hostile_ << " hostile packets";
    expectAllDelivered();
    EXPECT_EQ(a.sessions(), 1u);
    EXPECT_EQ(b.sessions(), 1u);
    RecordProperty("packets", static_cast<int>(hostile_));
    std::printf("%llu hostile packets, %zu + %zu messages\n",
                static_cast<unsigned long long>(hostile_), sentA.size(), sentB.size());
}

TEST_P(Attacked, RecordingsOfEarlierSessionsAreRejected) {
    for (unsigned boot = 0; boot < 6; ++boot) {
        size_t before[2] = {a.received.size(), b.received.size()};
        Side& side = boot % 2 ? a : b;
        side.boot();
        a.start();
        until(
            [&] {
                listen();
                maybeHostile();
                return false;
            },
            12'000'000); // time limit, us; the session of the other side ends earlier
        EXPECT_EQ(a.received.size(), before[0]);
        EXPECT_EQ(b.received.size(), before[1]);
        ASSERT_TRUE(until([&] { return bothUp(); }, 30'000'000)) << "boot " << boot;
        sentA.clear(), sentB.clear();
        a.outcomes.clear(), b.outcomes.clear();
        a.received.clear(), b.received.clear();
        ASSERT_TRUE(attackedTraffic(20, 60'000'000)) << "boot " << boot;
        expectAllDelivered();
    }
}

// Before each frame arrives, copies of it arrive in which one bit is wrong, one copy for each bit.
// All kinds of frames are tested.
TEST_P(Attacked, AFrameWithAnyWrongBitIsRejected) {
    std::map<int, unsigned> kinds;
    auto flip = [&] {
        for (auto [from, to] : {std::pair(&a, &b), std::pair(&b, &a)})
            for (auto& packet : from->air)
                for (const Bytes& frame : framesOf(packet.bytes)) {
                    const int kind = kindOf(frame);
                    if (kinds[kind]++ > 2)
                        continue;
                    // waits until the stored bytes of an incomplete frame have been dropped
                    auto rest = [&] {
                        now += 26'000;
                        to->poll();
                    };
                    rest();
                    for (size_t bit = 0; bit < frame.size() * 8; ++bit) {
                        Bytes wrong = frame;
                        wrong[bit / 8] ^= static_cast<uint8_t>(1u << bit % 8);
                        size_t had = to->received.size(), events = to->events.size();
                        U32 good = to->statistics().framesReceived;
                        attack(*to, wrong);
                        EXPECT_EQ(to->received.size(), had) << "kind " << kind << ", bit " << bit;
                        EXPECT_EQ(to->events.size(), events) << "kind " << kind << ", bit " << bit;
                        EXPECT_EQ(to->statistics().framesReceived, good)
                            << "kind " << kind << ", bit " << bit;
                        if (bit < 8) // another length
                            rest();
                    }
                }
        return false;
    };
    a.start();
    ASSERT_TRUE(until([&] { return flip() || bothUp(); }, 30'000'000));
    sentA.clear();
    until(
        [&] {
            offer(a, sentA, 3);
            offer(b, sentB, 3);
            return flip();
        },
        8'000'000); // time limit, us; at least one PING is sent in this time
    b.stop();
    until([&] { return flip(); }, 100'000);
    for (int kind : {0, 1, 2, 3, 4, 5, 8})
        EXPECT_TRUE(kinds.count(kind)) << "no frame of kind " << kind << " has crossed";
}

TEST_P(Attacked, AFloodOfHellosGetsFewRepliesAndEndsNoSession) {
    std::vector<Bytes> hellos;
    for (unsigned boot = 0; boot < 12; ++boot) {
        a.boot();
        recorded_.clear();
        a.start();
        until([&] { return listen(), a.isUp() && b.isUp(); }, 12'000'000);
        for (const Heard& heard : recorded_)
            if (kindOf(heard.bytes) == LINK_KIND_HELLO)
                hellos.push_back(heard.bytes);
    }
    ASSERT_GE(hellos.size(), 12u);
    run(20'000'000); // after this time both sides have the last session
    ASSERT_TRUE(bothUp());
    a.events.clear(), b.events.clear();
    recorded_.clear();
    const uint64_t start = now;
    ASSERT_TRUE(traffic(200, 600'000'000, [&] {
        for (auto* side : {&a, &b})
            attack(*side, hellos[random.below(static_cast<uint32_t>(hellos.size()))]);
        listen();
    }));
    expectAllDelivered();
    EXPECT_EQ(a.sessions() + b.sessions(), 0u);
    const auto answers = std::count_if(recorded_.begin(), recorded_.end(), [](const Heard& heard) {
        return LINK_IS_HANDSHAKE(kindOf(heard.bytes));
    });
    EXPECT_GT(answers, 0);
    EXPECT_LE(static_cast<uint64_t>(answers), 2 * (now - start) / LINK_ANSWER_EVERY + 2);
    std::printf("%llu HELLOs in %.1f s: %ld answers\n", static_cast<unsigned long long>(hostile_),
                static_cast<double>(now - start) / 1e6, answers);
}

// A delayed frame that arrives long after its sender has disappeared belongs to no session.
TEST_P(Attacked, ReplayedFramesDoNotKeepASessionAlive) {
    ASSERT_TRUE(connect());
    ASSERT_TRUE(traffic(10, 60'000'000));
    until([&] { return listen(), false; }, 6'000'000); // long enough to record a PING
    setWeather({1, 0, 0});                             // side A disappears: its packets are lost
    ASSERT_TRUE(until(
        [&] {
            for (const Heard& heard : recorded_)
                if (heard.isFromA)
                    attack(b, heard.bytes);
            return !b.isUp();
        },
        10'000'000));
}

// A's CONFIRM is delayed, and A restarts. The old CONFIRM must not begin a session, whether A
// already has a new session or is absent.
TEST_P(Attacked, ADelayedConfirmBeginsNoSession) {
    for (bool isGone : {false, true}) {
        recorded_.clear();
        a.boot(), b.boot();
        a.start();
        ASSERT_TRUE(until([&] { return listen(), a.isUp(); }, 5'000'000));
        a.poll();
        listen();
        Bytes held = recorded_.back().bytes;
        ASSERT_EQ(kindOf(held), LINK_KIND_CONFIRM);
        a.boot(); // no later frame of A arrives
        if (isGone) {
            run(LINK_NONCE_LIFE);
        } else {
            a.start();
            ASSERT_TRUE(until([&] { return bothUp(); }, 5'000'000));
        }
        const unsigned before = b.sessions();
        attack(b, held);
        EXPECT_EQ(b.sessions(), before) << (isGone ? "A is gone" : "A has a new session");
        EXPECT_EQ(b.isUp(), !isGone);
    }
}

// The attacker holds back only the fragments of one message, and delivers them later. By then the
// sender has been informed of the loss, and the receiver does not accept the fragments any more.
TEST_P(Attacked, AWithheldMessageIsReportedAndNeverDeliveredLater) {
    for (bool isFromA : {true, false}) {
        Side &from = isFromA ? a : b, &to = isFromA ? b : a;
        ASSERT_TRUE(connect());
        from.open(1);
        run(500'000);
        from.outcomes.clear(), to.received.clear();
        ASSERT_EQ(from.send(1, {1, 2, 3}, 1), LINK_OK);
        std::vector<Bytes> held;
        auto isOfMessage = [](const Side::Packet& packet) {
            const int kind = kindOf(framesOf(packet.bytes).front());
            return kind >= LINK_KIND_PIGGYBACK;
        };
        auto hold = [&] {
            for (auto& packet : from.air)
                if (isOfMessage(packet))
                    held.push_back(packet.bytes);
            from.air.erase(std::remove_if(from.air.begin(), from.air.end(), isOfMessage),
                           from.air.end());
        };
        const uint64_t start = now;
        ASSERT_TRUE(until([&] { return hold(), !from.outcomes.empty(); }, 60'000'000));
        EXPECT_EQ(from.outcomes[1], LINK_UNKNOWN);
        EXPECT_NEAR(double(now - start), 27e6, 300'000);
        until([&] { return hold(), false; }, 2'000'000);
        ASSERT_FALSE(held.empty());
        for (const Bytes& packet : held)
            attack(to, packet);
        run(1'000'000);
        EXPECT_TRUE(to.received.empty()) << (isFromA ? "from A" : "from B");
    }
}

// Returns how many recorded frames of a session can be decrypted with these keys, not counting the
// frames of the handshake.
int opened(const std::vector<std::pair<bool, Bytes>>& frames, const Link_Keys& keys) {
    int count = 0;
    for (auto [isFromGround, frame] : frames) {
        const U32 acked = LINK_IS_PIGGYBACK(kindOf(frame)) ? frame[LINK_HEADER] : 0;
        count += link_decryptFrame(frame.data(), &keys.bytes[isFromGround ? LINK_KEY_BYTES : 0],
                                   frame[1], acked);
    }
    return count;
}

// An attacker who has recorded a session and learns the key later can decrypt only the frames of
// the handshake. He could decrypt all frames if one side had not erased its half of the key pair.
TEST_P(Attacked, AKeyThatLeaksLaterDecryptsNoRecordedSession) {
    Link_KeyPair pair = {};
    a.start();
    ASSERT_TRUE(until(
        [&] {
            if (b.link()->session.handshake.hasPair)
                pair = b.link()->session.handshake.pair;
            return listen(), bothUp();
        },
        5'000'000));
    ASSERT_TRUE(traffic(10, 60'000'000, [&] { listen(); }));

    Link_Secret stolen;
    link_makeSecret(&stolen, Bytes(LINK_KEY_BYTES, 0x5A).data(), 1);
    Link_Keys keys = {};
    Bytes open;
    std::vector<std::pair<bool, Bytes>> frames;
    int handshakes = 0;
    for (const auto& [isFromA, bytes] : recorded_) {
        Bytes frame = bytes;
        U8* nonces = &frame[LINK_HEADER];
        const int kind = kindOf(frame);
        if (kind == LINK_KIND_HELLO_ACK) { // the vehicle's
            link_deriveKeys(&stolen, nonces, nonces + LINK_NONCE_BYTES, &keys);
            handshakes += link_decryptFrame(frame.data(), keys.bytes, 0, 0);
        } else if (kind == LINK_KIND_CONFIRM) {
            handshakes += link_decryptFrame(frame.data(), &keys.bytes[LINK_KEY_BYTES], 0, 0);
            open.assign(&frame[LINK_PUBLIC_AT], &frame[LINK_PUBLIC_AT] + LINK_PUBLIC_BYTES);
        } else if (kind != LINK_KIND_HELLO) {
            frames.emplace_back(isFromA, bytes);
        }
    }
    EXPECT_GE(handshakes, 2);
    ASSERT_GE(frames.size(), 20u);
    EXPECT_EQ(opened(frames, keys), 0);
    link_mixKeys(&keys, &pair, open.data());
    EXPECT_EQ(opened(frames, keys), int(frames.size()));
    const Link_KeyPair& left = a.link()->session.handshake.pair;
    EXPECT_FALSE(a.link()->session.handshake.hasPair);
    EXPECT_EQ(Bytes(left.privateKey, left.privateKey + LINK_PUBLIC_BYTES),
              Bytes(LINK_PUBLIC_BYTES, 0));
}

// Returns true if the memory of a side contains any 8 consecutive bytes of a secret.
bool remains(Side& side, const U8* secret, size_t size) {
    const U8* memory = reinterpret_cast<const U8*>(side.link());
    for (size_t at = 0; at + 8 <= size; ++at)
        if (std::search(memory, memory + side.layer.size, secret + at, secret + at + 8) !=
            memory + side.layer.size)
            return true;
    return false;
}

TEST_P(Attacked, KeysAndMessagesAreErasedAtTheEndOfASession) {
    for (bool isStopped : {true, false}) {
        ASSERT_TRUE(connect());
        for (auto* side : {&a, &b})
            side->open(1);
        run(500'000);
        Bytes brief(40), picture(400);
        for (Bytes* message : {&brief, &picture})
            for (auto& byte : *message)
                byte = static_cast<uint8_t>(random.next());
        for (auto* side : {&a, &b})
            for (Bytes* message : {&brief, &picture})
                ASSERT_EQ(side->send(1, *message, random.next()), LINK_OK);
        run(2'000'000);
        const auto secrets = b.link()->session.handshake.present.secrets;
        const auto* bytes = reinterpret_cast<const U8*>(&secrets);
        ASSERT_TRUE(remains(b, bytes, sizeof secrets.keys));
        ASSERT_TRUE(remains(b, picture.data(), picture.size()));
        if (isStopped) {
            b.stop();
        } else { // otherwise the peer vanishes without a BYE
            setWeather({1, 0, 0});
            run(30'000'000);
            setWeather({});
        }
        ASSERT_FALSE(b.isUp());
        EXPECT_FALSE(remains(b, bytes, sizeof secrets.keys)) << "keys";
        EXPECT_FALSE(remains(b, secrets.handshake.bytes, sizeof secrets.handshake)) << "handshake";
        EXPECT_FALSE(remains(b, brief.data(), brief.size())) << "short message";
        EXPECT_FALSE(remains(b, picture.data(), picture.size())) << "long message";
        a.stop();
        run(1'000'000);
    }
}

// Recorded HELLOs, each with a different nonce, must make a side compute a key pair only once, and
// no session key.
TEST_P(Attacked, OldHellosCauseOnlyOneKeyComputation) {
    std::vector<Bytes> hellos;
    for (unsigned boot = 0; boot < 5; ++boot) {
        recorded_.clear();
        a.boot(), b.boot();
        a.start();
        ASSERT_TRUE(until([&] { return listen(), bothUp(); }, 5'000'000));
        hellos.push_back(recorded_.front().bytes);
        ASSERT_EQ(kindOf(hellos.back()), LINK_KIND_HELLO);
    }
    b.boot();
    setWeather({1, 0, 0}); // A does not receive the replies
    Link_KeyPair first = {};
    // this lasts longer than four lifetimes of a nonce
    for (int i = 0; i < 400; ++i, run(100'000)) {
        attack(b, hellos[size_t(i) % hellos.size()]);
        if (i == 0)
            first = b.link()->session.handshake.pair;
        ASSERT_TRUE(b.link()->session.handshake.hasPair);
        EXPECT_EQ(memcmp(&first, &b.link()->session.handshake.pair, sizeof first), 0);
    }
    EXPECT_FALSE(b.isUp());
}

// Tests with an attack on new sessions: the attacker hears the traffic and adds misleading bytes to
// each packet, or sends them without hearing.
class Hindered : public Attacked {
protected:
    void restart(bool bothCall) {
        for (Side* side : {&a, &b}) {
            side->boot();
            heardUntil_[side == &b] = side->bytesSent;
        }
        setWeather({0.1, 0, 0});
        a.start();
        if (bothCall)
            b.start();
    }
    // Sends bytes to both sides right after each packet, whether the packet arrives or is lost.
    void addBehindAll(const Bytes& bytes) {
        for (Side* from : {&a, &b})
            if (uint64_t& heard = heardUntil_[from == &b]; from->bytesSent > heard) {
                heard = from->bytesSent;
                for (Side* to : {&a, &b})
                    to->air.push_back(
                        {std::max(from->serialFreeUs, to->serialFreeUs) + 8000, bytes});
            }
    }
};

TEST_P(Hindered, AddedBytesAndBlindPacketsPreventNoSession) {
    for (uint8_t version : {uint8_t(LINK_VERSION), uint8_t(0)})
        for (bool isBlind : {false, true})
            for (int run = 0; run < 10; ++run) {
                restart(run % 2);
                uint64_t next = now;
                EXPECT_TRUE(until(
                    [&] {
                        if (!isBlind)
                            addBehindAll(lure(version));
                        for (; isBlind && next <= now; next += 50'000)
                            for (Side* side : {&a, &b})
                                attack(*side, lure(version));
                        return bothUp();
                    },
                    20'000'000))
                    << "version " << int(version) << ", blindly: " << isBlind << ", run " << run;
            }
}

// A side that restarts must have a session within a second, while its peer still has the previous
// session. HELLOs of that session and of an earlier one may arrive at the peer at any rate.
TEST_P(Hindered, OldHellosDelayARestartByLessThanASecond) {
    for (bool isGround : {true, false}) // which side restarts
        for (uint64_t every : {100'000, 10'000, 2000}) {
            Side &side = isGround ? a : b, &other = isGround ? b : a;
            std::vector<Bytes> old;
            uint64_t next = now, start = now;
            a.start();
            for (int restart = 0; restart < 3; ++restart) {
                ASSERT_TRUE(until([&] { return bothUp(); }, 30'000'000));
                run(3'000'000);
                side.boot();
                side.start();
                ASSERT_TRUE(other.isUp());
                next = start = now;
                EXPECT_TRUE(until(
                    [&] {
                        for (auto& packet : side.air)
                            if (restart < 2 && kindOf(packet.bytes) == LINK_KIND_HELLO)
                                old.push_back(packet.bytes);
                        for (; restart == 2 && next <= now; next += every)
                            for (const Bytes& hello : {old.front(), old.back()})
                                attack(other, hello), attack(side, hello);
                        return bothUp() && (restart == 2 || old.size() > unsigned(restart));
                    },
                    1'000'000))
                    << (isGround ? "ground" : "vehicle") << ", each " << every << " us";
            }
            std::printf("%s restarted, an old HELLO each %llu us: session after %.2f s\n",
                        isGround ? "ground" : "vehicle", static_cast<unsigned long long>(every),
                        static_cast<double>(now - start) / 1e6);
            run(15'000'000);
            EXPECT_TRUE(bothUp());
        }
}

// The ground reads its serial line in portions. Right before each frame for the ground, the
// attacker sends bytes in which each portion seems to end with a frame of the handshake.
TEST_P(Hindered, FramesThatSeemToEndWithEachPortionPreventNoSession) {
    const auto hostile = [this](size_t count, size_t portion) {
        Bytes bytes(count, 0x70);
        std::vector<bool> isSet(count);
        const auto put = [&](size_t at, const Bytes& part) {
            for (size_t i = 0; i < part.size(); ++i)
                bytes[at + i] = part[i], isSet[at + i] = true;
        };
        const auto isFree = [&](size_t at, size_t size) {
            return at + size <= count &&
                   std::find(isSet.begin() + long(at), isSet.begin() + long(at + size), true) ==
                       isSet.begin() + long(at + size);
        };
        const U8* nonce = a.link()->session.handshake.nonce;
        constexpr size_t answer = LINK_SECURE_OVERHEAD + LINK_ANSWER_BYTES,
                         hello = LINK_SECURE_OVERHEAD + LINK_NONCE_BYTES;
        for (size_t end = (count + answer) / portion * portion; end > answer; end -= portion)
            if (const size_t at = end - answer;
                isFree(at, LINK_HEADER) && isFree(at + 11, LINK_NONCE_BYTES)) {
                put(at, {LINK_CONTROL | (answer - LINK_OVERHEAD), LINK_VERSION,
                         LINK_KIND_BITS(LINK_KIND_HELLO_ACK)});
                put(at + 11, Bytes(nonce, nonce + LINK_NONCE_BYTES));
            }
        for (size_t end = (count + hello) / portion * portion; end > hello; end -= portion)
            if (isFree(end - hello, LINK_HEADER))
                put(end - hello, {LINK_CONTROL | (hello - LINK_OVERHEAD), LINK_VERSION,
                                  LINK_KIND_BITS(LINK_KIND_HELLO)});
        return bytes;
    };
    for (bool bothCall : {false, true})
        for (size_t portion : {1, 4, 8, 16, 31})
            for (size_t count : {200, 400}) {
                a.boot(), b.boot();
                a.start();
                if (bothCall)
                    b.start();
                const uint64_t start = now;
                while (!bothUp() && now - start < 30'000'000) {
                    now += 1000;
                    a.poll(), b.poll();
                    while (!a.air.empty() && a.air.front().arrives <= now) {
                        b.receive(a.air.front().bytes);
                        a.air.pop_front();
                    }
                    if (b.air.empty() || b.air.front().arrives > now)
                        continue;
                    Bytes line = hostile(count / portion * portion, portion);
                    line.insert(line.end(), b.air.front().bytes.begin(), b.air.front().bytes.end());
                    b.air.pop_front();
                    for (size_t at = 0; at < line.size(); at += portion) {
                        const size_t end = std::min(at + portion, line.size());
                        now += (end - at) * 90;
                        a.receive({line.begin() + long(at), line.begin() + long(end)});
                    }
                }
                EXPECT_TRUE(bothUp()) << (bothCall ? "both call, " : "the ground calls, ") << count
                                      << " bytes, portions of " << portion;
                run(200'000);
            }
}

INSTANTIATE_TEST_SUITE_P(Vehicles, Attacked, ::testing::ValuesIn(keyed(2)));
INSTANTIATE_TEST_SUITE_P(Vehicles, Hindered, ::testing::ValuesIn(keyed(2)));

// Two parties that meet over the air; both have the key.
struct Meeting {
    U32 sideA, sideB;
    bool isOfSides; // true if the parties are a ground station and its vehicle
};

void PrintTo(const Meeting& m, std::ostream* out) {
    *out << std::hex << m.sideA << "_" << m.sideB;
}

class Meetings : public ::testing::TestWithParam<Meeting>, public LinkPair {
protected:
    Meetings()
        : LinkPair(testSeed(), Bytes(LINK_KEY_BYTES, 0x5A), loadLayer("full"), loadLayer("full"),
                   GetParam().sideA, GetParam().sideB) {}
};

TEST_P(Meetings, OnlyAGroundAndItsVehicleBeginASession) {
    b.start();
    EXPECT_EQ(connect(), GetParam().isOfSides);
}

constexpr U32 ground1 = LINK_GROUND | 1;
INSTANTIATE_TEST_SUITE_P(All, Meetings,
                         ::testing::Values(Meeting{ground1, 1, true}, Meeting{1, ground1, true},
                                           Meeting{ground1, ground1, false},
                                           Meeting{ground1, 2, false}, Meeting{1, 1, false}));

// ---- calls to all vehicles ----

TEST(Broadcasts, AreAcceptedOnceUnderTheGroupKeyIfNoBitIsWrong) {
    const Bytes text = {'r', 'e', 't', 'u', 'r', 'n'}, key(LINK_KEY_BYTES, 0x5A);
    Bytes packet(LINK_MAX_FRAME, 0x77);
    std::copy(text.begin(), text.end(), packet.begin() + LINK_BROADCAST_HEAD);
    packet.resize(Link_sealBroadcast(packet.data(), U32(text.size()), key.data(), 0x01020304));
    EXPECT_EQ(packet.size(), text.size() + LINK_BROADCAST_OVERHEAD);
    EXPECT_EQ(std::search(packet.begin(), packet.end(), text.begin(), text.end()), packet.end());
    const auto open = [](Bytes copy, const Bytes& with, U32 newest) {
        const auto from = copy.begin() + LINK_BROADCAST_HEAD;
        return Bytes(from,
                     from + Link_openBroadcast(copy.data(), U32(copy.size()), with.data(), newest));
    };
    EXPECT_EQ(open(packet, key, 0x01020303), text);
    for (U32 newest : {0x01020304u, 0x01020305u, 0xFFFFFFFFu})
        EXPECT_TRUE(open(packet, key, newest).empty()) << newest;
    EXPECT_TRUE(open(packet, Bytes(LINK_KEY_BYTES), 0).empty())
        << "a packet with another key must be refused";
    for (size_t bit = 0; bit < 8 * packet.size(); ++bit) {
        Bytes wrong = packet;
        wrong[bit / 8] ^= static_cast<uint8_t>(1u << bit % 8);
        EXPECT_TRUE(open(wrong, key, 0).empty()) << bit;
    }
    for (size_t cut = LINK_BROADCAST_HEAD; cut < packet.size(); ++cut)
        EXPECT_TRUE(open({packet.begin(), packet.begin() + long(cut)}, key, 0).empty()) << cut;
}

} // namespace
