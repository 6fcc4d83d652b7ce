// SPDX-License-Identifier: MIT
//
// wire_test: messages as bytes: what is malformed, refused, skipped or kept; proxies as strings.

#include "pair.h"

#include <cstdlib>
#include <random>

namespace {

using Bytes = std::vector<Ice_Byte>;

// A message whose size is filled in.
Bytes message(Ice_Byte type, Bytes body, Ice_Byte compression = 0) {
    Bytes m = {'I', 'c', 'e', 'P', 1, 0, 1, 0, type, compression};
    size_t size = 14 + body.size();
    for (int i = 0; i < 4; ++i)
        m.push_back(static_cast<Ice_Byte>(size >> (8 * i)));
    m.insert(m.end(), body.begin(), body.end());
    return m;
}

void addString(Bytes& to, const std::string& s) {
    to.push_back(static_cast<Ice_Byte>(s.size()));
    to.insert(to.end(), s.begin(), s.end());
}

// From the identity on.
Bytes requestBody(const std::string& name, const std::string& operation, Ice_Byte minor = 1,
                  Bytes parameters = {}) {
    Bytes b;
    addString(b, name);
    b.push_back(0); // category
    b.push_back(0); // facet
    addString(b, operation);
    b.push_back(0); // mode
    b.push_back(0); // context
    b.push_back(static_cast<Ice_Byte>(6 + parameters.size()));
    b.insert(b.end(), {0, 0, 0, 1, minor});
    b.insert(b.end(), parameters.begin(), parameters.end());
    return b;
}

Bytes request(Ice_Byte id, const Bytes& body) {
    Bytes b = {id, 0, 0, 0};
    b.insert(b.end(), body.begin(), body.end());
    return message(0, b);
}

class Wire : public ::testing::Test {
protected:
    Wire() : side_(std::make_unique<Side>()) {
        EXPECT_EQ(Ice_ObjectAdapter_add(&side_->adapter, &servant_.base, "thing"), ICE_OK);
        side_->loop.tapContext = this;
        side_->loop.tap = [](void* context, int, const Ice_Byte* m, Ice_Int size) {
            static_cast<Wire*>(context)->sent_.emplace_back(m, m + size);
        };
    }
    // Opens a connection, sends the message, returns what came back behind the validation.
    std::vector<Bytes> exchange(const Bytes& m, Ice_Int size = -1) {
        inject(ICE_EVENT_OPENED, {});
        EXPECT_EQ(sent_, std::vector<Bytes>({message(3, {})}));
        sent_.clear();
        LoopEndpoint_inject(&side_->loop, ICE_EVENT_MESSAGE, 1, m.data(),
                            size < 0 ? static_cast<Ice_Int>(m.size()) : size);
        (void)Ice_Communicator_poll(&side_->ic, 0);
        return std::move(sent_);
    }
    void inject(Ice_EventKind kind, const Bytes& m) {
        sent_.clear();
        EXPECT_EQ(
            LoopEndpoint_inject(&side_->loop, kind, 1, m.data(), static_cast<Ice_Int>(m.size())),
            ICE_OK);
        (void)Ice_Communicator_poll(&side_->ic, 0);
    }
    bool isOpen() const { return side_->loop.open[1] != 0; }

