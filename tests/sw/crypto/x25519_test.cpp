// SPDX-License-Identifier: MIT
//
// x25519_test: the firmware's X25519 gives the standard's answers, and OpenSSL's for any numbers.

#include "random.h"
#include <array>
#include <gtest/gtest.h>
#include <memory>
#include <openssl/evp.h>

extern "C" {
#include "x25519.h"
}

namespace {

using Value = std::array<U8, X25519_BYTES>;

Value multiply(const Value& number, const U8* point) {
    Value result;
    X25519(result.data(), number.data(), point);
    return result;
}

// RFC 7748, 5.2: a number and the point, from 9 on, each time.
TEST(X25519Code, GivesTheStandardsAnswerAfterAThousandTimes) {
    Value number = {9}, point = {9};
    for (int i = 0; i < 1000; ++i) {
        const Value result = multiply(number, point.data());
        point = number;
        number = result;
    }
    const Value expected = {0x68, 0x4c, 0xf5, 0x9b, 0xa8, 0x33, 0x09, 0x55, 0x28, 0x00, 0xef,
                            0x56, 0x6f, 0x2f, 0x4d, 0x3c, 0x1c, 0x38, 0x87, 0xc4, 0x93, 0x60,
                            0xe3, 0x87, 0x5f, 0x2e, 0xb9, 0x4d, 0x99, 0x53, 0x2c, 0x51};
    EXPECT_EQ(number, expected);
}

// The points are random, or near 2^255, where some are not below p. OpenSSL refuses points that
// give 0.
TEST(X25519Code, AgreesWithOpenSsl) {
    using Key = std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)>;
    using Context = std::unique_ptr<EVP_PKEY_CTX, decltype(&EVP_PKEY_CTX_free)>;
    Random random(testSeed(1));
    for (int i = 0; i < 500; ++i) {
        Value number, point, expected{};
        size_t size = expected.size();
        for (size_t n = 0; n < number.size(); ++n) {
            number[n] = static_cast<U8>(random.next());
            point[n] = static_cast<U8>(i % 5 ? random.next() : 0xFF);
        }
        if (i % 5 == 0)
            point[0] = static_cast<U8>(random.next());
        Key own(EVP_PKEY_new_raw_private_key(EVP_PKEY_X25519, nullptr, number.data(), size),
                EVP_PKEY_free);
        ASSERT_TRUE(EVP_PKEY_get_raw_public_key(own.get(), expected.data(), &size));
        EXPECT_EQ(multiply(number, nullptr), expected);
        Key peer(EVP_PKEY_new_raw_public_key(EVP_PKEY_X25519, nullptr, point.data(), size),
                 EVP_PKEY_free);
        Context context(EVP_PKEY_CTX_new(own.get(), nullptr), EVP_PKEY_CTX_free);
        ASSERT_EQ(EVP_PKEY_derive_init(context.get()), 1);
        ASSERT_EQ(EVP_PKEY_derive_set_peer(context.get(), peer.get()), 1);
        if (EVP_PKEY_derive(context.get(), expected.data(), &size) != 1)
            expected = {};
        EXPECT_EQ(multiply(number, point.data()), expected);
    }
}

} // namespace
