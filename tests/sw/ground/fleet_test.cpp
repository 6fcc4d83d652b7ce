// SPDX-License-Identifier: MIT
//
// fleet_test: several vehicles on one modem of the ground.

#include "engine.h"
#include "hearer.h"
#include "wire.h"
#include <gtest/gtest.h>
#include <map>

namespace {

// A vehicle that answers a message with its first bytes, and its address as their last byte.
class Vehicle {
public:
    Vehicle(Rig& rig, int address) : rig_(rig), address_(address), random_(address) {
        XBee::Options options;
        options.name = "vehicle " + std::to_string(address);
        options.set = {{"BD", 7}, {"MY", static_cast<uint32_t>(address)}, {"DL", 0}};
        modem = std::make_unique<XBee>(line_, rig.air, options);
        static const Link_Port port = {
            [](void* c, const U8* f, U32 n) {
                self(c).line_.send({f, f + n}, self(c).rig_.ns());
                return 0;
            },
            [](void* c) { return self(c).random_.next(); },
            [](void* c, int channel, const U8* d, U32 n) { return self(c).take(channel, d, n); },
            [](void*, int, int) {},
            [](void*, Link_State) {},
            nullptr,
            nullptr};
        Link_init(link.get(), &port, this, 1440);
    }
    void step() {
        modem->advance(rig_.ns());
        if (!line_.received.empty())
            Link_receive(link.get(), line_.received.data(), static_cast<U32>(line_.received.size()),
                         rig_.us());
        line_.received.clear();
        Link_poll(link.get(), rig_.us());
    }

    std::unique_ptr<XBee> modem;
    std::unique_ptr<Link> link{new Link};
    size_t bytes = 0; // of messages that came

private:
    static Vehicle& self(void* c) { return *static_cast<Vehicle*>(c); }
    int take(int channel, const U8* data, U32 size) {
        Bytes answer = message(data[size - 1], 30);
        answer.back() = static_cast<uint8_t>(address_);
        if (Link_send(link.get(), channel, answer.data(), 30, 0) == LINK_FULL)
            return 1;
        bytes += size;
        return 0;
    }

    Rig& rig_;
    const int address_;
    Random random_;
    HostLine line_;
};

class FleetTest : public ::testing::Test {
protected:
    FleetTest() {
        rig_.with([&] {
            rig_.uav->power(false, rig_.ns()); // this file's vehicles are its own
            rig_.step = [this] {
                for (auto& [address, vehicle] : vehicles_)
                    vehicle->step();
                for (auto& hearer : hearers_)
                    hearer->step();
            };
        });
    }
    ~FleetTest() override {
        rig_.with([&] { rig_.step = nullptr; });
    }
    void fly(int address) {
        rig_.with([&] { vehicles_[address] = std::make_unique<Vehicle>(rig_, address); });
    }
    // `device`: of another ground.
    std::shared_ptr<XBeeAT::Peer> peer(int address, XBeeAT::LinkKeys keys = {},
                                       const std::string& device = "") {
        XBeeAT::Settings s;
        s.device = device.empty() ? rig_.pty.path() : device;
        s.guardMs = Rig::guardMs;
        s.target = address;
        s.isApi = isApi_;
        s.keys = keys;
        s.quarters = quarters_;
        return XBeeAT::Engine::get(s, [this](int level, const std::string& text) {
            std::lock_guard<std::mutex> lock(logMutex_);
            log_ += std::to_string(level) + " " + text + "\n";
        });
    }
    std::string log() {
        std::lock_guard<std::mutex> lock(logMutex_);
        return log_;
    }
    // A call, whose answer says which vehicle has it.
    int answerer(int fd) {
        writeAll(fd, message(1));
        const Bytes answer = rig_.read(fd, 30);
        return answer.empty() ? -1 : answer.back();
    }
    // Seconds of simulated time in which the vehicles take so many bytes, all programs writing as
    // much as is taken.
    double secondsFor(const std::vector<int>& fds, size_t bytes) {
        std::atomic<bool> stop{false};
        std::vector<std::thread> programs;
        for (int fd : fds)
            programs.emplace_back([fd, &stop] {
                const Bytes m = message(1, 900);
                while (!stop) {
                    writeAll(fd, m);
                    U8 sink[4096];
                    (void)!recv(fd, sink, sizeof sink, MSG_DONTWAIT);
                }
            });
        const auto taken = [this] {
            size_t sum = 0;
            for (auto& [address, vehicle] : vehicles_)
                sum += vehicle->bytes;
            return sum;
        };
        const size_t from = rig_.with(taken);
        const uint64_t begun = rig_.with([&] { return rig_.ns(); });
        EXPECT_TRUE(rig_.until([&] { return taken() >= from + bytes; }, 300)) << log();
        const double seconds = double(rig_.with([&] { return rig_.ns(); }) - begun) / 1e9;
        stop = true;
        for (int fd : fds)
            shutdown(fd, SHUT_RDWR);
        for (std::thread& program : programs)
            program.join();
        return seconds;
    }

