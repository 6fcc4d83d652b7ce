// SPDX-License-Identifier: MIT
//
// fleet_test: tests several vehicles that are reached over one modem of the ground, and calls to
// all of them.

#include "../../support/delivery_check.h"
#include "engine.h"
#include "rig.h"
#include "wire.h"
#include <gtest/gtest.h>
#include <list>
#include <map>

extern "C" {
#include "link_broadcast.h"
}

namespace {

using XBeeAT::LinkKeys;

// A program that is connected to a vehicle.
struct Program {
    explicit Program(std::shared_ptr<XBeeAT::Peer> of) : peer(std::move(of)) {}
    ~Program() { close(fd); }
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;
    std::shared_ptr<XBeeAT::Peer> peer;
    const int fd = peer->connect(-1);
};

// A vehicle that receives the calls to all vehicles; its modem is in API mode.
class Hearer {
public:
    Hearer(Rig& rig, int address, const XBeeAT::LinkKey& key) : rig_(rig), key_(key) {
        XBee::Options options;
        options.set = {{"BD", 7}, {"MY", static_cast<uint32_t>(address)}, {"AP", 1}};
        modem_ = std::make_unique<XBee>(line_, rig.air, options);
    }
    void step() {
        modem_->advance(rig_.ns());
        frames_.feed(
            line_.received.data(), line_.received.size(),
            [this](int, const uint8_t* data, size_t size) { take({data, data + size}); },
            [](const Rig::Bytes&) {});
        line_.received.clear();
    }

    // packets that were received, and calls in them that the vehicle must execute
    std::vector<Rig::Bytes> packets, calls;

private:
    void take(Rig::Bytes packet) {
        packets.push_back(packet);
        const U32 size =
            Link_openBroadcast(packet.data(), U32(packet.size()), key_.data(), newest_);
        newest_ = size ? LINK_BROADCAST_NUMBER(packet.data()) : newest_;
        const auto from = packet.begin() + LINK_BROADCAST_HEAD;
        if (size)
            calls.emplace_back(from, from + size);
    }
    Rig& rig_;
    XBeeAT::LinkKey key_;
    HostLine line_;
    std::unique_ptr<XBee> modem_;
    XBeeAT::ApiFrames frames_;
    U32 newest_ = 0;
};

class FleetTest : public ::testing::Test {
protected:
    FleetTest() {
        settings_.device = rig_.pty.path();
        settings_.guardMs = Rig::guardMs;
        rig_.setHurried(true);
        rig_.with([&] {
            // the test adds other vehicles, so the vehicle of the rig is switched off
            rig_.uav.modem->power(false, rig_.ns());
            rig_.step = [this] {
                for (auto& [place, vehicle] : vehicles_)
                    vehicle->advance(rig_.ns());
                for (auto& hearer : hearers_)
                    hearer.step();
            };
        });
    }
    ~FleetTest() override {
        rig_.with([&] { rig_.step = nullptr; });
    }
    // Adds a vehicle. It answers each message with a message of 30 bytes. The answer is filled with
    // the last byte of the received message, and ends with the vehicle's own address. `place` is
    // the vehicle's index in `vehicles_` if another vehicle has the same address.
    void fly(int address, const LinkKeys& keys = {}, int place = 0) {
        rig_.with([&] {
            auto& v = vehicles_[place ? place : address];
            v = std::make_unique<Uav>(rig_.air, address, static_cast<uint64_t>(address));
            if (!keys.empty())
                Link_setKey(v->link(), 0, keys[0].data(), static_cast<U32>(address));
            v->taking = [this, link = v->link(), address](int channel, const U8* data, U32 size) {
                Bytes answer = message(data[size - 1], 30);
                answer.back() = static_cast<uint8_t>(address);
                if (Link_send(link, channel, answer.data(), 30, 0) == LINK_FULL)
                    return 1;
                taken_[address] += size;
                return 0;
            };
        });
    }
    std::shared_ptr<XBeeAT::Peer> peer(int address, const LinkKeys& keys = {}) {
        XBeeAT::Settings s = settings_;
        s.target = address;
        s.keys = keys;
        return XBeeAT::Engine::get(s, log_.taker());
    }
    unsigned sessions(int place) {
        return rig_.with([&] { return vehicles_[place]->sessions(); });
    }
    // Makes a call, and checks which vehicle replies; -1 means that none may reply.
    void answers(int fd, int vehicle) {
        writeAll(fd, message(1));
        const Bytes answer = rig_.read(fd, 30);
        EXPECT_EQ(answer.empty() ? -1 : answer.back(), vehicle) << log_.text();
    }
    size_t taken() const {
        size_t sum = 0;
        for (auto& [address, bytes] : taken_)
            sum += bytes;
        return sum;
    }
    // Lets all programs write as much as possible, and returns the simulated seconds until the
    // vehicles have received this number of bytes. Then ends the connections.
    double secondsFor(const std::list<Program>& programs, size_t bytes) {
        std::atomic<bool> stop{false};
        std::list<std::thread> writers;
        for (const Program& program : programs)
            writers.emplace_back([fd = program.fd, &stop] {
                const Bytes m = message(1, 900);
                while (!stop) {
                    writeAll(fd, m);
                    U8 sink[4096];
                    (void)!recv(fd, sink, sizeof sink, MSG_DONTWAIT);
                }
            });
        const double begun = rig_.seconds();
        rig_.with([&] { taken_.clear(); });
        EXPECT_TRUE(rig_.until([&] { return taken() >= bytes; }, 300)) << log_.text();
        const double seconds = rig_.seconds() - begun;
        stop = true;
        for (const Program& program : programs)
            shutdown(program.fd, SHUT_RDWR);
        for (std::thread& writer : writers)
            writer.join();
        return seconds;
    }

