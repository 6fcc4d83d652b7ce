// SPDX-License-Identifier: MIT
//
// wire_test: tests messages (given as bytes) that only the full run time supports, proxies as
// strings, and streams.

#include "icec_pair.h"
#include <cstdio>
#include <limits>

namespace {

Ice_InputStream over(const Bytes& wire) {
    Ice_InputStream is;
    Ice_InputStream_init(&is, wire.data(), static_cast<Ice_Int>(wire.size()));
    return is;
}

TEST_F(Wire, CompressedMessagesCloseTheConnection) {
    auto back = exchange(message(0, Bytes(100, 1), 2));
    EXPECT_EQ(back, std::vector<Bytes>({message(4, {})}));
    EXPECT_FALSE(isOpen());
}

TEST(Strings, AreTruncatedAtWholeCharacters) {
    char to[6];
    EXPECT_EQ(Ice_String_copy(Ice_String_from("four"), to, sizeof to), 1);
    EXPECT_STREQ(to, "four");
    EXPECT_EQ(Ice_String_copy(Ice_String_from("6bytes"), to, sizeof to), 0);
    EXPECT_STREQ(to, "6byte");
    EXPECT_EQ(Ice_String_copy(Ice_String_from("abcd\xC3\xA9"), to, sizeof to), 0);
    EXPECT_STREQ(to, "abcd");
    EXPECT_EQ(Ice_String_copy(Ice_String_from("x"), to, 0), 0);
    Ice_String empty = {0, nullptr};
    EXPECT_EQ(Ice_String_copy(empty, to, 1), 1);
    EXPECT_STREQ(to, "");
    char text[20];
    std::snprintf(text, sizeof text, "<%.*s><%.*s>", ICE_PRINTF(empty),
                  ICE_PRINTF(Ice_String_from("name")));
    EXPECT_STREQ(text, "<><name>");
}

TEST(Longs, ConvertToLongLongAndBack) {
    for (long long v :
         {0LL, 1LL, -1LL, 0x80000000LL, -0x80000000LL, 0x100000000LL, -0x100000001LL,
          std::numeric_limits<long long>::max(), std::numeric_limits<long long>::min()}) {
        EXPECT_EQ(Ice_Long_get(Ice_Long_from(v)), v);
        EXPECT_EQ(Ice_Long_from(v).low, static_cast<U32>(v));
    }
}

TEST_F(Wire, TwoFacetsAreMalformed) {
    Bytes m = request(1, requestBody("thing", "op"));
    m[24 + 1] = 2;
    EXPECT_TRUE(exchange(m).empty());
    EXPECT_FALSE(isOpen());
}

TEST_F(Wire, ABatchMustHaveTheDeclaredNumberOfRequests) {
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

TEST_F(Wire, ProxiesTravelWithEndpointsOfAnyKind) {
    // options -f f -o -s
    const Bytes wire = {2, 'i', 'd', 1, 'c', 1, 1, 'f', 1, 1, 1, 0, 1, 1,
                        2,                              // two endpoints
                        9, 0, 8, 0, 0, 0, 1, 1, 65, 66, // type 9
                        // endpoint loop -c 1
                        0x50, 0x4C, 7, 0, 0, 0, 1, 1, 1};
    Ice_InputStream is = over(wire);
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
}

TEST_F(Wire, EndpointsThatDoNotFitAreLeftOutIfOneFits) {
    Bytes wire = {1, 'i', 0, 0, 0, 0, 1, 0, 1, 1, 40};
    for (int i = 0; i < 40; ++i)
        wire.insert(wire.end(), {9, 0, 8, 0, 0, 0, 1, 1, 65, 66});
    Ice_InputStream is = over(wire);
    Ice_ObjectPrx prx;
    Ice_InputStream_readPrx(&is, &side_->ic, &prx);
    EXPECT_FALSE(is.failed);
    EXPECT_EQ(prx.endpoints[0], (ICE_ENDPOINT_MAX - 1) / 10);
    EXPECT_EQ(is.position, is.size);
}

TEST_F(Wire, InvalidProxyStringsAreReported) {
    const struct {
        const char* text;
        Ice_Status status;
    } cases[] = {{"id -x:loop", ICE_PARSE},
                 {":loop", ICE_PARSE},
                 {"a/b/c:loop", ICE_PARSE},
                 {"id/", ICE_PARSE},
                 {"id:", ICE_PARSE},
                 {"quote\\\"s and \\'single", ICE_PARSE},
                 {"id -f:loop", ICE_PARSE},
                 {"id:loop -c", ICE_PARSE},
                 {"id:loop c", ICE_PARSE},
                 {"\"id:loop", ICE_PARSE},
                 {"id junk", ICE_PARSE},
                 {"id -e 2:loop", ICE_PARSE},
                 {"id:carrier-pigeon", ICE_NO_ENDPOINT},
                 {"id:loop -c 1:", ICE_PARSE},
                 {"id:opaque -t 9", ICE_PARSE},
                 {"id:opaque -t 99999 -v QUI=", ICE_PARSE},
                 {"id:opaque -t 9 -v ?", ICE_PARSE},
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
    // a member with tag 1 in each of the formats, one after the other, then a member with tag 2 and
    // the byte 7
    const std::vector<Bytes> values = {{1}, {1, 2},    {1, 2, 3, 4},       {1, 2, 3, 4, 5, 6, 7, 8},
                                       {5}, {2, 1, 2}, {2, 0, 0, 0, 1, 2}, {0}};
    for (size_t format = 0; format < values.size(); ++format) {
        Bytes wire = {static_cast<Ice_Byte>(1 << 3 | format)};
        wire.insert(wire.end(), values[format].begin(), values[format].end());
        wire.insert(wire.end(), {2 << 3 | ICE_OPTIONAL_F1, 7});
        Ice_InputStream is = over(wire);
        EXPECT_FALSE(Ice_InputStream_readOptional(&is, 0, ICE_OPTIONAL_F1));
        ASSERT_TRUE(Ice_InputStream_readOptional(&is, 2, ICE_OPTIONAL_F1)) << format;
        EXPECT_EQ(Ice_InputStream_readByte(&is), 7);
        EXPECT_FALSE(Ice_InputStream_readOptional(&is, 9, ICE_OPTIONAL_F1));
        EXPECT_FALSE(is.failed);
    }
}

// A peer may send any number as the size of a slice, even the smallest Ice_Int. The code subtracts
// from the size; the result must not wrap.
TEST(Stream, ASliceOfAWrongSizeIsMalformed) {
    for (uint32_t size : {0x80000000U, 0x80000003U, 0xFFFFFFFFU, 0U, 3U, 5U, 0x7FFFFFFFU}) {
        Bytes wire = {0x39, 1, 'x', 4, 0, 0, 0, // last slice: its name and size; a table follows
                      1,    1,                  // the table contains one instance,
                      0x31, 1, 'y'};            // which has a slice with this name and `size`
        for (int shift = 0; shift < 32; shift += 8)
            wire.push_back(static_cast<Ice_Byte>(size >> shift));
        Ice_InputStream is = over(wire);
        (void)Ice_InputStream_startSlice(&is);
        ASSERT_FALSE(is.failed);
        Ice_InputStream_endSlice(&is);
        EXPECT_EQ(is.failed, ICE_FAILED_MALFORMED) << size;
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
    EXPECT_EQ(Ice_InputStream_readByte(&is), 0) << "after an error, all reads must fail";
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

TEST(Stream, TooLargeWritesFailAndChangeNothing) {
    Ice_Byte bytes[4] = {0, 0, 9, 9};
    Ice_OutputStream os;
    Ice_OutputStream_init(&os, bytes, 2);
    Ice_OutputStream_writeInt(&os, -1);
    Ice_OutputStream_writeByte(&os, 1);
    EXPECT_TRUE(os.failed);
    EXPECT_EQ(Bytes(bytes, bytes + 4), Bytes({0, 0, 9, 9}));
}

} // namespace
