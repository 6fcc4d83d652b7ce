// SPDX-License-Identifier: MIT
//
// requests_test: tests calls, and messages given as bytes that are answered, malformed, rejected or
// skipped. The full and the minimal run time must behave in the same way.

#include "icec_pair.h"

namespace {

TEST_F(Calls, ResultsAreReturned) {
    servant_.run = [](const Ice_Current& current, Ice_InputStreamPtr is, Ice_OutputStreamPtr os) {
        Ice_OutputStream_writeInt(os, 2 * Ice_InputStream_readInt(is));
        return str(current.operation) == "raise" ? ICE_USER_EXCEPTION : ICE_OK;
    };
    Ice_Int out = 0;
    for (int i = 0; i < 1000; ++i) {
        ASSERT_EQ(ask(prx_, "double", i), 2 * i);
    }
    EXPECT_EQ(servant_.calls, 1000);
    EXPECT_EQ(call(prx_, "raise", 21, &out), ICE_USER_EXCEPTION);
}

TEST_F(Calls, TypesAreQueriedByName) {
    Ice_Bool is = 0;
    EXPECT_EQ(Ice_ObjectPrx_ice_isA(&prx_, "::Test::Thing", &is), ICE_OK);
    EXPECT_EQ(is, 1);
    EXPECT_EQ(Ice_ObjectPrx_ice_isA(&prx_, "::Test::Thin", &is), ICE_OK);
    EXPECT_EQ(is, 0);
}

TEST_F(Calls, FailuresOfServantsKeepTheirKind) {
    const std::pair<Ice_Status, Ice_Status> kinds[] = {
        {ICE_OPERATION_NOT_EXIST, ICE_OPERATION_NOT_EXIST},
        {ICE_OBJECT_NOT_EXIST, ICE_OBJECT_NOT_EXIST},
        {ICE_USER_EXCEPTION, ICE_USER_EXCEPTION},
        {ICE_UNKNOWN_USER_EXCEPTION, ICE_UNKNOWN_USER_EXCEPTION},
        {ICE_MARSHAL, ICE_UNKNOWN_LOCAL_EXCEPTION},
        {ICE_PROTOCOL, ICE_UNKNOWN_LOCAL_EXCEPTION},
        {ICE_UNKNOWN_EXCEPTION, ICE_UNKNOWN_EXCEPTION},
        {ICE_TIMEOUT, ICE_UNKNOWN_EXCEPTION},
        {ICE_LIMIT, ICE_UNKNOWN_EXCEPTION}};
    for (const auto& kind : kinds) {
        servant_.run = [&](const Ice_Current&, Ice_InputStreamPtr, Ice_OutputStreamPtr) {
            return kind.first;
        };
        EXPECT_EQ(call(prx_, "op"), kind.second) << kind.first;
    }
}

TEST_F(Calls, OnewayCallsReturnAtOnceAndRefuseResults) {
    Ice_ObjectPrx prx = here().proxy("thing -o:loop");
    Ice_Int out = 0;
    EXPECT_EQ(call(prx, "op", 0, &out), ICE_TWOWAY_ONLY);
    for (int i = 0; i < 10; ++i)
        EXPECT_EQ(call(prx, "op"), ICE_OK);
    settle();
    EXPECT_EQ(servant_.calls, 10);
}

TEST_F(Calls, AnAdapterHasALimitAndAnswersOnlyWhenActive) {
    std::vector<std::string> names(ICE_SERVANTS, "n");
    for (size_t i = 1; i < names.size(); ++i)
        add((names[i] += std::to_string(i)).c_str());
    EXPECT_EQ(Ice_ObjectAdapter_add(&there().adapter, &servant_.base, "more"), ICE_LIMIT);
    Ice_ObjectPrx prx = here().proxy((names.back() + ":loop").c_str());
    EXPECT_EQ(call(prx, "op"), ICE_OK);
    Ice_ObjectAdapter_deactivate(&there().adapter);
    EXPECT_EQ(call(prx, "op"), ICE_OBJECT_NOT_EXIST);
    Ice_ObjectAdapter_activate(&there().adapter);
    EXPECT_EQ(call(prx, "op"), ICE_OK);
}

// Numbers from the description of the protocol: a ping has 39 bytes, its reply has 25.
TEST_F(Wire, APingIsAnsweredAsIceDoes) {
    auto back = exchange(request(7, requestBody("thing", "ice_ping")));
    ASSERT_EQ(back.size(), 1u);
    Bytes body = {7, 0, 0, 0, 0, 6, 0, 0, 0, 1, 1};
    EXPECT_EQ(back[0], message(2, body));
}

TEST_F(Wire, TheReplyHasTheEncodingOfTheRequest) {
    auto back = exchange(request(1, requestBody("thing", "ice_ping", 0)));
    ASSERT_EQ(back.size(), 1u);
    EXPECT_EQ(back[0].back(), 0);
}

TEST_F(Wire, AnotherEncodingIsAnUnknownLocalException) {
    auto back = exchange(request(1, requestBody("thing", "op", 2)));
    ASSERT_EQ(back.size(), 1u);
    EXPECT_EQ(back[0][18], 5);
    EXPECT_EQ(servant_.calls, 0);
    EXPECT_TRUE(isOpen());
}

TEST_F(Wire, TheReplyNamesTheMissingObject) {
    auto back = exchange(request(1, requestBody("none", "op")));
    ASSERT_EQ(back.size(), 1u);
    Bytes body = {1, 0, 0, 0, 2, 4, 'n', 'o', 'n', 'e', 0, 0, 2, 'o', 'p'};
    EXPECT_EQ(back[0], message(2, body));
}

TEST_F(Wire, AMissingFacetDoesNotExist) {
    auto back = exchange(request(1, "thing", "ice_ping", {}, "side"));
    ASSERT_EQ(back.size(), 1u);
    EXPECT_EQ(back[0][18], ICEC_FULL ? ICE_FACET_NOT_EXIST : ICE_OBJECT_NOT_EXIST);
}

TEST_F(Wire, AnOfferOfCompressionIsAccepted) {
    Bytes m = request(1, requestBody("thing", "ice_ping"));
    m[9] = 1;
    EXPECT_EQ(exchange(m).size(), 1u);
}

TEST_F(Wire, MalformedMessagesCloseTheConnection) {
    Bytes good = request(1, requestBody("thing", "op", 1, {1, 2, 3, 4}));
    std::vector<Bytes> bad(11, good);
    bad[0][0] = 'J';                // magic
    bad[1][4] = 2;                  // protocol 2.0
    bad[2][8] = 5;                  // type
    bad[3][10] = 13;                // size
    bad[4][10]++;                   // the size in the header differs from the size of the message
    bad[5][18] = 200;               // the name would end after the end of the message
    bad[6][good.size() - 10]++;     // the encapsulation would end after the end of the message
    bad[7][good.size() - 10] = 5;   // the encapsulation is shorter than its own header
    bad[8][good.size() - 7] = 0x80; // or negative
    bad[9].resize(13);              // the message is shorter than a header
    bad[10].resize(0);
    for (size_t i = 0; i < bad.size(); ++i) {
        EXPECT_TRUE(exchange(bad[i]).empty()) << i;
        EXPECT_FALSE(isOpen()) << i;
    }
    EXPECT_EQ(servant_.calls, 0);
    EXPECT_EQ(exchange(good).size(), 1u)
        << "a valid message after the invalid ones must be answered";
}

TEST_F(Wire, UnexpectedRepliesAreIgnored) {
    EXPECT_TRUE(exchange(message(2, {9, 0, 0, 0, 0, 6, 0, 0, 0, 1, 1})).empty());
    EXPECT_TRUE(isOpen());
}

} // namespace
