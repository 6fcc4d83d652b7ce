// SPDX-License-Identifier: MIT
//
// minimal_radio_test: the minimal vehicle (IceC, endpoint, link) and a ground with the full ones
// over a radio that loses packets, in simulated time: calls both ways, reboots.

#include "pair.h"
#include "random.h"

#include <deque>
#include <dlfcn.h>

extern "C" {
#include "minimal_stack.h"
#include "xbee_endpoint.h"
}

namespace {

using Bytes = std::vector<uint8_t>;

class MinimalRadio : public ::testing::Test {
protected:
    MinimalRadio() : link_(std::make_unique<Link>()), ic_(std::make_unique<Ice_Communicator>()) {
        library_ = dlopen(MINIMAL_STACK, RTLD_NOW | RTLD_LOCAL);
        EXPECT_NE(library_, nullptr) << dlerror();
        load(stackInit_, "Stack_init");
        load(stackPoll_, "Stack_poll");
        load(twice_, "Stack_twice");
        load(notify_, "Stack_notify");
        load(served_, "Stack_served");
        load(lastNotified_, "Stack_lastNotified");
        bootVehicle();

        static const Link_Port linkPort = {
            [](void* c, const U8* f, U32 n) { return of(c).send(of(c).toVehicle_, f, n); },
            [](void* c) { return of(c).random_.next(); },
            [](void* c, int channel, const U8* d, U32 n) {
                return XBeeATEndpoint_onMessage(&of(c).endpoint_, channel, d, n);
            },
            [](void* c, int channel, int isOpen) {
                XBeeATEndpoint_onChannel(&of(c).endpoint_, channel, isOpen);
            },
            [](void* c, Link_State state) { XBeeATEndpoint_onState(&of(c).endpoint_, state); },
            nullptr,
            nullptr};
        static const XBeeATEndpoint_Port port = {
            [](void*) {},
            [](void*) {},
            [](void* c) { Link_poll(of(c).link_.get(), of(c).nowUs_); },
            [](void* c, Ice_Int ms) {
                MinimalRadio& m = of(c);
                m.waits_ = true;
                for (Ice_Int i = 0; i < ms && m.endpoint_.events == 0; ++i) {
                    m.step();
                    m.stackPoll_();
                }
                m.waits_ = false;
                return 0;
            },
            [](void*) {},
            [](void* c) { return of(c).nowUs_ / 1000; }};
        Link_init(link_.get(), &linkPort, this, 1440);
        Ice_initialize(ic_.get());
        XBeeATEndpoint_init(ic_.get(), "xbee-at", &endpoint_, link_.get(), 0, &port, this);
        Link_start(link_.get(), nowUs_);
        EXPECT_EQ(
            Ice_Communicator_createObjectAdapterWithEndpoints(ic_.get(), "A", "xbee-at", &adapter_),
            ICE_OK);
        Ice_ObjectAdapter_activate(&adapter_);
        servant_.run = [this](const Ice_Current& current, Ice_InputStreamPtr is,
                              Ice_OutputStreamPtr os) {
            Ice_Int v = Ice_InputStream_readInt(is);
            if (str(current.operation) == "twice")
                Ice_OutputStream_writeInt(os, 2 * v);
            else
                notified_ = v;
            return ICE_OK;
        };
        EXPECT_EQ(Ice_ObjectAdapter_add(&adapter_, &servant_.base, "station"), ICE_OK);
        connect();
    }
    ~MinimalRadio() override { dlclose(library_); }

    void bootVehicle() {
        static const Stack_World world = {
            [](void* c, const U8* f, U32 n) { return of(c).send(of(c).toGround_, f, n); },
            [](void* c, U8* bytes) { return of(c).takePacket(bytes); },
            [](void* c) {
                of(c).step();
                if (!of(c).waits_) // else it receives already, and called this
                    (void)Ice_Communicator_poll(of(c).ic_.get(), 0);
            },
            [](void* c) { return of(c).nowUs_; }};
        stackInit_(&world, this);
    }
    void connect() {
        for (int ms = 0; ms < 20000 && Link_state(link_.get()) != LINK_STATE_UP; ++ms)
            idle(1);
        ASSERT_EQ(Link_state(link_.get()), LINK_STATE_UP);
    }
    // Runs both sides' loops for so many milliseconds.
    void idle(int ms) {
        for (; ms > 0; --ms) {
            step();
            stackPoll_();
            (void)Ice_Communicator_poll(ic_.get(), 0);
        }
    }
    U32 nowMs() const { return nowUs_ / 1000; }
    Ice_ObjectPrx proxy(const char* text) {
        Ice_ObjectPrx prx;
        EXPECT_EQ(Ice_Communicator_stringToProxy(ic_.get(), text, &prx), ICE_OK);
        prx.timeoutMs = 60000;
        return prx;
    }