    bool isApi_ = true;
    std::mutex logMutex_;
    std::string log_;
    Rig rig_{testSeed()};
    std::map<int, std::unique_ptr<Vehicle>> vehicles_;
    std::vector<std::unique_ptr<Hearer>> hearers_; // of calls to all vehicles
    std::function<int64_t()> quarters_ = XBeeAT::Settings().quarters;
};

TEST_F(FleetTest, EachVehicleAnswersItsOwnCallsUnderItsOwnKey) {
    const std::map<int, XBeeAT::LinkKeys> keys = {{1, {{{1}}}}, {2, {}}, {0x0102, {{{2}}}}};
    std::map<int, std::shared_ptr<XBeeAT::Peer>> peers;
    std::map<int, int> fds;
    for (const auto& [address, key] : keys) {
        fly(address);
        if (!key.empty())
            rig_.with([&, address = address, &key = key] {
                Link_setKey(vehicles_[address]->link.get(), 0, key[0].data(),
                            static_cast<U32>(address));
            });
        peers[address] = peer(address, key);
        fds[address] = peers[address]->connect(-1);
    }
    for (int turn = 0; turn < 3; ++turn)
        for (const auto& [address, fd] : fds)
            EXPECT_EQ(answerer(fd), address & 0xFF) << log();
    EXPECT_NE(log().find("1 0x0102: link up, secure"), std::string::npos) << log();
    EXPECT_THROW(peer(2, keys.at(1)), std::system_error) << "another key for the same vehicle";
    for (const auto& [address, fd] : fds)
        close(fd);
}

TEST_F(FleetTest, VehiclesShareTheAirAlikeAndOneThatIsAwayCostsTheOthersLittle) {
    std::vector<std::shared_ptr<XBeeAT::Peer>> peers;
    std::vector<int> fds;
    for (int address : {1, 2, 3}) {
        fly(address);
        peers.push_back(peer(address));
        fds.push_back(peers.back()->connect(-1));
        EXPECT_EQ(answerer(fds.back()), address) << log();
    }
    rig_.with([&] {
        for (auto& [address, vehicle] : vehicles_)
            vehicle->bytes = 0;
    });
    const double together = secondsFor(fds, 60'000);
    rig_.with([&] {
        for (auto& [address, vehicle] : vehicles_)
            EXPECT_NEAR(double(vehicle->bytes), 20'000, 2'000) << address;
    });
    std::printf("fleet: three vehicles take %.0f bytes/s\n", 60'000 / together);
    for (int fd : fds)
        close(fd);
    rig_.with([&] { vehicles_[2]->modem->power(false, rig_.ns()); });
    const auto isSought = [&] {
        return log().rfind("0x0002: link connecting") > log().rfind("0x0002: link up");
    };
    ASSERT_TRUE(rig_.until(isSought));
    const uint64_t since = rig_.with([&] { return rig_.ns(); });
    const auto passed = [&](uint64_t ns) {
        return rig_.until([&] { return rig_.ns() - since > ns; });
    };
    ASSERT_TRUE(passed(4'500'000'000)); // the first HELLOs follow one another sooner
    const uint64_t before = rig_.with([&] { return rig_.air.counters().airNs; });
    ASSERT_TRUE(passed(12'500'000'000));
    const double share =
        double(rig_.with([&] { return rig_.air.counters().airNs; }) - before) / 8e9;
    std::printf("fleet: one that is away takes %.2f %% of the air\n", 100 * share);
    EXPECT_LT(share, 0.02);
    EXPECT_GT(share, 0.0001) << "it is sought";
}

TEST_F(FleetTest, OneThatComesWhileOthersAreCalledAtFullRateIsServedSoon) {
    std::vector<std::shared_ptr<XBeeAT::Peer>> peers;
    std::vector<int> fds;
    for (int address : {1, 2, 3}) {
        if (address < 3)
            fly(address);
        peers.push_back(peer(address));
        fds.push_back(peers.back()->connect(-1));
    }
    EXPECT_EQ(answerer(fds[0]), 1) << log();
    EXPECT_EQ(answerer(fds[1]), 2) << log();
    uint64_t cameAt = 0;
    std::thread late([&] {
        rig_.until([&] { return vehicles_[1]->bytes > 4'000; });
        fly(3);
        cameAt = rig_.with([&] { return rig_.ns(); });
        EXPECT_EQ(answerer(fds[2]), 3) << log();
        cameAt = rig_.with([&] { return rig_.ns(); }) - cameAt;
    });
    secondsFor({fds[0], fds[1]}, 50'000);
    late.join();
    EXPECT_LT(double(cameAt) / 1e9, 3.5);
    close(fds[2]);
}

TEST_F(FleetTest, AnotherOfOneAddressABabblerAndAChangeOfKeysDisturbNobodyElse) {
    const XBeeAT::LinkKeys present = {{{1}}}, next = {{{9}}}, others = {{{2}}};
    const auto give = [this](int place, int slot, const XBeeAT::LinkKey* key) {
        rig_.with([&] {
            Link_setKey(vehicles_[place]->link.get(), slot, key ? key->data() : nullptr,
                        static_cast<U32>(place == 2 ? 2 : 1));
        });
    };
    fly(1);
    give(1, 0, &present[0]);
    fly(2);
    give(2, 0, &others[0]);
    auto one = peer(1, {next[0], present[0]}), two = peer(2, others);
    const int first = one->connect(-1), second = two->connect(-1);
    EXPECT_EQ(answerer(first), 1) << log();
    EXPECT_EQ(answerer(second), 2) << log();

    give(1, 1, &next[0]);
    give(1, 0, nullptr); // its session ends, and the next one is under the next key
    EXPECT_EQ(answerer(second), 2) << log();
    const std::string isUp = "0x0001: link up";
    ASSERT_TRUE(rig_.until([&] { return log().find(isUp) != log().rfind(isUp); })) << log();
    const int again = one->connect(-1);
    EXPECT_EQ(answerer(again), 1) << log();

    HostLine line;
    XBee::Options options;
    options.set = {{"BD", 7}, {"MY", 3}, {"DL", 0}};
    XBee babbler(line, rig_.air, options);
    Random random(testSeed());
    rig_.with([&] {
        vehicles_[101] = std::make_unique<Vehicle>(rig_, 1);
        Link_start(vehicles_[101]->link.get(), rig_.us());
        rig_.step = [&, at = uint64_t(0), step = rig_.step]() mutable {
            step();
            babbler.advance(rig_.ns());
            if (rig_.ns() < at)
                return;
            at = rig_.ns() + 40'000'000;
            Bytes words(90);
            for (auto& byte : words)
                byte = static_cast<uint8_t>(random.next());
            line.send(words, rig_.ns());
        };
    });
    give(101, 0, &others[0]);
    for (int call = 0; call < 20; ++call)
        EXPECT_EQ(answerer(second), 2) << log();
    rig_.with([&] {
        EXPECT_EQ(Link_statistics(vehicles_[2]->link.get())->sessions, 1u);
        EXPECT_EQ(Link_statistics(vehicles_[101]->link.get())->sessions, 0u);
        rig_.step = [this] {
            for (auto& [address, vehicle] : vehicles_)
                vehicle->step();
        };
    });
    for (int fd : {first, again, second})
        close(fd);
}

// Two grounds with one address and, where the links have keys, one key.
class TwinGrounds : public FleetTest, public ::testing::WithParamInterface<XBeeAT::LinkKeys> {};

TEST_P(TwinGrounds, TheNewerOneKeepsTheVehicleAndTheOlderOneHasItAgainAfterIt) {
    PtyLine pty;
    XBee::Options options;
    options.set = {{"GT", Rig::guardMs}, {"D6", 1}};
    XBee modem(pty, rig_.air, options);
    fly(1);
    rig_.with([&] {
        Link* link = vehicles_[1]->link.get();
        if (!GetParam().empty())
            Link_setKey(link, 0, GetParam()[0].data(), 1);
        Link_start(link, rig_.us());
        rig_.step = [&, step = rig_.step] {
            step();
            modem.advance(rig_.ns());
        };
    });
    const auto sessions = [&] { return Link_statistics(vehicles_[1]->link.get())->sessions; };
    auto older = peer(1, GetParam());
    const int before = older->connect(-1);
    EXPECT_EQ(answerer(before), 1) << log();
    auto newer = peer(1, GetParam(), pty.path());
    const int fd = newer->connect(-1);
    EXPECT_EQ(answerer(fd), 1) << log();
    EXPECT_TRUE(rig_.read(before, 1).empty()) << "the older one's connection ends";
    const unsigned made = rig_.with(sessions);
    for (int second = 0; second < 6; ++second) {
        const uint64_t end = rig_.with([&] { return rig_.ns(); }) + 1'000'000'000;
        ASSERT_TRUE(rig_.until([&] { return rig_.ns() >= end; }));
        EXPECT_EQ(answerer(fd), 1) << log();
        errno = 0;
        EXPECT_EQ(older->connect(-1), -1);
        EXPECT_EQ(errno, EBUSY);
    }
    EXPECT_EQ(rig_.with(sessions), made) << log();
    const std::string why = "another ground with this one's address has the vehicle";
    EXPECT_EQ(log().find(why), log().rfind(why)) << log();
    EXPECT_NE(log().find(why), std::string::npos) << log();
    newer.reset();
    close(fd);
    ASSERT_TRUE(rig_.until([&] { return sessions() > made; })) << log();
    const int after = older->connect(-1);
    EXPECT_EQ(answerer(after), 1) << log();
    for (int end : {before, after})
        close(end);
    rig_.with([&] { rig_.step = nullptr; });
}

INSTANTIATE_TEST_SUITE_P(Fleet, TwinGrounds,
                         ::testing::Values(XBeeAT::LinkKeys{{{1}}}, XBeeAT::LinkKeys{}));

TEST_F(FleetTest, AModemWithoutApiModeTalksToOneVehicle) {
    isApi_ = false;
    fly(1);
    fly(2);
    auto one = peer(1), two = peer(2);
    const int fd = one->connect(-1);
    EXPECT_EQ(answerer(fd), 1) << log();
    const int other = two->connect(-1);
    EXPECT_EQ(answerer(other), -1);
    EXPECT_NE(log().find("has no API mode: it talks to one vehicle only"), std::string::npos);
    EXPECT_EQ(answerer(fd), 1);
    close(fd);
    close(other);
}

TEST_F(FleetTest, AModemServesAsManyVehiclesAsItMay) {
    std::vector<std::shared_ptr<XBeeAT::Peer>> peers;
    for (int address = 1; address <= int(XBeeAT::mostPeers); ++address)
        peers.push_back(peer(address));
    EXPECT_THROW(peer(99), std::system_error);
    EXPECT_NO_THROW(peer(1));
    fly(7);
    const int fd = peers[6]->connect(-1);
    EXPECT_EQ(answerer(fd), 7) << log();
    close(fd);
}

// ---- calls to all vehicles ----

const XBeeAT::LinkKey groupKey = {7, 7, 7};

// A call of so many bytes in Ice's framing; `id`: 0 oneway; `type`: 1 batch, 4 goodbye.
Bytes callOf(uint8_t tag, uint8_t id = 0, size_t size = 40, uint8_t type = 0) {
    Bytes m = message(tag, size);
    m[8] = type;
    for (size_t at = 14; at < 18 && at < size; ++at)
        m[at] = at == 14 ? id : 0;
    return m;
}

// Five hearers, of whom the last has another key, and programs that call all vehicles.
class BroadcastTest : public FleetTest {
protected:
    BroadcastTest() {
        rig_.with([&] {
            for (int address = 1; address <= 5; ++address)
                hearers_.push_back(std::make_unique<Hearer>(
                    rig_, address, address == 5 ? XBeeAT::LinkKey{1} : groupKey));
        });
    }
    // What is read after these messages, until the connection ends, which it does when what was
    // sent is on the air; without the greeting.
    std::string say(const std::vector<Bytes>& messages) {
        auto all = peer(0xFFFF, {groupKey});
        const int fd = all->connect(-1);
        (void)rig_.read(fd, 14);
        for (const Bytes& m : messages)
            writeAll(fd, m);
        const Bytes answer = rig_.read(fd, 4096);
        close(fd);
        const uint64_t end = rig_.with([&] { return rig_.ns(); }) + 600'000'000;
        EXPECT_TRUE(rig_.until([&] { return rig_.ns() >= end; }));
        return {answer.begin(), answer.end()};
    }
    const Bytes goodbye = callOf(0, 0, 14, 4);
};

TEST_F(BroadcastTest, EachVehicleTakesACallOnceInOrderAndNoneThatIsRecordedOrChanged) {
    fly(9);
    auto one = peer(9);
    const int fd = one->connect(-1);
    EXPECT_EQ(answerer(fd), 9) << log();
    std::vector<Bytes> calls;
    for (uint8_t call = 1; call <= 25; ++call)
        calls.push_back(callOf(call));
    calls.push_back(goodbye);
    rig_.with([&] { rig_.air.weather.loss = 0.3; });
    say(calls);
    rig_.with([&] {
        rig_.air.weather.loss = 0;
        for (size_t h = 0; h < 4; ++h) {
            const auto& heard = hearers_[h]->calls;
            EXPECT_GE(heard.size(), 23u) << "five copies miss once in 400";
            EXPECT_TRUE(std::includes(calls.begin(), calls.end(), heard.begin(), heard.end()));
            EXPECT_GT(hearers_[h]->packets.size(), 2 * heard.size());
        }
        EXPECT_TRUE(hearers_[4]->calls.empty()) << "it has another key";
        for (auto& hearer : hearers_)
            hearer->calls.clear();
        const Bytes last = hearers_[4]->packets.back();
        hearers_[4]->say(last);
        for (size_t at : {size_t(1), size_t(9), size_t(20), last.size() - 1}) {
            Bytes changed = last;
            changed[at] ^= 0x80;
            hearers_[4]->say(changed);
        }
    });
    say({callOf(26), goodbye});
    rig_.with([&] {
        for (size_t h = 0; h < 4; ++h)
            EXPECT_EQ(hearers_[h]->calls, std::vector<Bytes>{callOf(26)});
        EXPECT_EQ(Link_statistics(vehicles_[9]->link.get())->sessions, 1u) << "it hears them, too";
    });
    EXPECT_EQ(answerer(fd), 9) << log();
    close(fd);
}

TEST_F(BroadcastTest, WhatCannotGoToAllIsRefusedAtOnceInWords) {
    EXPECT_NE(say({callOf(1, 5), goodbye}).find("use a oneway proxy"), std::string::npos) << log();
    say({callOf(1, 0, 80)});
    EXPECT_NE(log().find("the packet to all vehicles (at most 79)"), std::string::npos) << log();
    say({callOf(1, 0, 40, 1)});
    EXPECT_NE(log().find("sent a batch"), std::string::npos) << log();
    quarters_ = [] { return int64_t(-1); };
    say({callOf(1)});
    EXPECT_NE(log().find("the clock of this machine is not set"), std::string::npos) << log();
    isApi_ = false;
    say({callOf(1)});
    EXPECT_NE(log().find("has no API mode"), std::string::npos) << log();
    EXPECT_TRUE(rig_.with([&] { return hearers_[0]->packets.empty(); }));
}

} // namespace
