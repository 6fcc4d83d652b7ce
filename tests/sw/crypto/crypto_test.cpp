// SPDX-License-Identifier: MIT
//
// crypto_test: checks that the firmware's Ascon-AEAD128 gives the known answers that Ascon's
// authors published, and rejects a message with a wrong bit. Checks that the firmware's X25519
// gives the results of the standard and, for random numbers, the results of OpenSSL.

#include "known_answers.h"
#include "random.h"
#include <array>
#include <gtest/gtest.h>
#include <memory>
#include <openssl/evp.h>

extern "C" {
#include "ascon.h"
#include "x25519.h"
}

namespace {

using Bytes = AsconBytes;

const Bytes key = counted(0x00, 16), nonce = counted(0x10, 16);

// Returns the encrypted text followed by its tag.
Bytes seal(const Bytes& associated, Bytes message) {
    Ascon ascon;
    Ascon_begin(&ascon, key.data(), nonce.data());
    if (!associated.empty())
        Ascon_associate(&ascon, associated.data(), static_cast<U32>(associated.size()));
    Ascon_crypt(&ascon, message.data(), static_cast<U32>(message.size()), 0);
    message.resize(message.size() + ASCON_TAG_BYTES);
    Ascon_end(&ascon, key.data(), &message[message.size() - ASCON_TAG_BYTES]);
    for (U32 half : ascon.half)
        EXPECT_EQ(half, 0u) << "the state is not wiped";
    return message;
}

// Returns the decrypted message, or an empty message if the tag is wrong.
Bytes open(const Bytes& associated, Bytes sealed) {
    Ascon ascon;
    U8 tag[ASCON_TAG_BYTES];
    const size_t size = sealed.size() - ASCON_TAG_BYTES;
    Ascon_begin(&ascon, key.data(), nonce.data());
    if (!associated.empty())
        Ascon_associate(&ascon, associated.data(), static_cast<U32>(associated.size()));
    Ascon_crypt(&ascon, sealed.data(), static_cast<U32>(size), 1);
    Ascon_end(&ascon, key.data(), tag);
    if (!Ascon_isSame(tag, &sealed[size], ASCON_TAG_BYTES))
        return {};
    sealed.resize(size);
    return sealed;
}

TEST(AsconCode, MatchesTheKnownAnswers) {
    EXPECT_EQ(aeadAnswers([](const Bytes& associated, const Bytes& message) {
                  const Bytes sealed = seal(associated, message);
                  EXPECT_EQ(open(associated, sealed), message);
                  return sealed;
              }),
              aeadFile);
}

TEST(AsconCode, DetectsEveryWrongBit) {
    const Bytes associated = counted(1, 20), sealed = seal(associated, counted(7, 37));
    for (size_t bit = 0; bit < sealed.size() * 8; ++bit) {
        Bytes wrong = sealed;
        wrong[bit / 8] ^= static_cast<uint8_t>(1u << bit % 8);
        EXPECT_TRUE(open(associated, wrong).empty()) << bit;
    }
    for (size_t bit = 0; bit < associated.size() * 8; ++bit) {
        Bytes wrong = associated;
        wrong[bit / 8] ^= static_cast<uint8_t>(1u << bit % 8);
        EXPECT_TRUE(open(wrong, sealed).empty()) << bit;
    }
}

using Value = std::array<U8, X25519_BYTES>;

Value multiply(const Value& number, const U8* point) {
    Value result;
    X25519(result.data(), number.data(), point);
    return result;
}

// The iterated test of RFC 7748, 5.2: number and point are 9 at first. Each result becomes the next
// number, and the previous number becomes the next point.
TEST(X25519Code, MatchesTheStandardAfterAThousandIterations) {
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

// The points are random or near 2^255, where some of them are not less than the prime p. Points for
// which OpenSSL refuses the result 0 are skipped.
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
