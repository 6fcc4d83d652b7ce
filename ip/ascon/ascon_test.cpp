// SPDX-License-Identifier: MIT
//
// ascon_test: compares the core and its model with the known answers that Ascon's authors
// published, and compares the core with the model while the memory stalls.

#include "Vascon_slot.h"
#include "ascon_regs.h"
#include "core_slot.h"
#include "known_answers.h"
#include "same.h"
#include <array>
#include <gtest/gtest.h>

namespace {

class AsconTest : public ::testing::Test {
protected:
    void SetUp() override {
        bench_.reset();
        bus_.write(ASCON_MASK, 3);
        place();
    }
    // Places each buffer at a random address in a separate quarter of the address space, at least
    // 64 KiB from the other buffers.
    void place() {
        uint32_t quarter = random_.next();
        for (auto [word, base] : {std::pair(ASCON_AD_BASE, &adBase_),
                                  {ASCON_SOURCE, &source_},
                                  {ASCON_TARGET, &target_},
                                  {ASCON_TAG, &tagBase_}}) {
            *base = (quarter++ << 30 | random_.below(0x3FFF0000)) & ~(ASCON_ALIGNMENT - 1u);
            bus_.write(word, *base);
        }
    }
    void put(unsigned word, const AsconKey& value) {
        for (size_t i = 0; i < 16; i += 4)
            bus_.write(word, uint32_t(value[i]) | uint32_t(value[i + 1]) << 8 |
                                 uint32_t(value[i + 2]) << 16 | uint32_t(value[i + 3]) << 24);
    }
    AsconKey tag() const {
        AsconKey key;
        const AsconBytes bytes = memory_.bytes(tagBase_, key.size());
        std::copy(bytes.begin(), bytes.end(), key.begin());
        return key;
    }
    uint32_t finish(uint64_t limit = 100000) {
        bench_.waitFor([&] { return bench_.top().irq_o; }, "the core's interrupt", limit);
        return bus_.takeEvents();
    }
    void sizes(size_t associated, size_t message) {
        bus_.write(ASCON_AD_SIZE, static_cast<uint32_t>(associated));
        bus_.write(ASCON_SIZE, static_cast<uint32_t>(message));
    }
    AsconSealed encrypt(const AsconKey& nonce, const AsconBytes& associated,
                        const AsconBytes& message) {
        memory_.store(adBase_, associated);
        memory_.store(source_, message);
        sizes(associated.size(), message.size());
        put(ASCON_NONCE, nonce);
        bus_.write(ASCON_CONTROL, ASCON_CONTROL_ENCRYPT_MASK);
        EXPECT_EQ(finish(), ASCON_EVENT_DONE_MASK);
        return {memory_.bytes(target_, message.size()), tag()};
    }
    // Decrypts; returns false if the core rejected the tag.
    bool decrypt(const AsconKey& nonce, const AsconBytes& associated, const AsconSealed& sealed) {
        memory_.store(adBase_, associated);
        memory_.store(source_, sealed.text);
        memory_.store(tagBase_, sealed.tag);
        sizes(associated.size(), sealed.text.size());
        put(ASCON_NONCE, nonce);
        bus_.write(ASCON_CONTROL, ASCON_CONTROL_DECRYPT_MASK);
        EXPECT_EQ(finish(), ASCON_EVENT_DONE_MASK);
        return bus_.read(ASCON_STATUS) & ASCON_STATUS_VALID_MASK;
    }
    AsconBytes random(size_t size) { return random_.items<uint8_t>(size); }
    AsconKey randomKey() {
        AsconKey key;
        for (auto& b : key)
            b = static_cast<uint8_t>(random_.next());
        return key;
    }

