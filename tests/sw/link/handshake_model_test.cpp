// SPDX-License-Identifier: MIT
//
// handshake_model_test: the handshake keeps its promises in every state, and the model finds each
// seeded bug.

#include "handshake_model.h"
#include <gtest/gtest.h>

namespace {

// Two nonces a side: one for a session, one for another before or after it.
constexpr HandshakeModel::Limits withData = {2, 1, 0}, withPings = {2, 0, 1}, both = {2, 1, 1};

TEST(HandshakeModel, KeepsItsPromisesInEveryState) {
    for (const auto& limits : {withData, withPings}) {
        const auto result = HandshakeModel(Bug::None, limits).explore();
        EXPECT_EQ(result.fault, "") << testing::PrintToString(result.way);
        EXPECT_TRUE(result.bothWereUp) << "or it promises little";
        EXPECT_EQ(result.dataArrived, limits.data > 0);
        std::printf("%llu states\n", static_cast<unsigned long long>(result.states));
    }
}

TEST(HandshakeModel, FindsEachBug) {
    const std::pair<Bug, const char*> bugs[] = {
        {Bug::NonceIsNotEchoed, "a nonce began two sessions"},
        {Bug::OneKeyForBoth, "data was taken that the peer has not sent"},
        {Bug::ResetIsNotAuthentic, "a session that both were in was ended"},
        {Bug::HelloEndsTheSession, "a session that both were in was ended"},
        {Bug::HelloMakesASession, "a session that the peer knows nothing of"},
        {Bug::ConfirmIsNotAuthentic, "a session with somebody who is not the peer"},
        {Bug::OwnNonceIsTaken, "a session with somebody who is not the peer"},
        {Bug::NonceServesTwice, "a nonce began two sessions"},
        {Bug::UnconfirmedCalls, "a session that both were in was ended"},
        {Bug::OldDataIsTaken, "data was taken twice"},
        {Bug::OldPingIsLife, "the peer counts as there, and is not"},
        {Bug::OldDataIsLife, "the peer counts as there, and is not"}};
    for (const auto& [bug, fault] : bugs) {
        const auto result = HandshakeModel(bug, both).explore();
        EXPECT_EQ(result.fault, fault) << static_cast<int>(bug) << " after " << result.states
                                       << " states " << testing::PrintToString(result.way);
    }
}

} // namespace
