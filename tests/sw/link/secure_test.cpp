// SPDX-License-Identifier: MIT
//
// secure_test: sessions with a key: who gets one, what it costs, how it ends.

#include "link_pair.h"
#include <gtest/gtest.h>

namespace {

using Bytes = Side::Bytes;

const Bytes key(LINK_KEY_BYTES, 0x5A), otherKey(LINK_KEY_BYTES, 0x5B);

TEST(Secure, HandshakeBringsBothSidesUpAndMessagesCross) {
    Pair pair(testSeed(), key);
    ASSERT_TRUE(pair.connect());
    EXPECT_EQ(Link_keyInUse(pair.a.link()), 0);
    EXPECT_EQ(Link_keyInUse(pair.b.link()), 0);
    Link_openChannel(pair.a.link(), 1);
    Bytes hello = {'h', 'i'}, big(5000, 7);
    Link_send(pair.a.link(), 1, hello.data(), 2, 7);
    Link_send(pair.a.link(), 1, big.data(), 5000, 8);
    ASSERT_TRUE(pair.runUntil([&] { return pair.a.outcomes.size() == 2; }, 3000000));
    ASSERT_EQ(pair.b.received.size(), 2u);
    EXPECT_EQ(pair.b.received[0].second, hello);
    EXPECT_EQ(pair.b.received[1].second, big);
    EXPECT_EQ(Link_statistics(pair.a.link())->sessions, 1u);
}

} // namespace
