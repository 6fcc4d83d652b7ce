// SPDX-License-Identifier: MIT
//
// ascon_test: the firmware's Ascon-AEAD128 gives the known answers of the standard's authors, and
// takes no message with a wrong bit.

#include "known_answers.h"
#include <gtest/gtest.h>

extern "C" {
#include "ascon.h"
}

namespace {

using Bytes = AsconBytes;

const Bytes key = counted(0x00, 16), nonce = counted(0x10, 16);

// The text with its tag behind it.
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

// The message, or nothing if the tag is wrong.
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

TEST(AsconCode, GivesAllKnownAnswers) {
    EXPECT_EQ(aeadAnswers([](const Bytes& associated, const Bytes& message) {
                  const Bytes sealed = seal(associated, message);
                  EXPECT_EQ(open(associated, sealed), message);
                  return sealed;
              }),
              aeadFile);
}

TEST(AsconCode, FindsEachWrongBit) {
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

} // namespace
