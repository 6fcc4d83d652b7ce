// SPDX-License-Identifier: MIT
//
// fellow_test: tests vehicles that call each other's objects through IceC's radio endpoint, while
// one of them serves two ground stations. Each vehicle and each ground station has separate links
// and a separate communicator; time is simulated.

#include "link_program.h"
#include "random.h"
#include <deque>
#include <functional>
#include <gtest/gtest.h>
#include <memory>
#include <string>
#include <vector>

extern "C" {
#include "xbee_endpoint.h"
}

namespace {

using Key = std::vector<U8>;
struct Craft;

// All vehicles and ground stations, and the simulated time, which advances while one of them waits.
struct Simulation {
    void step();
    void run(U32 times) {
        while (times--)
            step();
    }
    U32 ms = 0xFFFFFC00u; // the time of the links wraps soon after the start
    std::vector<Craft*> crafts;
    std::function<void()> atStep = [] {};
};

// One of three links, and the packets on their way to it.
struct End : LinkProgram {
    bool transmit(const U8* frame, U32 size) override;
    U32 random() override;
    bool take(int channel, const U8* data, U32 size) override;
    void onChannel(int channel, bool isOpen) override;

    Craft* craft = nullptr;
    int first = 0; // number of the first connection that belongs to this link
    Link link;
    Link_Buffers buffers;
    End* peer = nullptr;
    bool isVehicles = false;
    std::deque<std::pair<U32, Key>> coming; // packets, each with its time of arrival
    unsigned sent = 0;                      // packets
};

// A vehicle or a ground station: a communicator with three links. The last link is as small as a
// vehicle's link to another vehicle.
struct Craft {
    Craft(Simulation& w, U16 address) : world(w), random(testSeed() + w.crafts.size()) {
        static const XBeeATEndpoint_Port port = {
            [](void*) {},
            [](void*) {},
            [](void*) {},
            [](void* c, Ice_Int ms) { return static_cast<Craft*>(c)->wait(ms); },
            [](void* c) { static_cast<Craft*>(c)->isSignalled = true; },
            [](void* c) { return static_cast<Craft*>(c)->world.ms; }};
        for (End& end : ends) {
            end.craft = this;
            end.first = static_cast<int>(&end - ends) * LINK_CHANNELS;
            Link_Config config = {end.linkPort(), end.linkProgram(), 1440, LINK_USE(end.buffers)};
            if (&end == &ends[fellow]) {
                config.sendBytes = 1024;
                config.maxMessage = 512;
                config.window = 4;
            }
            Link_init(&end.link, &config);
        }
        Ice_initialize(&ic);
        XBeeATEndpoint_init(&ic, "xbee-at", &endpoint, &ends[0].link, address, &port, this);
        Ice_Communicator_createObjectAdapterWithEndpoints(&ic, "A", "xbee-at", &adapter);
        Ice_ObjectAdapter_activate(&adapter);
        servant.object.dispatch = [](Ice_ObjectPtr object, const Ice_Current*, Ice_InputStreamPtr,
                                     Ice_OutputStreamPtr) {
            ++reinterpret_cast<Servant*>(object)->calls;
            return ICE_OK;
        };
        Ice_ObjectAdapter_add(&adapter, &servant.object, "it");
        w.crafts.push_back(this);
    }
    // Adds a link to another vehicle, which has this address.
    void meets(Craft& other, U16 address, int place, bool isGround, const Key& key, U32 side) {
        End& end = ends[fellow];
        XBeeATEndpoint_addPeer(&endpoint, fellow, &end.link, address);
        XBeeATEndpoint_setVehicle(&endpoint, fellow, isGround);
        end.isVehicles = true;
        end.peer = &other.ends[place];
        other.ends[place].peer = &end;
        if (!key.empty())
            Link_setKey(&end.link, 0, key.data(), side);
    }
    Ice_ObjectPrx proxy(const char* text, Ice_Int timeoutMs = 10000) {
        Ice_ObjectPrx prx;
        EXPECT_EQ(Ice_Communicator_stringToProxy(&ic, text, &prx), ICE_OK);
        Ice_ObjectPrx_ice_invocationTimeout(&prx, timeoutMs);
        return prx;
    }
    Ice_Status call(const char* text, Ice_Int timeoutMs = 10000) {
        Ice_ObjectPrx prx = proxy(text, timeoutMs);
        Ice_InputStreamPtr is = nullptr;
        (void)Ice_ObjectPrx_begin(&prx, "op", 0);
        return Ice_ObjectPrx_end(&prx, Ice_ObjectPrx_invoke(&prx, &is));
    }
    // Makes a call without waiting for the reply. Replies are counted.
    void callAsync(const char* text) {
        Ice_ObjectPrx prx = proxy(text);
        isIdle = false;
        ASSERT_TRUE(Ice_ObjectPrx_begin(&prx, "op", 0));
        const auto done = [](void* c, Ice_Status status, Ice_InputStreamPtr) {
            EXPECT_EQ(status, ICE_OK);
            ++static_cast<Craft*>(c)->replies;
            static_cast<Craft*>(c)->isIdle = true;
        };
        EXPECT_EQ(Ice_ObjectPrx_invokeAsync(&prx, done, this), ICE_OK);
    }
    U32 sessions() { return Link_statistics(&ends[fellow].link)->sessions; }
    void advance() {
        const U32 us = world.ms * 1000;
        for (End& end : ends) {
            while (!end.coming.empty() && S32(world.ms - end.coming.front().first) >= 0) {
                const Key bytes = end.coming.front().second;
                end.coming.pop_front();
                Link_receive(&end.link, bytes.data(), U32(bytes.size()), us);
            }
            if (end.isVehicles)
                XBeeATEndpoint_dial(&endpoint, fellow, us);
            Link_poll(&end.link, us);
        }
    }
    int wait(Ice_Int ms) {
        isBusy = true;
        advance(); // the link offers a message again that was not accepted before
        for (; ms > 0 && !isSignalled; --ms)
            world.step();
        isBusy = false;
        return std::exchange(isSignalled, false);
    }