    Servant servant_;
    Random random_{testSeed()};
    double loss_ = 0;
    int notified_ = 0;
    decltype(&Stack_twice) twice_;
    decltype(&Stack_notify) notify_;
    decltype(&Stack_served) served_;
    decltype(&Stack_lastNotified) lastNotified_;

private:
    static MinimalRadio& of(void* c) { return *static_cast<MinimalRadio*>(c); }
    template <class F> void load(F& f, const char* name) {
        f = reinterpret_cast<F>(dlsym(library_, name));
        EXPECT_NE(f, nullptr) << name;
    }
    int send(std::deque<std::pair<U32, Bytes>>& air, const U8* frame, U32 size) {
        if (!random_.chance(loss_))
            air.emplace_back(nowUs_ + 8000 + 90 * size, Bytes(frame, frame + size));
        return 0;
    }
    U32 takePacket(U8* bytes) {
        if (!arrived(toVehicle_))
            return 0;
        Bytes packet = toVehicle_.front().second;
        toVehicle_.pop_front();
        std::copy(packet.begin(), packet.end(), bytes);
        return static_cast<U32>(packet.size());
    }
    // Passes 1 ms of time, and of the ground's link.
    void step() {
        nowUs_ += 1000;
        for (; arrived(toGround_); toGround_.pop_front())
            Link_receive(link_.get(), toGround_.front().second.data(),
                         static_cast<U32>(toGround_.front().second.size()), nowUs_);
        Link_poll(link_.get(), nowUs_);
    }
    bool arrived(const std::deque<std::pair<U32, Bytes>>& air) const {
        return !air.empty() && static_cast<S32>(air.front().first - nowUs_) <= 0;
    }

    void* library_;
    decltype(&Stack_init) stackInit_;
    decltype(&Stack_poll) stackPoll_;
    std::deque<std::pair<U32, Bytes>> toVehicle_, toGround_;
    U32 nowUs_ = 1000;
    bool waits_ = false;
    std::unique_ptr<Link> link_;
    std::unique_ptr<Ice_Communicator> ic_;
    XBeeATEndpoint endpoint_;
    Ice_ObjectAdapter adapter_;
};

TEST_F(MinimalRadio, TheGroundCallsTheVehicleThroughLoss) {
    loss_ = 0.1;
    Ice_ObjectPrx prx = proxy("vehicle:xbee-at -a 1");
    EXPECT_EQ(Ice_ObjectPrx_ice_ping(&prx), ICE_OK);
    for (int i = 0; i < 300; ++i) {
        Ice_Int out = 0;
        ASSERT_EQ(call(prx, "twice", i, &out), ICE_OK)
            << "call " << i << ", seed " << testSeed() << ", ms " << nowMs();
        ASSERT_EQ(out, 2 * i);
    }
    Ice_ObjectPrx oneway = prx;
    Ice_ObjectPrx_ice_oneway(&oneway);
    for (int i = 1; i <= 50; ++i)
        ASSERT_EQ(call(oneway, "notify", i), ICE_OK);
    EXPECT_EQ(call(prx, "nothing"), ICE_OPERATION_NOT_EXIST);
    EXPECT_EQ(lastNotified_(), 50);
    EXPECT_EQ(served_(), 350);
    Ice_ObjectPrx nobody = proxy("nobody:xbee-at -a 1");
    EXPECT_EQ(Ice_ObjectPrx_ice_ping(&nobody), ICE_OBJECT_NOT_EXIST);
}

TEST_F(MinimalRadio, TheVehicleCallsTheGroundThroughLoss) {
    loss_ = 0.1;
    for (int i = 0; i < 300; ++i)
        ASSERT_EQ(twice_(i), 2 * i) << "seed " << testSeed();
    for (int i = 1; i <= 50; ++i)
        ASSERT_EQ(notify_(i), 0);
    EXPECT_EQ(twice_(4), 8);
    EXPECT_EQ(notified_, 50);
}

TEST_F(MinimalRadio, AfterARebootOfTheVehicleCallsGoOn) {
    Ice_ObjectPrx prx = proxy("vehicle:xbee-at -a 1");
    Ice_Int out = 0;
    EXPECT_EQ(call(prx, "twice", 21, &out), ICE_OK);
    bootVehicle();
    EXPECT_EQ(call(prx, "twice", 21, &out), ICE_CONNECTION_LOST);
    connect();
    EXPECT_EQ(call(prx, "twice", 4, &out), ICE_OK);
    EXPECT_EQ(out, 8);
    EXPECT_EQ(twice_(5), 10);
}

} // namespace
