// SPDX-License-Identifier: MIT
//
// async_test: later answers, calls in flight, calls from within operations.

#include "pair.h"

namespace {

TEST_F(Calls, AServantMayAnswerLaterAndOthersAreServedMeanwhile) {
    Ice_Reply later{};
    servant_.run = [&](const Ice_Current& current, Ice_InputStreamPtr is, Ice_OutputStreamPtr os) {
        if (str(current.operation) == "slow") {
            Ice_Current_later(&current, &later);
            return ICE_LATER;
        }
        Ice_OutputStream_writeInt(os, Ice_InputStream_readInt(is));
        return ICE_OK;
    };
    struct Answer {
        Ice_Status status = ICE_LATER;
        Ice_Int value = 0;
        static void take(void* cookie, Ice_Status status, Ice_InputStreamPtr is) {
            auto* self = static_cast<Answer*>(cookie);
            self->status = status;
            if (status == ICE_OK)
                self->value = Ice_InputStream_readInt(is);
        }
    } slow;
    ASSERT_NE(Ice_ObjectPrx_begin(&prx_, "slow", ICE_RESULTS), nullptr);
    ASSERT_EQ(Ice_ObjectPrx_invokeAsync(&prx_, &Answer::take, &slow), ICE_OK);
    EXPECT_EQ(ask(prx_, "quick", 5), 5);
    EXPECT_EQ(slow.status, ICE_LATER);
    Ice_OutputStreamPtr os = Ice_Reply_begin(&later);
    Ice_OutputStream_writeInt(os, 42);
    EXPECT_EQ(Ice_Reply_end(&later, ICE_OK), ICE_OK);
    settle();
    EXPECT_EQ(slow.status, ICE_OK);
    EXPECT_EQ(slow.value, 42);
}

TEST_F(Calls, SeveralCallsAreInFlightUpToTheLimit) {
    std::vector<Ice_Reply> later;
    servant_.run = [&](const Ice_Current& current, Ice_InputStreamPtr, Ice_OutputStreamPtr) {
        later.emplace_back();
        Ice_Current_later(&current, &later.back());
        return ICE_LATER;
    };
    std::vector<Ice_Status> answers;
    auto take = [](void* cookie, Ice_Status status, Ice_InputStreamPtr) {
        static_cast<std::vector<Ice_Status>*>(cookie)->push_back(status);
    };
    for (int i = 0; i < ICE_CALLS; ++i) {
        ASSERT_NE(Ice_ObjectPrx_begin(&prx_, "op", 0), nullptr);
        ASSERT_EQ(Ice_ObjectPrx_invokeAsync(&prx_, take, &answers), ICE_OK);
    }
    EXPECT_EQ(Ice_ObjectPrx_begin(&prx_, "op", 0), nullptr);
    EXPECT_EQ(prx_.status, ICE_LIMIT);
    settle();
    ASSERT_EQ(later.size(), static_cast<size_t>(ICE_CALLS));
    for (size_t i = later.size(); i-- > 0;) { // in the reverse order
        (void)Ice_Reply_begin(&later[i]);
        EXPECT_EQ(Ice_Reply_end(&later[i], ICE_OK), ICE_OK);
    }
    settle();
    EXPECT_EQ(answers, std::vector<Ice_Status>(ICE_CALLS, ICE_OK));
}

TEST_F(Calls, AnOperationMayCallBackBeforeItAnswers) {
    Servant back;
    ASSERT_EQ(Ice_ObjectAdapter_add(&here().adapter, &back.base, "back"), ICE_OK);
    back.run = [](const Ice_Current&, Ice_InputStreamPtr is, Ice_OutputStreamPtr os) {
        Ice_OutputStream_writeInt(os, Ice_InputStream_readInt(is) + 1);
        return ICE_OK;
    };
    servant_.run = [&](const Ice_Current&, Ice_InputStreamPtr is, Ice_OutputStreamPtr os) {
        Ice_Int v = Ice_InputStream_readInt(is);
        Ice_ObjectPrx prx = there().proxy("back:loop");
        EXPECT_EQ(call(prx, "next", v, &v), ICE_OK);
        EXPECT_EQ(call(prx, "next", v, &v), ICE_OK);
        Ice_OutputStream_writeInt(os, v);
        return ICE_OK;
    };
    Ice_ObjectPrx prx = here().proxy("thing:loop");
    for (int i = 0; i < 100; ++i) {
        ASSERT_EQ(ask(prx, "op", i), i + 2);
    }
}

} // namespace