    std::unique_ptr<Side> side_;
    Servant servant_;
    std::vector<Bytes> sent_;
};

// The figures of the protocol's description: a ping is 39 bytes out and 25 back.
TEST_F(Wire, APingIsAnsweredAsIceDoes) {
    auto back = exchange(request(7, requestBody("thing", "ice_ping")));
    ASSERT_EQ(back.size(), 1u);
    Bytes body = {7, 0, 0, 0, 0, 6, 0, 0, 0, 1, 1};
    EXPECT_EQ(back[0], message(2, body));
}

TEST_F(Wire, TheAnswerHasTheRequestsEncoding) {
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

TEST_F(Wire, WhatDoesNotExistIsNamedInTheReply) {
    auto back = exchange(request(1, requestBody("none", "op")));
    ASSERT_EQ(back.size(), 1u);
    Bytes body = {1, 0, 0, 0, 2, 4, 'n', 'o', 'n', 'e', 0, 0, 2, 'o', 'p'};
    EXPECT_EQ(back[0], message(2, body));
}

TEST_F(Wire, CompressedMessagesAreRefusedByClosing) {
    auto back = exchange(message(0, Bytes(100, 1), 2));
    EXPECT_EQ(back, std::vector<Bytes>({message(4, {})}));
    EXPECT_FALSE(isOpen());
}

TEST_F(Wire, CompressionThatIsOnlyOfferedDoesNotMatter) {
    Bytes m = request(1, requestBody("thing", "ice_ping"));
    m[9] = 1;
    EXPECT_EQ(exchange(m).size(), 1u);
}

TEST_F(Wire, MalformedMessagesCloseTheConnection) {
    Bytes good = request(1, requestBody("thing", "op", 1, {1, 2, 3, 4}));
    std::vector<Bytes> bad(12, good);
    bad[0][0] = 'J';                // magic
    bad[1][4] = 2;                  // protocol 2.0
    bad[2][8] = 5;                  // type
    bad[3][10] = 13;                // size
    bad[4][10]++;                   // size that is not the message's
    bad[5][18] = 200;               // name longer than the message
    bad[6][24 + 1] = 2;             // two facets
    bad[7][good.size() - 10]++;     // encapsulation longer than the message
    bad[8][good.size() - 10] = 5;   // or too short for its own head
    bad[9][good.size() - 7] = 0x80; // or negative
    bad[10].resize(13);             // less than a head
    bad[11].resize(0);
    for (size_t i = 0; i < bad.size(); ++i) {
        EXPECT_TRUE(exchange(bad[i]).empty()) << i;
        EXPECT_FALSE(isOpen()) << i;
    }
    EXPECT_EQ(servant_.calls, 0);
    EXPECT_EQ(exchange(good).size(), 1u) << "and then all is well";
}

TEST_F(Wire, ABatchMayNotPromiseMoreThanItHas) {
    Bytes body = {2, 0, 0, 0}, one = requestBody("thing", "op");
    body.insert(body.end(), one.begin(), one.end());
    EXPECT_TRUE(exchange(message(1, body)).empty());
    EXPECT_EQ(servant_.calls, 1);
    EXPECT_FALSE(isOpen());
    body[0] = 1;
    EXPECT_TRUE(exchange(message(1, body)).empty());
    EXPECT_EQ(servant_.calls, 2);
    EXPECT_TRUE(isOpen());
    EXPECT_TRUE(exchange(message(1, {0xFF, 0xFF, 0xFF, 0xFF})).empty());
    EXPECT_FALSE(isOpen());
}

TEST_F(Wire, RepliesThatNobodyAskedForArePassedOver) {
    EXPECT_TRUE(exchange(message(2, {9, 0, 0, 0, 0, 6, 0, 0, 0, 1, 1})).empty());
    EXPECT_TRUE(isOpen());
}

// Any damage to a request or reply is answered, refused or passed over, and the next ping works.
TEST_F(Wire, DamagedMessagesDoNoHarm) {
    const char* seed = std::getenv("SEED");
    std::mt19937 random(seed ? static_cast<unsigned>(std::atoi(seed)) : 1U);
    servant_.run = [](const Ice_Current&, Ice_InputStreamPtr is, Ice_OutputStreamPtr os) {
        Ice_ObjectPrx prx;
        Ice_InputStream_readPrx(is, nullptr, &prx);
        Ice_Int n = Ice_InputStream_readSequence(is, 2);
        (void)Ice_InputStream_allocate(is, n, 16);
        while (n-- > 0)
            (void)Ice_InputStream_readString(is);
        (void)Ice_InputStream_readOptional(is, 5, ICE_OPTIONAL_F4);
        Ice_InputStream_skipOptionals(is);
        Ice_OutputStream_writePrx(os, is->failed ? nullptr : &prx);
        return ICE_OK;
    };
    Bytes parameters;
    addString(parameters, "id");
    parameters.insert(parameters.end(),
                      {0, 0, 0, 0, 1, 0, 1, 1, 1, 9, 0, 8, 0, 0, 0, 1, 1, 65, 66});
    parameters.insert(parameters.end(),
                      {2, 1, 'a', 2, 'b', 'c', 0x0A, 1, 2, 3, 4, 0x2A, 5, 6, 7, 8});
    Bytes good = request(1, requestBody("thing", "op", 1, parameters));
    for (int i = 0; i < 20000; ++i) {
        Bytes bad = good;
        for (unsigned n = 1 + random() % 4; n > 0; --n)
            bad[14 + random() % (bad.size() - 14)] = static_cast<Ice_Byte>(random());
        (void)exchange(bad);
        auto back = exchange(request(1, requestBody("thing", "ice_ping")));
        ASSERT_EQ(back.size(), 1u) << "SEED=" << (seed ? seed : "1") << " message " << i;
    }
}

TEST_F(Wire, ProxiesTravelWithEndpointsOfAnyKind) {
    const Bytes wire = {2,    'i',  'd', 1, 'c', 1, 1, 'f', 1,  1,  1, 0, 1, 1, // -f f -o -s
                        2,                                                      // two endpoints
                        9,    0,    8,   0, 0,   0, 1, 1,   65, 66,             // of type 9
                        0x50, 0x4C, 7,   0, 0,   0, 1, 1,   1};                 // loop -c 1
    Ice_InputStream is;
    Ice_InputStream_init(&is, wire.data(), static_cast<Ice_Int>(wire.size()));
    Ice_ObjectPrx prx;
    Ice_InputStream_readPrx(&is, &side_->ic, &prx);
    ASSERT_FALSE(is.failed);
    char string[200];
    ASSERT_EQ(Ice_Communicator_proxyToString(&prx, string, sizeof string), ICE_OK);
    EXPECT_STREQ(string, "c/id -f f -o -s -e 1.1:opaque -t 9 -e 1.1 -v QUI=:loop -c 1");
    Bytes back(100);
    Ice_OutputStream os;
    Ice_OutputStream_init(&os, back.data(), 100);
    Ice_OutputStream_writePrx(&os, &prx);
    ASSERT_FALSE(os.failed);
    back.resize(static_cast<size_t>(os.size));
    EXPECT_EQ(back, wire);
    Ice_ObjectPrx again;
    ASSERT_EQ(Ice_Communicator_stringToProxy(&side_->ic, string, &again), ICE_OK);
    EXPECT_TRUE(Ice_ObjectPrx_equals(&prx, &again));
    again.mode = ICE_TWOWAY;
    EXPECT_FALSE(Ice_ObjectPrx_equals(&prx, &again));
}

TEST_F(Wire, EndpointsThatDoNotFitAreLeftOutAsLongAsOneDoes) {
    Bytes wire = {1, 'i', 0, 0, 0, 0, 1, 0, 1, 1, 40};
    for (int i = 0; i < 40; ++i)
        wire.insert(wire.end(), {9, 0, 8, 0, 0, 0, 1, 1, 65, 66});
    Ice_InputStream is;
    Ice_InputStream_init(&is, wire.data(), static_cast<Ice_Int>(wire.size()));
    Ice_ObjectPrx prx;
    Ice_InputStream_readPrx(&is, &side_->ic, &prx);
    EXPECT_FALSE(is.failed);
    EXPECT_EQ(prx.endpoints[0], (ICE_ENDPOINT_MAX - 1) / 10);
    EXPECT_EQ(is.position, is.size);
}

TEST_F(Wire, StringsThatAreNoProxiesSaySo) {
    const struct {
        const char* text;
        Ice_Status status;
    } cases[] = {{"id -x:loop", ICE_PARSE},
                 {":loop", ICE_PARSE},
                 {"a/b/c:loop", ICE_PARSE},
                 {"id -f:loop", ICE_PARSE},
                 {"id:loop -c", ICE_PARSE},
                 {"id:loop c", ICE_PARSE},
                 {"\"id:loop", ICE_PARSE},
                 {"id junk", ICE_PARSE},
                 {"id -e 2.0:loop", ICE_PARSE},
                 {"id:carrier-pigeon", ICE_NO_ENDPOINT},
                 {"id:loop -c 1:", ICE_NO_ENDPOINT},
                 {"id:opaque -t 9", ICE_PARSE},
                 {"id:opaque -t 99999 -v QUI=", ICE_PARSE},
                 {"id:opaque -t 9 -v ?", ICE_LIMIT},
                 {"id @", ICE_PARSE},
                 {"a-name-that-is-longer-than-the-limit-of-fifty-two-bytes:loop", ICE_LIMIT}};
    for (const auto& c : cases) {
        Ice_ObjectPrx prx;
        EXPECT_EQ(Ice_Communicator_stringToProxy(&side_->ic, c.text, &prx), c.status) << c.text;
        EXPECT_EQ(Ice_ObjectPrx_isNull(&prx), c.status != ICE_OK) << c.text;
    }
    Ice_ObjectPrx prx = side_->proxy("id:loop");
    char small[10];
    EXPECT_EQ(Ice_Communicator_proxyToString(&prx, small, sizeof small), ICE_LIMIT);
    EXPECT_STREQ(small, "");
}

TEST(Stream, OptionalsOfEveryFormatAreSkipped) {
    // tag 1 of each format in turn, then tag 2 = 7 (a byte)
    const std::vector<Bytes> values = {{1}, {1, 2},    {1, 2, 3, 4},       {1, 2, 3, 4, 5, 6, 7, 8},
                                       {5}, {2, 1, 2}, {2, 0, 0, 0, 1, 2}, {0}};
    for (size_t format = 0; format < values.size(); ++format) {
        Bytes wire = {static_cast<Ice_Byte>(1 << 3 | format)};
        wire.insert(wire.end(), values[format].begin(), values[format].end());
        wire.insert(wire.end(), {2 << 3 | ICE_OPTIONAL_F1, 7});
        Ice_InputStream is;
        Ice_InputStream_init(&is, wire.data(), static_cast<Ice_Int>(wire.size()));
        EXPECT_FALSE(Ice_InputStream_readOptional(&is, 0, ICE_OPTIONAL_F1));
        ASSERT_TRUE(Ice_InputStream_readOptional(&is, 2, ICE_OPTIONAL_F1)) << format;
        EXPECT_EQ(Ice_InputStream_readByte(&is), 7);
        EXPECT_FALSE(Ice_InputStream_readOptional(&is, 9, ICE_OPTIONAL_F1));
        EXPECT_FALSE(is.failed);
    }
}

TEST(Stream, OptionalTagsAreWrittenShortAndLong) {
    Ice_Byte bytes[20];
    Ice_OutputStream os;
    Ice_OutputStream_init(&os, bytes, sizeof bytes);
    EXPECT_TRUE(Ice_OutputStream_writeOptional(&os, 29, ICE_OPTIONAL_F1));
    EXPECT_TRUE(Ice_OutputStream_writeOptional(&os, 30, ICE_OPTIONAL_VSIZE));
    EXPECT_EQ(Bytes(bytes, bytes + os.size), Bytes({29 << 3, 30 << 3 | 5, 30}));
    os.minor = 0;
    EXPECT_FALSE(Ice_OutputStream_writeOptional(&os, 1, ICE_OPTIONAL_F1));
}

TEST(Stream, SizesAreCheckedBeforeUse) {
    const Bytes wire = {255, 255, 255, 255, 127, 1, 2, 3};
    Ice_InputStream is;
    auto open = [&](Ice_Int from) {
        Ice_InputStream_init(&is, wire.data() + from, static_cast<Ice_Int>(wire.size()) - from);
    };
    open(0);
    EXPECT_EQ(Ice_InputStream_readString(&is).size, 0);
    EXPECT_TRUE(is.failed);
    open(0);
    EXPECT_EQ(Ice_InputStream_readSequence(&is, 1), 0);
    open(0);
    is.position = 0;
    EXPECT_EQ(Ice_InputStream_readBlob(&is, -1), nullptr);
    open(5);
    (void)Ice_InputStream_readInt(&is);
    EXPECT_TRUE(is.failed);
    EXPECT_EQ(Ice_InputStream_readByte(&is), 0) << "errors stick";
    U32 arena[8];
    open(5);
    is.arena = arena;
    is.arenaSize = 8;
    EXPECT_NE(Ice_InputStream_allocate(&is, 3, 8), nullptr);
    EXPECT_EQ(Ice_InputStream_allocate(&is, 2, 8), nullptr);
    EXPECT_TRUE(is.failed);
    open(5);
    is.arena = arena;
    is.arenaSize = 8;
    EXPECT_EQ(Ice_InputStream_allocate(&is, 0x7FFFFFFF, 16), nullptr);
}

TEST(Stream, WritesThatDoNotFitFailAndTouchNothing) {
    Ice_Byte bytes[4] = {0, 0, 9, 9};
    Ice_OutputStream os;
    Ice_OutputStream_init(&os, bytes, 2);
    Ice_OutputStream_writeInt(&os, -1);
    Ice_OutputStream_writeByte(&os, 1);
    EXPECT_TRUE(os.failed);
    EXPECT_EQ(Bytes(bytes, bytes + 4), Bytes({0, 0, 9, 9}));
}

} // namespace
