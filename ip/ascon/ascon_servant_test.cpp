// SPDX-License-Identifier: MIT
//
// ascon_servant_test: compares the results of Cores::Ascon, which the core computes and the FSMC
// driver transfers, with the model.

#include "Vascon_slot.h"
#include "core_slot.h"
#include "known_answers.h"
extern "C" {
#include "ascon_regs.h"
#include "ascon_servant.h"
}

namespace {

// Converts a list of bytes to the sequence type that the servant reads.
template <class List> Cores_Bytes bytes(const List& list) {
    return {static_cast<Ice_Int>(list.size()), const_cast<uint8_t*>(list.data())};
}

TEST(AsconServant, SealsOpensAndHashes) {
    CoreSlot<Vascon_slot> slot;
    Random random(testSeed());
    static Ascon_Core core;
    ASSERT_EQ(Ascon_Core_init(&core, coreSlot, coreMemory, &slot.port, &slot), HW_OK);
    slot.core_ = &core.core;
    for (size_t size : {0u, 1u, 16u, 100u, 1024u}) {
        auto key = sixteen(static_cast<uint8_t>(random.next())),
             nonce = sixteen(static_cast<uint8_t>(random.next()));
        auto associated = counted(3, size / 2),
             message = counted(static_cast<uint8_t>(random.next()), size);
        auto want = asconEncrypt(key, nonce, associated, message);
        Cores_Bytes k = bytes(key), n = bytes(nonce), a = bytes(associated), m = bytes(message),
                    text{}, tag{}, got{};
        ASSERT_EQ(Cores_Ascon_setKey(&core.servant, &k, nullptr), ICE_OK);
        ASSERT_EQ(Cores_Ascon_seal(&core.servant, &n, &a, &m, &text, &tag, nullptr), ICE_OK);
        AsconSealed sealed{AsconBytes(text.data, text.data + text.size), {}};
        std::copy(tag.data, tag.data + 16, sealed.tag.begin());
        EXPECT_EQ(hex(sealed.text) + hex(sealed.tag), hex(want.text) + hex(want.tag));
        Ice_Bool valid = 0;
        for (bool forged : {true, false}) {
            sealed.tag[7] ^= forged ? 0x10 : 0;
            Cores_Bytes t = bytes(sealed.text), g = bytes(sealed.tag);
            ASSERT_EQ(Cores_Ascon_unseal(&core.servant, &n, &a, &t, &g, &got, &valid, nullptr),
                      ICE_OK);
            EXPECT_EQ(valid, !forged);
            EXPECT_EQ(AsconBytes(got.data, got.data + got.size), forged ? AsconBytes() : message);
            sealed.tag[7] ^= forged ? 0x10 : 0;
        }
        ASSERT_EQ(Cores_Ascon_hash(&core.servant, &m, &got, nullptr), ICE_OK);
        EXPECT_EQ(std::string(hex(AsconBytes(got.data, got.data + got.size))),
                  hex(asconHash(message)));
    }
    auto tooMuch = counted(0, 1025);
    auto shortKey = counted(0, 15);
    Cores_Bytes m = bytes(tooMuch), k = bytes(shortKey), got{};
    DirectCall call;
    EXPECT_EQ(Cores_Ascon_hash(&core.servant, &m, &got, &call.current), ICE_UNKNOWN_EXCEPTION);
    EXPECT_EQ(call.reason(), "nonce, tag: expected 16 bytes; texts: at most 1024");
    EXPECT_EQ(Cores_Ascon_setKey(&core.servant, &k, &call.current), ICE_UNKNOWN_EXCEPTION);
    EXPECT_EQ(call.reason(), "key: expected 16 bytes");
}

TEST(AsconServant, AHungCoreGivesNoResult) {
    CoreSlot<Vascon_slot> slot;
    static Ascon_Core core;
    ASSERT_EQ(Ascon_Core_init(&core, coreSlot, coreMemory, &slot.port, &slot), HW_OK);
    slot.core_ = &core.core;
    auto key = sixteen(1), other = sixteen(2), nonce = sixteen(3);
    auto message = counted(7, 40);
    Cores_Bytes k = bytes(key), o = bytes(other), n = bytes(nonce), m = bytes(message), text{},
                tag{}, got{};
    Ice_Bool valid = 0;
    ASSERT_EQ(Cores_Ascon_setKey(&core.servant, &k, nullptr), ICE_OK);
    slot.memory_.hold(true);
    EXPECT_EQ(Cores_Ascon_hash(&core.servant, &m, &got, nullptr), ICE_TIMEOUT);
    // The core is still busy with the abandoned message, so it would ignore a key or nonce.
    EXPECT_EQ(Cores_Ascon_setKey(&core.servant, &o, nullptr), ICE_TIMEOUT);
    EXPECT_EQ(Cores_Ascon_forget(&core.servant, nullptr), ICE_TIMEOUT);
    EXPECT_EQ(Cores_Ascon_hash(&core.servant, &m, &got, nullptr), ICE_TIMEOUT);
    EXPECT_EQ(Cores_Ascon_seal(&core.servant, &n, &m, &m, &text, &tag, nullptr), ICE_TIMEOUT);
    EXPECT_EQ(Cores_Ascon_unseal(&core.servant, &n, &m, &m, &k, &got, &valid, nullptr),
              ICE_TIMEOUT);
    slot.memory_.hold(false);
    slot.bench_.waitFor([&] { return !(slot.bus_.read(ASCON_STATUS) & ASCON_STATUS_BUSY_MASK); },
                        "the core to abort", 1000);
    // The abandoned message has ended and its event is still set. The next call must not mistake
    // this event for its own end.
    ASSERT_EQ(Cores_Ascon_seal(&core.servant, &n, &m, &m, &text, &tag, nullptr), ICE_OK);
    auto want = asconEncrypt(key, nonce, message, message);
    EXPECT_EQ(hex(AsconBytes(text.data, text.data + text.size)), hex(want.text));
    EXPECT_EQ(hex(AsconBytes(tag.data, tag.data + tag.size)), hex(want.tag));
    Hw_Core_interrupt(&core.core); // an interrupt without an event must have no effect
    EXPECT_EQ(Cores_Ascon_forget(&core.servant, nullptr), ICE_OK);
    DirectCall call;
    EXPECT_EQ(Cores_Ascon_seal(&core.servant, &n, &m, &m, &text, &tag, &call.current),
              ICE_UNKNOWN_EXCEPTION)
        << "no key was set";
    EXPECT_EQ(call.reason(), "expected a key, see setKey");
}

} // namespace
