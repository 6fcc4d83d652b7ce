// SPDX-License-Identifier: MIT
//
// modem_test: two link layers over two modem models and the air between them: what modems lose
// after they have acknowledged it, the published weathers, the example of a trace.

#include "frame_pacer.h"
#include "rf_channel.h"
#include "timed_line.h"
#include <gtest/gtest.h>

extern "C" {
#include "link.h"
}

namespace {

constexpr uint64_t ms = 1'000'000;

// A serial line whose host may hang: then nothing moves.
class HangingLine : public TimedLine {
public:
    bool hangs = false;
    void advance(uint64_t now) override {
        if (!hangs)
            TimedLine::advance(now);
    }
};

class End {
public:
    End(RfChannel& air, unsigned address, bool hasKey)
        : modem(line, air, options(address)), random_(address + 1) {
        static const Link_Port port = {
            [](void* c, const U8* f, U32 n) { return self(c).transmit(f, n); },
            [](void* c) { return self(c).random_.next(); },
            [](void* c, int, const U8* m, U32 n) {
                self(c).received.emplace_back(m, m + n);
                return 0;
            },
            [](void*, int, int) {},
            [](void*, Link_State) {},
            nullptr,
            nullptr};
        static const U8 key[LINK_KEY_BYTES] = {1, 2, 3};
        Link_init(link(), &port, this, 1440);
        if (hasKey)
            Link_setKey(link(), 0, key);
    }
    Link* link() { return link_.get(); }
    bool isUp() const { return Link_state(link_.get()) == LINK_STATE_UP; }
    void advance(uint64_t now) {
        const U32 us = static_cast<U32>(now / 1000);
        modem.advance(now);
        now_ = now;
        write();
        Link_receive(link(), line.received.data(), static_cast<U32>(line.received.size()), us);
        line.received.clear();
        Link_poll(link(), us);
    }
    HangingLine line;
    XBee modem;
    std::vector<std::vector<U8>> received;

private:
    static End& self(void* c) { return *static_cast<End*>(c); }
    static XBee::Options options(unsigned address) {
        XBee::Options o;
        o.set = {{"BD", 7}, {"MY", address}, {"DL", 1 - address}, {"RN", 2}};
        return o;
    }
    int transmit(const U8* frame, U32 size) {
        if (!pacer_.offer(frame, size, static_cast<U32>(now_ / 1000)))
            return 1;
        write();
        return 0;
    }
    void write() {
        const auto frame = pacer_.due(static_cast<U32>(now_ / 1000));
        line.send(frame.data(), frame.size(), now_);
    }
    XBeeAT::FramePacer pacer_{90, LINK_MAX_FRAME};
    std::unique_ptr<Link> link_{new Link};
    Random random_;
    uint64_t now_ = 0;
};

class LinkOverModems : public ::testing::TestWithParam<bool> {
protected:
    void SetUp() override {
        Link_start(a_.link(), 0);
        ASSERT_TRUE(until([&] { return a_.isUp() && b_.isUp(); }, 10));
        ASSERT_EQ(Link_openChannel(a_.link(), 0), LINK_OK);
        ASSERT_TRUE(until([&] { return Link_openChannel(b_.link(), 0) == LINK_OK; }, 10));
    }
    template <class Done> bool until(Done done, unsigned seconds) {
        for (const uint64_t end = now_ + seconds * 1000 * ms; now_ < end; now_ += ms / 4) {
            air_.advance(now_);
            a_.advance(now_);
            b_.advance(now_);
            if (done())
                return true;
        }
        return done();
    }
    // Sends so many messages each way, and expects all, once, in order.
    void expectAll(unsigned count, unsigned seconds, const std::function<void()>& meanwhile = {}) {
        std::vector<std::vector<U8>> messages;
        for (unsigned i = 0; i < count; ++i)
            messages.emplace_back(i % 4 ? 20 : 700, static_cast<U8>(i));
        unsigned sent[2] = {0, 0};
        auto offer = [&](End& end, unsigned& n) {
            while (n < count && Link_send(end.link(), 0, messages[n].data(),
                                          static_cast<U32>(messages[n].size()), n) == LINK_OK)
                ++n;
        };
        EXPECT_TRUE(until(
            [&] {
                offer(a_, sent[0]);
                offer(b_, sent[1]);
                if (meanwhile)
                    meanwhile();
                return a_.received.size() >= count && b_.received.size() >= count;
            },
            seconds));
        EXPECT_TRUE(a_.received == messages) << a_.received.size() << " of " << count;
        EXPECT_TRUE(b_.received == messages) << b_.received.size() << " of " << count;
        a_.received.clear();
        b_.received.clear();
    }
    uint64_t now_ = 0;
    RfChannel air_{testSeed()};
    End a_{air_, 0, GetParam()}, b_{air_, 1, GetParam()};
};

// The hosts hang for up to 200 ms now and then: their modems acknowledge what no longer fits, and
// drop it.
TEST_P(LinkOverModems, WhatAModemAcknowledgesAndThenDropsIsSentAgain) {
    Random random(testSeed());
    uint64_t until[2] = {0, 0};
    expectAll(60, 120, [&] {
        for (End* end : {&a_, &b_}) {
            uint64_t& at = until[end == &b_];
            if (random.chance(0.002)) // eight times a second
                at = now_ + random.below(200) * ms;
            end->line.hangs = now_ < at;
        }
    });
    EXPECT_GT(a_.modem.counters().packetsDropped, 2u);
    EXPECT_GT(b_.modem.counters().packetsDropped, 2u);
}

TEST_P(LinkOverModems, InThePublishedWeathersNothingIsLostOrDoubled) {
    for (auto& [what, weather] : RfWeather::published()) {
        SCOPED_TRACE(what);
        air_.weather = weather;
        expectAll(24, 120);
    }
}

TEST_P(LinkOverModems, TheTraceOfTheExampleIsFlown) {
    air_.weather.trace = std::make_shared<RfTrace>(TRACE);
    const uint64_t lost = air_.counters().lost;
    while (now_ < 110'000 * ms && !HasFailure())
        expectAll(24, 120);
    EXPECT_GT(air_.counters().lost - lost, 100u);
}

INSTANTIATE_TEST_SUITE_P(Keys, LinkOverModems, ::testing::Bool(),
                         [](auto& test) { return test.param ? "WithAKey" : "InTheClear"; });

} // namespace