    uint32_t adBase_ = 0, source_ = 0, target_ = 0, tagBase_ = 0;
    Random random_{testSeed()};
    Bench<Vascon_slot> bench_;
    BusMaster<Vascon_slot> bus_{bench_};
    NpiMemory<Vascon_slot> memory_{bench_, 0.2, testSeed()};
};

AsconBytes together(const AsconSealed& sealed) {
    AsconBytes bytes = sealed.text;
    bytes.insert(bytes.end(), sealed.tag.begin(), sealed.tag.end());
    return bytes;
}

TEST(AsconModel, MatchesTheKnownAnswers) {
    EXPECT_EQ(aeadAnswers([](const AsconBytes& associated, const AsconBytes& message) {
                  return together(asconEncrypt(sixteen(0), sixteen(0x10), associated, message));
              }),
              aeadFile);
    EXPECT_EQ(hashAnswers([](const AsconBytes& message) {
                  auto digest = asconHash(message);
                  return AsconBytes(digest.begin(), digest.end());
              }),
              hashFile);
}

TEST_F(AsconTest, EncryptsAndDecryptsTheKnownAnswers) {
    put(ASCON_KEY, sixteen(0));
    EXPECT_EQ(aeadAnswers([&](const AsconBytes& associated, const AsconBytes& message) {
                  auto sealed = encrypt(sixteen(0x10), associated, message);
                  EXPECT_TRUE(decrypt(sixteen(0x10), associated, sealed));
                  EXPECT_SAME(memory_.bytes(target_, message.size()), message);
                  return together(sealed);
              }),
              aeadFile);
}

TEST_F(AsconTest, HashesTheKnownAnswers) {
    EXPECT_EQ(hashAnswers([&](const AsconBytes& message) {
                  memory_.store(source_, message);
                  sizes(0, message.size());
                  bus_.write(ASCON_CONTROL, ASCON_CONTROL_HASH_MASK);
                  EXPECT_EQ(finish(), ASCON_EVENT_DONE_MASK);
                  return memory_.bytes(target_, ASCON_DIGEST_BYTES);
              }),
              hashFile);
}

TEST_F(AsconTest, EqualsTheModelForRandomMessages) {
    for (int i = 0; i < 60; ++i) {
        place();
        // in some runs, a memory access takes longer than the core's rounds of the permutation
        bool isSlow = i % 6 == 5;
        memory_.setStall(isSlow ? 0.97 : 0.2);
        memory_.setLinger(isSlow ? 0.97 : 0);
        auto key = randomKey(), nonce = randomKey();
        auto associated = random(random_.below(200)), message = random(random_.below(600));
        if (i % 3 == 0)
            put(ASCON_KEY, randomKey()); // only the last four words that are written form the key
        put(ASCON_KEY, key);
        auto sealed = encrypt(nonce, associated, message),
             want = asconEncrypt(key, nonce, associated, message);
        ASSERT_EQ(hex(sealed.text), hex(want.text)) << associated.size() << ", " << message.size();
        ASSERT_EQ(hex(sealed.tag), hex(want.tag));
        EXPECT_EQ(memory_.byte(tagBase_ + 16), 0) << "the core wrote more than 16 bytes of tag";
        // Changes each bit of the protected data in turn. The core must then reject the tag and
        // erase the message.
        auto forged = sealed;
        auto forgedAd = associated;
        uint8_t bit = static_cast<uint8_t>(1u << random_.below(8));
        size_t place =
            random_.below(static_cast<uint32_t>(16 + message.size() + associated.size()));
        if (place < 16)
            forged.tag[place] ^= bit;
        else if (place < 16 + message.size())
            forged.text[place - 16] ^= bit;
        else
            forgedAd[place - 16 - message.size()] ^= bit;
        memory_.store(target_, AsconBytes(message.size() + 8, 0x55));
        ASSERT_FALSE(decrypt(nonce, forgedAd, forged)) << place;
        ASSERT_EQ(memory_.bytes(target_, message.size()), AsconBytes(message.size(), 0));
        ASSERT_EQ(memory_.bytes(target_ + static_cast<uint32_t>(message.size()), 8),
                  AsconBytes(8, 0x55))
            << "the core wrote beyond the message";
        ASSERT_TRUE(decrypt(nonce, associated, sealed));
        ASSERT_EQ(memory_.bytes(target_, message.size()), message);
    }
}

TEST_F(AsconTest, ADigestWaitsForRoomInTheMemoryFifo) {
    auto message = counted(1, 30);
    auto digest = asconHash(message);
    memory_.store(source_, message);
    sizes(0, message.size());
    auto start = [&] { bus_.write(ASCON_CONTROL, ASCON_CONTROL_HASH_MASK); };
    memory_.setLinger(1);
    // each start writes one burst; four bursts fill the 32 words of the FIFO
    for (int i = 0; i < 4; ++i) {
        start();
        ASSERT_EQ(finish(), ASCON_EVENT_DONE_MASK);
    }
    memory_.store(target_, AsconBytes(ASCON_DIGEST_BYTES, 0));
    start();
    bench_.tick(1000);
    EXPECT_EQ(bus_.read(ASCON_STATUS), ASCON_STATUS_BUSY_MASK);
    EXPECT_TRUE(bench_.top().npi_wr_almost_full_i);
    memory_.setLinger(0);
    EXPECT_EQ(finish(), ASCON_EVENT_DONE_MASK);
    EXPECT_SAME(memory_.bytes(target_, ASCON_DIGEST_BYTES),
                AsconBytes(digest.begin(), digest.end()));
}

TEST_F(AsconTest, CountsSizesOfUpTo16MiB) {
    put(ASCON_KEY, sixteen(0));
    // If the core ignored the upper bits of a size, it would see an empty message and not read any
    // data.
    auto goesOn = [&](uint32_t how) {
        uint64_t before = memory_.reads();
        put(ASCON_NONCE, sixteen(1));
        bus_.write(ASCON_CONTROL, how);
        bench_.tick(300);
        bool isBusy = bus_.read(ASCON_STATUS) == ASCON_STATUS_BUSY_MASK;
        bus_.write(ASCON_CONTROL, ASCON_CONTROL_ABORT_MASK);
        return isBusy && memory_.reads() > before + 3 && finish() == ASCON_EVENT_DONE_MASK &&
               bus_.read(ASCON_STATUS) == ASCON_STATUS_ABORTED_MASK;
    };
    for (uint32_t size = 1024; size <= ASCON_MAX_SIZE; size *= 2) {
        sizes(0, size);
        EXPECT_TRUE(goesOn(ASCON_CONTROL_HASH_MASK)) << size;
        sizes(size, 0);
        EXPECT_TRUE(goesOn(ASCON_CONTROL_ENCRYPT_MASK)) << size;
    }
    sizes(0, ASCON_MAX_SIZE);
    EXPECT_TRUE(goesOn(ASCON_CONTROL_HASH_MASK));
    sizes(ASCON_MAX_SIZE, 0);
    EXPECT_TRUE(goesOn(ASCON_CONTROL_ENCRYPT_MASK));
}

TEST_F(AsconTest, KeepsEveryBitOfItsSettings) {
    std::array<uint32_t, ASCON_TAG - ASCON_AD_SIZE + 1> values;
    for (int round = 0; round < 30; ++round) {
        for (unsigned i = 0; i < values.size(); ++i)
            bus_.write(ASCON_AD_SIZE + i, values[i] = random_.next());
        for (unsigned i = 0; i < values.size(); ++i)
            ASSERT_EQ(bus_.read(ASCON_AD_SIZE + i), values[i]) << "word " << ASCON_AD_SIZE + i;
    }
}

TEST_F(AsconTest, WorksInPlace) {
    auto key = randomKey(), nonce = randomKey();
    auto message = random(777);
    put(ASCON_KEY, key);
    bus_.write(ASCON_TARGET, source_);
    encrypt(nonce, {}, message);
    EXPECT_SAME(memory_.bytes(source_, 777), asconEncrypt(key, nonce, {}, message).text);
}

TEST_F(AsconTest, RefusesToStartWithoutAKeyOrAFreshNonce) {
    sizes(0, 4);
    auto start = [&](uint32_t how) {
        bus_.write(ASCON_CONTROL, how);
        return finish();
    };
    EXPECT_EQ(start(ASCON_CONTROL_ENCRYPT_MASK), ASCON_EVENT_REFUSED_MASK);
    put(ASCON_NONCE, sixteen(1));
    EXPECT_EQ(start(ASCON_CONTROL_ENCRYPT_MASK), ASCON_EVENT_REFUSED_MASK)
        << "no key has been written";
    put(ASCON_KEY, sixteen(2));
    EXPECT_EQ(start(ASCON_CONTROL_ENCRYPT_MASK), ASCON_EVENT_DONE_MASK);
    EXPECT_EQ(start(ASCON_CONTROL_DECRYPT_MASK), ASCON_EVENT_REFUSED_MASK)
        << "the nonce has already been used";
    for (int i = 0; i < 3; ++i)
        bus_.write(ASCON_NONCE, 7);
    EXPECT_EQ(start(ASCON_CONTROL_ENCRYPT_MASK), ASCON_EVENT_REFUSED_MASK)
        << "only three of the four words of the nonce have been written";
    bus_.write(ASCON_NONCE, 7);
    EXPECT_EQ(start(ASCON_CONTROL_ENCRYPT_MASK), ASCON_EVENT_DONE_MASK);
    // A nonce that was written only in part is discarded.
    sizes(0, 5);
    memory_.store(source_, counted(9, 5));
    bus_.write(ASCON_NONCE, 0x12345678);
    EXPECT_EQ(start(ASCON_CONTROL_HASH_MASK), ASCON_EVENT_DONE_MASK);
    auto digest = asconHash(counted(9, 5));
    EXPECT_SAME(memory_.bytes(target_, 32), AsconBytes(digest.begin(), digest.end()));
    bus_.write(ASCON_NONCE, 0x12345678);
    bus_.write(ASCON_CONTROL, ASCON_CONTROL_ABORT_MASK);
    EXPECT_EQ(hex(encrypt(sixteen(1), {}, counted(9, 5)).text),
              hex(asconEncrypt(sixteen(2), sixteen(1), {}, counted(9, 5)).text));
    // A new nonce may follow an abort immediately. If start and abort are written together, neither
    // has an effect.
    for (uint32_t how :
         {ASCON_CONTROL_ABORT_MASK, ASCON_CONTROL_ABORT_MASK | ASCON_CONTROL_ENCRYPT_MASK}) {
        put(ASCON_NONCE, sixteen(5));
        bus_.write(ASCON_CONTROL, how);
        put(ASCON_NONCE, sixteen(1));
        EXPECT_EQ(start(ASCON_CONTROL_ENCRYPT_MASK), ASCON_EVENT_DONE_MASK);
        EXPECT_EQ(hex(memory_.bytes(target_, 5)),
                  hex(asconEncrypt(sixteen(2), sixteen(1), {}, counted(9, 5)).text));
    }
    put(ASCON_NONCE, sixteen(1));
    bus_.write(ASCON_CONTROL, ASCON_CONTROL_FORGET_MASK);
    put(ASCON_NONCE, sixteen(1));
    EXPECT_EQ(start(ASCON_CONTROL_ENCRYPT_MASK), ASCON_EVENT_REFUSED_MASK)
        << "FORGET has erased the key";
    EXPECT_EQ(start(ASCON_CONTROL_HASH_MASK), ASCON_EVENT_DONE_MASK)
        << "a digest needs neither key nor nonce";
    auto refusesBits = [&](unsigned word, unsigned first, unsigned last) {
        for (unsigned bit = first; bit <= last; ++bit) {
            bus_.write(word, 1u << bit);
            EXPECT_EQ(start(ASCON_CONTROL_HASH_MASK), ASCON_EVENT_REFUSED_MASK)
                << "word " << word << ", bit " << bit;
        }
        bus_.write(word, 0);
    };
    for (unsigned word : {ASCON_AD_BASE, ASCON_SOURCE, ASCON_TARGET, ASCON_TAG})
        refusesBits(word, 0, 5);
    for (unsigned word : {ASCON_AD_SIZE, ASCON_SIZE})
        refusesBits(word, 24, 31);
    EXPECT_EQ(start(ASCON_CONTROL_HASH_MASK), ASCON_EVENT_DONE_MASK);
}

TEST_F(AsconTest, SettingsWrittenAfterTheStartAreIgnored) {
    auto key = randomKey(), nonce = randomKey();
    put(ASCON_KEY, key);
    for (int clocks = 0; clocks < 300; clocks += 7) {
        place();
        auto sealed = asconEncrypt(key, nonce, {}, random(300));
        // with a wrong tag, the core reads the register TARGET again, to overwrite the decrypted
        // data
        sealed.tag[clocks % 16] ^= 1;
        memory_.store(source_, sealed.text);
        memory_.store(tagBase_, sealed.tag);
        sizes(0, sealed.text.size());
        put(ASCON_NONCE, nonce);
        bus_.write(ASCON_CONTROL, ASCON_CONTROL_DECRYPT_MASK);
        bench_.tick(clocks);
        bus_.write(ASCON_SIZE, 8);
        bus_.write(ASCON_TARGET, source_);
        ASSERT_EQ(finish(), ASCON_EVENT_DONE_MASK);
        ASSERT_EQ(memory_.bytes(target_, 300), AsconBytes(300, 0)) << clocks;
        ASSERT_EQ(memory_.bytes(source_, 300), sealed.text) << clocks;
    }
}

TEST_F(AsconTest, AnAbortLeavesNoPlaintext) {
    auto key = randomKey(), nonce = randomKey();
    auto message = random(3000);
    put(ASCON_KEY, key);
    auto sealed = encrypt(nonce, {}, message);
    for (int clocks : {0, 20, 300, 1500, 1800}) {
        memory_.store(source_, sealed.text);
        memory_.store(target_, AsconBytes(3000, 0x55));
        put(ASCON_NONCE, nonce);
        bus_.write(ASCON_CONTROL, ASCON_CONTROL_DECRYPT_MASK);
        bench_.tick(clocks);
        bus_.write(ASCON_CONTROL, ASCON_CONTROL_ABORT_MASK);
        EXPECT_EQ(finish(5000), ASCON_EVENT_DONE_MASK);
        EXPECT_EQ(bus_.read(ASCON_STATUS), ASCON_STATUS_ABORTED_MASK);
        for (uint32_t i = 0; i < 3000; ++i)
            ASSERT_TRUE(memory_.byte(target_ + i) == 0 || memory_.byte(target_ + i) == 0x55) << i;
    }
    ASSERT_TRUE(decrypt(nonce, {}, sealed)) << "the next decryption succeeds";
    EXPECT_SAME(memory_.bytes(target_, 3000), message);
}

TEST_F(AsconTest, ReachesItsRateIfTheMemoryKeepsUp) {
    memory_.setStall(0);
    put(ASCON_KEY, sixteen(0));
    auto clocksOf = [&](uint32_t how, size_t size) {
        sizes(0, size);
        put(ASCON_NONCE, sixteen(1));
        uint64_t before = bench_.cycles();
        bus_.write(ASCON_CONTROL, how);
        finish();
        return bench_.cycles() - before;
    };
    double sealed = 2048.0 / static_cast<double>(clocksOf(ASCON_CONTROL_ENCRYPT_MASK, 4096) -
                                                 clocksOf(ASCON_CONTROL_ENCRYPT_MASK, 2048));
    double hashed = 2048.0 / static_cast<double>(clocksOf(ASCON_CONTROL_HASH_MASK, 4096) -
                                                 clocksOf(ASCON_CONTROL_HASH_MASK, 2048));
    std::printf("Ascon-AEAD128 %.3f bytes a clock, Ascon-Hash256 %.3f\n", sealed, hashed);
    EXPECT_GE(sealed, 1.6); // 16 bytes take 8 rounds and two additional clocks
    EXPECT_GE(hashed, 8.0 / 13 - 0.001);
}

TEST_F(AsconTest, IdentifiesItselfAndHidesItsKey) {
    EXPECT_EQ(bus_.read(ASCON_ID), ASCON_ID_VALUE);
    put(ASCON_KEY, sixteen(1));
    for (unsigned word = 3; word < 16; ++word) {
        auto answer = bus_.transfer(false, word, 0);
        EXPECT_EQ(answer.error, word > ASCON_TAG) << word;
        if (word <= ASCON_NONCE) {
            EXPECT_EQ(answer.data, 0u) << word;
        }
    }
}

} // namespace
