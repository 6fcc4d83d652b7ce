// SPDX-License-Identifier: MIT
//
// axis_core_test: tests third-party cores with AXI-Streams, which `./icesoc core foreign --bus
// axis` has connected, through their generated servants.

#include "Vmy_scale_slot.h"
#include "Vmy_twice_slot.h"
#include "my_scale_proxy.h"
#include "my_scale_regs.h"
#include "my_twice_proxy.h"
#include "same.h"

namespace {

template <class Element, class Packet, class Core>
std::vector<Element> process(Core& core, std::vector<Element> list) {
    Packet in{static_cast<Ice_Int>(list.size()), list.data()}, out = core.process(&in);
    return {out.data, out.data + out.size};
}

class Scale : public ::testing::Test {
protected:
    std::vector<Ice_Short> scaled(const std::vector<Ice_Short>& list) {
        return process<Ice_Short, Cores_MyScalePacket>(core_, list);
    }
    MyScaleProxy<Vmy_scale_slot> core_;
};

TEST_F(Scale, EverySampleIsScaledOnce) {
    core_.setGainFactor(3);
    for (size_t n : {1u, 2u, 3u, 4u, 5u, 31u, 32u, 33u, 512u}) {
        std::vector<Ice_Short> list, wanted;
        for (size_t i = 0; i < n; ++i) {
            list.push_back(static_cast<Ice_Short>(i + n));
            wanted.push_back(static_cast<Ice_Short>(3 * (i + n)));
        }
        EXPECT_SAME(scaled(list), wanted) << n << " samples";
    }
    EXPECT_FALSE(core_.bench_.top().over_o);
    scaled({0x7FFF});
    EXPECT_TRUE(core_.bench_.top().over_o) << "the core drives this pin";
}

TEST_F(Scale, ProcessesOneBeatPerClockIfTheMemoryKeepsUp) {
    core_.memory_.setStall(0);
    core_.setGainFactor(1);
    auto clocksOf = [&](size_t count) {
        scaled(std::vector<Ice_Short>(count, 1));
        uint64_t before = core_.bench_.cycles();
        // starts the core again, so that the time in which the driver copies data is not counted
        core_.bus_.write(MY_SCALE_CONTROL, 1u << 1);
        core_.bench_.waitFor([&] { return core_.bench_.top().irq_o; }, "the core's interrupt",
                             9999);
        core_.bus_.write(MY_SCALE_EVENT, ~0u);
        return static_cast<double>(core_.bench_.cycles() - before);
    };
    EXPECT_LE((clocksOf(512) - clocksOf(64)) / 448, 1.05);
}

TEST_F(Scale, AnEmptyPacketIsRefused) {
    EXPECT_THROW(scaled({}), CoreError);
    core_.setGainFactor(1);
    EXPECT_SAME(scaled({7}), std::vector<Ice_Short>{7});
}

TEST_F(Scale, AnEndlessCallIsAbortedAndTheNextCallWorks) {
    core_.setGainFactor(2);
    core_.memory_.hold(true);
    EXPECT_THROW(scaled(std::vector<Ice_Short>(300, 5)), CoreError);
    core_.memory_.hold(false);
    EXPECT_SAME(scaled({1, 2, 3}), (std::vector<Ice_Short>{2, 4, 6}));
    // aborts in the middle of an operation, while words wait for the core
    scaled(std::vector<Ice_Short>(512, 5));
    core_.bus_.write(MY_SCALE_CONTROL, 1u << 1); // again
    core_.bench_.tick(250);
    core_.bus_.write(MY_SCALE_CONTROL, 1u << 31);
    EXPECT_SAME(scaled({1, 2, 3}), (std::vector<Ice_Short>{2, 4, 6}));
}

class Twice : public ::testing::Test {
protected:
    std::vector<Ice_Byte> twice(size_t n) {
        std::vector<Ice_Byte> list;
        for (size_t i = 0; i < n; ++i)
            list.push_back(static_cast<Ice_Byte>(7 * i));
        return process<Ice_Byte, Cores_MyTwicePacket>(core_, list);
    }
    MyTwiceProxy<Vmy_twice_slot> core_;
};

TEST_F(Twice, TheReplyHasTheLengthOfTheOutput) {
    for (size_t n : {8u, 16u, 504u, 512u}) {
        auto out = twice(n);
        ASSERT_EQ(out.size(), 2 * n);
        for (size_t i = 0; i < 2 * n; ++i)
            ASSERT_EQ(out[i], static_cast<Ice_Byte>(7 * (i / 16 * 8 + i % 8))) << i << " of " << n;
    }
    // the first word is complete; of the second word, only the bytes with a byte enable are written
    auto out = twice(5);
    ASSERT_EQ(out.size(), 13u);
    for (size_t i = 0; i < 5; ++i)
        EXPECT_EQ(out[8 + i], 7 * i);
}

TEST_F(Twice, ATooLongReplyIsRefused) {
    EXPECT_THROW(twice(520), CoreError);
    EXPECT_EQ(twice(8).size(), 16u);
}

} // namespace
