// SPDX-License-Identifier: MIT
//
// delivery_check_test: tests that the check for endurance tests detects each kind of error, and
// accepts everything that the link is allowed to do.

#include "delivery_check.h"
#include "environment.h"
#include <gtest/gtest.h>

namespace {

const DeliveryCheck::Bytes one = {1}, two = {2, 2}, three = {3, 3, 3};

class Delivery : public ::testing::Test {
protected:
    Delivery() {
        check_.sent(0, 1, one);
        check_.sent(0, 2, two);
        check_.sent(1, 3, three);
    }
    DeliveryCheck check_;
};

TEST_F(Delivery, MessagesThatArriveOnceAndInOrderPass) {
    EXPECT_EQ(check_.arrived(1, three), ""); // another stream
    EXPECT_EQ(check_.arrived(0, one), "");
    EXPECT_EQ(check_.arrived(0, 2, two), "");
    for (uint32_t id : {1, 2, 3})
        EXPECT_EQ(check_.reported(id, true), "");
    EXPECT_TRUE(check_.isQuiet());
    EXPECT_EQ(check_.arrivals(), 3u);
}

TEST_F(Delivery, EachFaultIsDetected) {
    EXPECT_EQ(check_.arrived(0, {2, 3}), "a message is wrong");
    EXPECT_EQ(check_.arrived(0, 2, {2}), "message 2 is wrong");
    EXPECT_EQ(check_.arrived(0, three), "a message is wrong"); // a message of another stream
    EXPECT_EQ(check_.arrived(0, 9, two), "message 9 was never sent");
    EXPECT_EQ(check_.arrived(0, one), "");
    EXPECT_EQ(check_.arrived(0, one), "message 1 is a duplicate");
    EXPECT_EQ(check_.arrived(0, 1, one), "message 1 is a duplicate");
    EXPECT_EQ(check_.reported(2, true), "message 2 was reported delivered, but has not arrived");
    EXPECT_EQ(check_.reported(2, false), "message 2 was reported twice, or never sent");
    EXPECT_FALSE(check_.isQuiet());
}

TEST_F(Delivery, OnlyAMessageWithAnUnknownOutcomeMayBeSkipped) {
    EXPECT_EQ(check_.arrived(0, two), "message 1 was skipped");
    EXPECT_EQ(check_.reported(1, false), "");
    check_.sent(0, 4, three);
    EXPECT_EQ(check_.arrived(0, three), "");
    EXPECT_EQ(check_.arrived(0, one), "message 1 is out of order");
    EXPECT_EQ(check_.arrived(0, 1, one), "message 1 is out of order");
}

TEST_F(Delivery, ARestartedSenderKnowsNoOutcome) {
    EXPECT_EQ(check_.forget(0), 2u);
    EXPECT_NE(check_.reported(1, false), "");
    EXPECT_EQ(check_.arrived(0, two), "");
    EXPECT_EQ(check_.reported(3, false), "");
}

TEST_F(Delivery, AMessageArrivesAtOneOfTwoReceiversWithOneAddress) {
    EXPECT_EQ(check_.arrived(0, one, 0), "");
    EXPECT_EQ(check_.arrived(0, one, 1), "message 1 is a duplicate");
    EXPECT_EQ(check_.arrived(0, two, 1), "");
}

TEST_F(Delivery, OldMessagesAreForgottenWithoutErrors) {
    EXPECT_EQ(check_.forget(0), 2u);
    for (uint32_t id = 10; id < 30'010; ++id) {
        check_.sent(0, id, {uint8_t(id), uint8_t(id >> 8)});
        ASSERT_EQ(check_.arrived(0, {uint8_t(id), uint8_t(id >> 8)}), "") << id;
        ASSERT_EQ(check_.reported(id, true), "") << id;
    }
    EXPECT_EQ(check_.arrived(0, one), "a message is wrong");
}

TEST(Environment, OnlyNumbersAreAccepted) {
    const auto number = [](const char* text) {
        setenv("ICESOC_NUMBER", text, 1);
        return numberFromEnvironment("ICESOC_NUMBER", 5);
    };
    EXPECT_EQ(number("1e6"), 1e6);
    EXPECT_EQ(number("0x10"), 16);
    EXPECT_EQ(number("0.5"), 0.5);
    EXPECT_EQ(number(""), 5);
    for (const char* wrong : {"12x", "-1", "many", "nan", "inf", "1 000"})
        EXPECT_THROW(number(wrong), std::invalid_argument) << wrong;
    unsetenv("ICESOC_NUMBER");
    EXPECT_EQ(numberFromEnvironment("ICESOC_NUMBER", 5), 5);
}

} // namespace