    EngineLog log_;
    XBeeAT::Settings settings_;
    Rig rig_{testSeed()};
    std::map<int, size_t> taken_; // number of received bytes, by vehicle address
    std::map<int, std::unique_ptr<Uav>> vehicles_;
    std::list<Hearer> hearers_; // vehicles that receive the calls to all vehicles
    std::list<Program> programs_;
};

TEST_F(FleetTest, EachVehicleAnswersItsCallsUnderItsKey) {
    const std::map<int, LinkKeys> keys = {{1, {{{1}}}}, {2, {}}, {0x0102, {{{2}}}}};
    std::map<int, Program> programs;
    for (const auto& [address, key] : keys) {
        fly(address, key);
        programs.try_emplace(address, peer(address, key));
    }
    for (int turn = 0; turn < 3; ++turn)
        for (const auto& [address, program] : programs)
            answers(program.fd, address & 0xFF);
    EXPECT_TRUE(log_.has("1 0x0102: link up, secure")) << log_.text();
    EXPECT_THROW(peer(2, keys.at(1)), std::system_error)
        << "another key for the same vehicle must be refused";
}

TEST_F(FleetTest, VehiclesShareTheAirEquallyAndAnAbsentOneCostsLittle) {
    for (int address : {1, 2, 3}) {
        fly(address);
        answers(programs_.emplace_back(peer(address)).fd, address);
    }
    const double together = secondsFor(programs_, 60'000);
    for (const auto& [address, bytes] : rig_.with([&] { return taken_; }))
        EXPECT_NEAR(double(bytes), 20'000, 2'000) << address;
    std::printf("fleet: three vehicles take %.0f bytes/s\n", 60'000 / together);
    rig_.with([&] { vehicles_[2]->modem->power(false, rig_.ns()); });
    const auto isSought = [&] {
        const std::string log = log_.text();
        return log.rfind("0x0002: link connecting") > log.rfind("0x0002: link up");
    };
    ASSERT_TRUE(rig_.until(isSought));
    rig_.pass(4.5); // waits, because the first HELLOs are sent at shorter intervals
    const auto airNs = [&] { return double(rig_.air.counters().airNs); };
    const double before = rig_.with(airNs);
    rig_.pass(8);
    const double share = (rig_.with(airNs) - before) / 8e9;
    std::printf("fleet: one that is away takes %.2f %% of the air\n", 100 * share);
    EXPECT_LT(share, 0.02);
    EXPECT_GT(share, 0.0001) << "the engine must search for the vehicle that is away";
}

TEST_F(FleetTest, AnArrivingVehicleIsServedSoonUnderFullLoad) {
    for (int address : {1, 2}) {
        fly(address);
        answers(programs_.emplace_back(peer(address)).fd, address);
    }
    const Program third(peer(3));
    double took = 0;
    std::thread late([&] {
        rig_.until([&] { return taken_[1] > 4'000; });
        fly(3);
        const double cameAt = rig_.seconds();
        answers(third.fd, 3);
        took = rig_.seconds() - cameAt;
    });
    secondsFor(programs_, 50'000);
    late.join();
    EXPECT_LT(took, 3.5);
}

TEST_F(FleetTest, FaultyVehiclesDoNotDisturbOthers) {
    const LinkKeys present = {{{1}}}, next = {{{9}}}, others = {{{2}}};
    fly(1, present);
    fly(2, others);
    auto one = peer(1, {next[0], present[0]});
    const Program first(one), second(peer(2, others));
    answers(first.fd, 1);
    answers(second.fd, 2);

    rig_.with([&] { // ends the session; the next session uses the next key
        Link_setKey(vehicles_[1]->link(), 1, next[0].data(), 1);
        Link_setKey(vehicles_[1]->link(), 0, nullptr, 1);
    });
    answers(second.fd, 2);
    ASSERT_TRUE(rig_.until([&] { return vehicles_[1]->sessions() == 2; })) << log_.text();
    answers(Program(one).fd, 1);

    fly(1, others, 101);
    HostLine line;
    XBee::Options options;
    options.set = {{"BD", 7}, {"MY", 3}, {"DL", 0}};
    XBee babbler(line, rig_.air, options);
    Random random(testSeed());
    const auto step = rig_.step;
    rig_.with([&] {
        Link_start(vehicles_[101]->link(), rig_.us());
        rig_.step = [&, at = uint64_t(0)]() mutable {
            step();
            babbler.advance(rig_.ns());
            if (rig_.ns() < at)
                return;
            at = rig_.ns() + 40'000'000;
            line.send(random.items<uint8_t>(90), rig_.ns());
        };
    });
    for (int call = 0; call < 20; ++call)
        answers(second.fd, 2);
    rig_.with([&] { rig_.step = step; });
    EXPECT_EQ(sessions(2), 1u);
    EXPECT_EQ(sessions(101), 0u);
}

// Tests two ground stations with the same address and, if the links have keys, with the same key.
class TwinGrounds : public FleetTest, public ::testing::WithParamInterface<LinkKeys> {};

TEST_P(TwinGrounds, TheNewerGroundKeepsTheVehicleUntilItEnds) {
    rig_.placeOther(rig_.air);
    fly(1, GetParam());
    rig_.with([&] { Link_start(vehicles_[1]->link(), rig_.us()); });
    const auto older = peer(1, GetParam());
    const Program before(older);
    answers(before.fd, 1);
    settings_.device = rig_.otherPty.path();
    auto newer = std::make_unique<Program>(peer(1, GetParam()));
    answers(newer->fd, 1);
    EXPECT_TRUE(rig_.read(before.fd, 1).empty()) << "the connection of the older program must end";
    const unsigned made = sessions(1);
    for (int second = 0; second < 6; ++second) {
        rig_.pass(1);
        answers(newer->fd, 1);
        errno = 0;
        EXPECT_EQ(older->connect(-1), -1);
        EXPECT_EQ(errno, EBUSY);
    }
    EXPECT_EQ(sessions(1), made) << log_.text();
    const std::string why =
        "another ground station with the same address has connected to the vehicle";
    EXPECT_TRUE(log_.has(why)) << log_.text();
    EXPECT_EQ(log_.text().find(why), log_.text().rfind(why)) << log_.text();
    newer.reset();
    ASSERT_TRUE(rig_.until([&] { return vehicles_[1]->sessions() > made; })) << log_.text();
    answers(Program(older).fd, 1);
}

// A vehicle that loses power in the middle of a frame leaves a truncated frame, which belongs to no
// session.
TEST_P(TwinGrounds, AVehicleThatStopsInMidFrameHasNoOtherGround) {
    fly(1, GetParam());
    const auto ground = peer(1, GetParam());
    const Program before(ground);
    answers(before.fd, 1);
    HostLine line;
    XBee::Options options;
    options.set = {{"BD", 7}, {"MY", 1}, {"DL", 0}};
    XBee dying(line, rig_.air, options);
    const auto step = rig_.step;
    rig_.with([&] {
        vehicles_[1]->modem->power(false, rig_.ns());
        dying.advance(rig_.ns());
        line.send(Bytes(50, 0xFE), rig_.ns());
        rig_.step = [&] {
            step();
            dying.advance(rig_.ns());
        };
    });
    EXPECT_TRUE(rig_.read(before.fd, 1).empty()) << "the connection must end";
    rig_.pass(1);
    rig_.with([&] {
        rig_.step = step;
        vehicles_[1]->modem->power(true, rig_.ns());
    });
    const Program after(ground);
    ASSERT_NE(after.fd, -1) << log_.text();
    answers(after.fd, 1);
}

INSTANTIATE_TEST_SUITE_P(Fleet, TwinGrounds, ::testing::Values(LinkKeys{{{1}}}, LinkKeys{}));

TEST_F(FleetTest, AModemWithoutApiModeTalksToOneVehicle) {
    settings_.isApi = false;
    fly(1);
    fly(2);
    const Program one(peer(1));
    answers(one.fd, 1);
    answers(Program(peer(2)).fd, -1);
    EXPECT_TRUE(log_.has("has no API mode, so it can reach only one vehicle"));
    answers(one.fd, 1);
}

TEST_F(FleetTest, AModemServesItsMaximumOfVehicles) {
    std::vector<std::shared_ptr<XBeeAT::Peer>> peers;
    for (int address = 1; address <= int(XBeeAT::mostPeers); ++address)
        peers.push_back(peer(address));
    EXPECT_THROW(peer(99), std::system_error);
    EXPECT_NO_THROW(peer(1));
    fly(7);
    answers(Program(peers[6]).fd, 7);
}

// ---- calls to all vehicles ----

const XBeeAT::LinkKey groupKey = {7, 7, 7};

// Returns a call of `size` bytes in Ice's format. `id` 0 makes it one-way; `type` 1 is a batch, 4
// closes the connection.
Bytes callOf(uint8_t tag, uint8_t id = 0, size_t size = 40, uint8_t type = 0) {
    Bytes m = message(tag, size);
    m[8] = type;
    for (size_t at = 14; at < 18 && at < size; ++at)
        m[at] = at == 14 ? id : 0;
    return m;
}

// Tests with five receivers, the last with another key, and with programs that call all
// vehicles.
class BroadcastTest : public FleetTest {
protected:
    BroadcastTest() {
        rig_.with([&] {
            for (int address = 1; address <= 5; ++address)
                hearers_.emplace_back(rig_, address, address == 5 ? XBeeAT::LinkKey{1} : groupKey);
        });
    }
    // Sends messages to all vehicles. Returns the bytes that the program reads until the connection
    // ends, without the greeting. The connection ends when all messages have been sent on the air.
    std::string say(const std::vector<Bytes>& messages) {
        const Program all(peer(XBeeAT::everybody, {groupKey}));
        (void)rig_.read(all.fd, 14);
        for (const Bytes& m : messages)
            writeAll(all.fd, m);
        const Bytes answer = rig_.read(all.fd, 4096);
        rig_.pass(0.6);
        return {answer.begin(), answer.end()};
    }
    const Bytes goodbye = callOf(0, 0, 14, 4);
};

TEST_F(BroadcastTest, EachVehicleExecutesACallOnceAndInOrder) {
    fly(9);
    const Program one(peer(9));
    answers(one.fd, 9);
    std::vector<Bytes> calls;
    for (uint8_t call = 1; call <= 25; ++call)
        calls.push_back(callOf(call));
    calls.push_back(goodbye);
    rig_.with([&] { rig_.air.weather.loss = 0.3; });
    say(calls);
    rig_.with([&] {
        rig_.air.weather.loss = 0;
        for (const Hearer& h : hearers_) {
            DeliveryCheck delivery;
            for (uint32_t call = 0; call < calls.size(); ++call)
                delivery.sent(0, call, calls[call]);
            (void)delivery.forget(0); // broadcasts are not acknowledged, so some calls may be lost
            for (const Bytes& call : h.calls)
                EXPECT_EQ(delivery.arrived(0, call), "");
            EXPECT_GT(h.packets.size(), 2 * h.calls.size());
            if (&h == &hearers_.back())
                EXPECT_TRUE(h.calls.empty()) << "a vehicle with another key must not accept calls";
            else
                EXPECT_GE(h.calls.size(), 23u)
                    << "with five copies, only one call in 400 is missed";
        }
    });
    EXPECT_EQ(sessions(9), 1u) << "calls to all vehicles must not end the session";
    answers(one.fd, 9);
}

TEST_F(BroadcastTest, CallsThatCannotBeBroadcastAreRefusedWithAReason) {
    EXPECT_NE(say({callOf(1, 5), goodbye}).find("use a oneway proxy"), std::string::npos);
    say({callOf(1, 0, 80)});
    EXPECT_TRUE(log_.has("one packet to all vehicles (at most 79)")) << log_.text();
    say({callOf(1, 0, 40, 1)});
    EXPECT_TRUE(log_.has("sent a batch")) << log_.text();
    settings_.quarters = [] { return int64_t(-1); };
    say({callOf(1)});
    EXPECT_TRUE(log_.has("the clock of this machine is not set")) << log_.text();
    settings_.isApi = false;
    say({callOf(1)});
    EXPECT_TRUE(log_.has("has no API mode")) << log_.text();
    EXPECT_TRUE(rig_.with([&] { return hearers_.front().packets.empty(); }));
}

} // namespace