    struct Servant {
        Ice_Object object{};
        unsigned calls = 0;
    };
    Simulation& world;
    Random random;
    static constexpr int fellow = 2;
    End ends[3];
    Ice_Communicator ic;
    XBeeATEndpoint endpoint;
    Ice_ObjectAdapter adapter;
    Servant servant;
    unsigned replies = 0;
    bool isAway = false, isIdle = true, isBusy = false, isSignalled = false;
};

bool End::transmit(const U8* frame, U32 size) {
    ++sent;
    if (peer && !craft->isAway && !peer->craft->isAway)
        peer->coming.emplace_back(craft->world.ms + 10, Key(frame, frame + size));
    return true;
}
U32 End::random() {
    return craft->random.next();
}
bool End::take(int channel, const U8* data, U32 size) {
    return XBeeATEndpoint_onMessage(&craft->endpoint, first + channel, data, size) == 0;
}
void End::onChannel(int channel, bool isOpen) {
    XBeeATEndpoint_onChannel(&craft->endpoint, first + channel, isOpen);
}

void Simulation::step() {
    ++ms;
    for (Craft* craft : crafts)
        craft->advance();
    for (Craft* craft : crafts)
        while (!craft->isBusy && Ice_Communicator_poll(&craft->ic, 0) == ICE_OK) {
        }
    atStep();
}

// Vehicle 5, its two ground stations, and vehicle 7, for which vehicle 5 acts as the ground
// station.
struct Team : Simulation {
    explicit Team(const Key& key = {}, const Key& keyOf7 = {}) {
        five.meets(seven, 7, Craft::fellow, true, key, LINK_GROUND | 7);
        seven.meets(five, 5, Craft::fellow, false, keyOf7.empty() ? key : keyOf7, 7);
        ground.meets(five, 5, 0, true, {}, 0);
        observer.meets(five, 5, 1, true, {}, 0);
        XBeeATEndpoint_addPeer(&five.endpoint, 1, &five.ends[1].link, 0xF0);
    }
    const std::unique_ptr<Craft> made[4] = {
        std::make_unique<Craft>(*this, 0), std::make_unique<Craft>(*this, 0xF0),
        std::make_unique<Craft>(*this, 5), std::make_unique<Craft>(*this, 7)};
    Craft &ground = *made[0], &observer = *made[1], &five = *made[2], &seven = *made[3];
};

const Key theKey(LINK_KEY_BYTES, 0x33), otherKey(LINK_KEY_BYTES, 0x44);

TEST(Fellows, TwoVehiclesCallEachOther) {
    for (const Key& key : {Key(), theKey}) {
        Team world(key);
        world.run(5000);
        EXPECT_EQ(world.five.ends[Craft::fellow].sent + world.seven.ends[Craft::fellow].sent, 0u)
            << "a vehicle must not send before the first call";
        EXPECT_EQ(world.five.call("it:xbee-at -a 7"), ICE_OK);
        EXPECT_EQ(world.seven.call("it:xbee-at -a 0x0005"), ICE_OK);
        EXPECT_EQ(world.five.call("it -o:xbee-at -a 7"), ICE_OK);
        EXPECT_EQ(world.seven.call("it -o:xbee-at -a 5"), ICE_OK);
        world.run(1000);
        EXPECT_EQ(world.seven.servant.calls, 2u);
        EXPECT_EQ(world.five.servant.calls, 2u);
        EXPECT_EQ(world.five.sessions(), 1u);
    }
}

TEST(Fellows, AVehicleServesTwoGroundsAndAnotherVehicleAtOnce) {
    Team world(theKey);
    for (Craft* craft : {&world.ground, &world.observer, &world.seven})
        EXPECT_EQ(craft->call("it:xbee-at -a 5"), ICE_OK);
    EXPECT_EQ(world.five.call("it:xbee-at -a 7"), ICE_OK);
    world.five.servant.calls = world.seven.servant.calls = 0;
    world.atStep = [&] {
        for (Craft* craft : {&world.ground, &world.observer, &world.seven})
            if (craft->isIdle)
                craft->callAsync("it:xbee-at -a 5");
        if (world.five.isIdle)
            world.five.callAsync("it:xbee-at -a 7");
    };
    world.run(6000);
    world.atStep = [] {};
    world.run(1000);
    for (const Craft* craft : {&world.ground, &world.observer, &world.seven, &world.five})
        EXPECT_GT(craft->replies, 100u);
    EXPECT_EQ(world.five.servant.calls,
              world.ground.replies + world.observer.replies + world.seven.replies);
    EXPECT_EQ(world.seven.servant.calls, world.five.replies);
    for (End& end : world.five.ends)
        EXPECT_EQ(Link_statistics(&end.link)->sessions, 1u) << end.first;
}

TEST(Fellows, SimultaneousCallsAreBothAnswered) {
    for (U32 offset = 0; offset < 60; ++offset) {
        Team world(offset % 2 ? theKey : Key());
        for (Craft* craft : {&world.five, &world.seven}) {
            const Ice_Byte to = craft == &world.five ? 7 : 5;
            const Ice_Byte at[] = {0x58, 0x41, 13, 0, 0, 0, 1, 1, to, 0, 255, 0, 0, 0, 0};
            const Ice_Transport& radio = craft->ic.transports[0];
            int connection = -1;
            EXPECT_EQ(radio.endpoint->connect(radio.context, at, sizeof at, &connection), ICE_OK);
            EXPECT_EQ(connection, to == 7 ? 8 : 11);
            world.run(offset / 2);
        }
        world.run(5000);
        EXPECT_EQ(world.five.ic.connections[8].state, ICE_CONNECTION_OPEN) << offset;
        EXPECT_EQ(world.seven.ic.connections[11].state, ICE_CONNECTION_OPEN) << offset;
        world.five.callAsync("it:xbee-at -a 7");
        world.seven.callAsync("it:xbee-at -a 5");
        world.run(1000);
        EXPECT_EQ(world.five.replies, 1u) << offset;
        EXPECT_EQ(world.seven.replies, 1u) << offset;
    }
}

TEST(Fellows, ACallToAnAbsentVehicleTimesOutAndDelaysNoGround) {
    for (const Key& key : {Key(), theKey}) {
        Team world(key);
        world.seven.isAway = true;
        EXPECT_EQ(world.ground.call("it:xbee-at -a 5"), ICE_OK);
        world.atStep = [&] {
            if (world.ground.isIdle)
                world.ground.callAsync("it:xbee-at -a 5");
        };
        for (const char* to : {"it:xbee-at -a 7", "it -o:xbee-at -a 7"}) {
            const unsigned replies = world.ground.replies;
            const U32 since = world.ms;
            EXPECT_EQ(world.five.call(to, 3000), ICE_TIMEOUT);
            EXPECT_NEAR(world.ms - since, 3000, 20);
            EXPECT_GT(world.ground.replies - replies, 60u)
                << "too few replies: each takes two packets of 10 ms";
        }
        for (int n = 0; n < 50; ++n)
            EXPECT_EQ(world.five.call("it:xbee-at -a 7", 200), ICE_TIMEOUT);
        EXPECT_LE(world.five.ends[Craft::fellow].sent, 11u)
            << "one HELLO is sent every 2.4 s, however many calls wait";
        world.run(11000);
        const unsigned sent = world.five.ends[Craft::fellow].sent;
        world.run(20000);
        EXPECT_EQ(world.five.ends[Craft::fellow].sent, sent)
            << "nothing may be sent without further calls";
        world.seven.isAway = false;
        EXPECT_EQ(world.five.call("it:xbee-at -a 7"), ICE_OK);
        EXPECT_EQ(world.seven.servant.calls, 1u)
            << "a call that its caller has abandoned must not be executed later";
    }
}

TEST(Fellows, ALostVehicleIsSoughtAgainOnlyByACall) {
    Team world(theKey);
    EXPECT_EQ(world.five.call("it:xbee-at -a 7"), ICE_OK);
    world.seven.isAway = true;
    EXPECT_EQ(world.five.call("it:xbee-at -a 7", 2000), ICE_TIMEOUT);
    world.run(60000);
    const unsigned sent = world.five.ends[Craft::fellow].sent;
    world.run(60000);
    EXPECT_EQ(world.five.ends[Craft::fellow].sent, sent);
    world.seven.isAway = false;
    EXPECT_EQ(world.five.call("it:xbee-at -a 7"), ICE_OK);
    EXPECT_EQ(world.five.sessions(), 2u);
}

TEST(Fellows, ASessionNeedsTheKey) {
    Team world(theKey, otherKey);
    EXPECT_EQ(world.five.call("it:xbee-at -a 7"), ICE_TIMEOUT);
    EXPECT_EQ(world.seven.call("it:xbee-at -a 5"), ICE_TIMEOUT);
    EXPECT_EQ(world.five.sessions() + world.seven.sessions(), 0u);
}

TEST(Fellows, AnAddressWithoutALinkIsNoEndpoint) {
    Team world;
    EXPECT_EQ(world.ground.call("it:xbee-at -a 5"), ICE_OK);
    for (const char* to : {"it:xbee-at -a 9", "it:xbee-at -a 5", "it -o:xbee-at -a 0xfff0"})
        EXPECT_EQ(world.five.call(to), ICE_NO_ENDPOINT) << to;
    EXPECT_EQ(world.five.call("it:xbee-at -a 0"), ICE_OK);
    EXPECT_EQ(world.ground.servant.calls, 1u);
}

} // namespace
