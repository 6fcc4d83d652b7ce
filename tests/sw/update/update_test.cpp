// SPDX-License-Identifier: MIT
//
// update_test: tests slots and receiver with the model of the STM32F2's flash. The power is cut at
// every erase and at every written word, and there must always be an image that can boot.

#include "keys.h"
#include "stm32_flash.h"
#include <cstring>

extern "C" {
#include "signature.h"
}

namespace {

using Bytes = std::vector<uint8_t>;
constexpr uint32_t product = 0x55415631, imageBytes = 1024, chunk = 256;

Image makeImage(uint32_t version, uint32_t slot, uint32_t size = imageBytes,
                const Keys& signer = ours) {
    Bytes bytes(size);
    Random random(testSeed() + version);
    for (uint8_t& b : bytes)
        b = static_cast<uint8_t>(random.below(256));
    return {slots_firmware, product, version, slot, bytes, signer};
}

// The flash with its power supply, and the firmware that boots from it.
class FlashedVehicle : public Updated {
public:
    // Fills the flash as a programmer does before the first start: slot 0 has a confirmed image,
    // slot 1 has other data.
    explicit FlashedVehicle(uint32_t version = 1, uint64_t seed = 1)
        : Updated(chunk), flash_(
                              memory.data(), [this] { return now_; }, seed),
          port{&slots_firmware,
               this,
               read,
               erase,
               program,
               Signature_isGood,
               Signature_digest,
               reinterpret_cast<const Slots_Keys*>(memory.data() + SLOTS_KEYS_AT),
               memory.data()} {
        const Slots_Header list = ours.list(1, second, ours);
        std::memcpy(&memory[SLOTS_KEYS_AT], &list, sizeof list);
        cutPowerOf(flash_, now_);
        put(0, makeImage(version, 0));
        for (Slots_State state : {SLOTS_READY, SLOTS_TRIED, SLOTS_CONFIRMED})
            set(0, state);
        std::fill_n(memory.begin() + Slots_at(&slots_firmware, 1), 3 * imageBytes, uint8_t{0x11});
        boot();
    }
    void put(uint32_t slot, const Image& image) {
        std::memcpy(&memory[Slots_at(&slots_firmware, slot)], &image.header, sizeof image.header);
        std::copy(image.bytes.begin(), image.bytes.end(),
                  memory.begin() + Slots_at(&slots_firmware, slot) + SLOTS_IMAGE_AT);
    }
    void set(uint32_t slot, Slots_State state) {
        const uint32_t value = SLOTS_TRUE;
        std::memcpy(&memory[Slots_at(&slots_firmware, slot) + state], &value, 4);
    }
    // Switches the power on. Returns the version that runs.
    uint32_t boot() override {
        flash_.reset();
        const uint32_t slot = Slots_choose(&port, product, 1);
        EXPECT_NE(slot, SLOTS_NONE);
        if (slot == SLOTS_NONE)
            return 0;
        Receiver_init(&receiver, &port, product, slot);
        Slots_Header header;
        Slots_header(&port, slot, &header);
        const Image wanted = makeImage(header.version, slot, header.bytes);
        EXPECT_TRUE(std::equal(wanted.bytes.begin(), wanted.bytes.end(),
                               memory.begin() + Slots_at(&slots_firmware, slot) + SLOTS_IMAGE_AT));
        return header.version;
    }
    Image imageOf(uint32_t version, const Keys& signer = ours) override {
        return makeImage(version, receiver.slot, imageBytes, signer);
    }
    // Sends a list of keys. Returns the reason if it is refused.
    Receiver_Reason take(const Slots_Header& list) {
        return outcome(Receiver_begin(&receiver, &list));
    }
    uint64_t operations() const override { return flash_.operations(); }

    Bytes memory = Bytes(Stm32Flash::bytes, 0xFF);

private:
    uint64_t now_ = 0;
    Stm32Flash flash_;

public:
    Slots_Port port;

private:
    static FlashedVehicle& of(void* context) { return *static_cast<FlashedVehicle*>(context); }
    int control(uint32_t value) {
        flash_.write(Stm32Flash::Keyr, 0x45670123);
        flash_.write(Stm32Flash::Keyr, 0xCDEF89AB);
        flash_.write(Stm32Flash::Cr, 2 << 8 | value);
        return 1;
    }
    int done() {
        now_ += flash_.busyNs();
        const uint32_t status = flash_.read(Stm32Flash::Sr);
        flash_.write(Stm32Flash::Cr, Stm32Flash::Lock);
        return status == 0;
    }
    static void read(void* context, uint32_t offset, uint8_t* to, uint32_t count) {
        std::copy_n(&of(context).memory[offset], count, to);
    }
    static int erase(void* context, uint32_t offset) {
        of(context).control(Stm32Flash::Ser | Stm32Flash::sectorOf(offset) << 3 | Stm32Flash::Strt);
        return of(context).done();
    }
    static int program(void* context, uint32_t offset, const uint8_t* bytes, uint32_t count) {
        for (uint32_t i = 0; i < count; i += 4) {
            uint32_t word = 0;
            std::memcpy(&word, bytes + i, 4);
            of(context).control(Stm32Flash::Pg);
            of(context).flash_.store(offset + i, 4, word);
            if (!of(context).done())
                return 0;
        }
        return 1;
    }
};

TEST(Signature, IsEd25519AsInRfc8032) {
    const Bytes key = {0xd7, 0x5a, 0x98, 0x01, 0x82, 0xb1, 0x0a, 0xb7, 0xd5, 0x4b, 0xfe,
                       0xd3, 0xc9, 0x64, 0x07, 0x3a, 0x0e, 0xe1, 0x72, 0xf3, 0xda, 0xa6,
                       0x23, 0x25, 0xaf, 0x02, 0x1a, 0x68, 0xf7, 0x07, 0x51, 0x1a};
    Bytes signature = {0xe5, 0x56, 0x43, 0x00, 0xc3, 0x60, 0xac, 0x72, 0x90, 0x86, 0xe2, 0xcc, 0x80,
                       0x6e, 0x82, 0x8a, 0x84, 0x87, 0x7f, 0x1e, 0xb8, 0xe5, 0xd9, 0x74, 0xd8, 0x73,
                       0xe0, 0x65, 0x22, 0x49, 0x01, 0x55, 0x5f, 0xb8, 0x82, 0x15, 0x90, 0xa3, 0x3b,
                       0xac, 0xc6, 0x1e, 0x39, 0x70, 0x1c, 0xf9, 0xb4, 0x6b, 0xd2, 0x5b, 0xf5, 0xf0,
                       0x59, 0x5b, 0xbe, 0x24, 0x65, 0x51, 0x41, 0x43, 0x8e, 0x7a, 0x10, 0x0b};
    const uint8_t none = 0;
    EXPECT_EQ(Signature_isGood(signature.data(), &none, 0, key.data()), 1);
    signature[5] ^= 1;
    EXPECT_EQ(Signature_isGood(signature.data(), &none, 0, key.data()), 0);
}

TEST(Update, ANewImageStaysIfItIsConfirmed) {
    FlashedVehicle().expectTriedAndConfirmed();
}

TEST(Update, AnUnconfirmedImageIsTriedOnce) {
    FlashedVehicle().expectTriedOnce();
}

TEST(Update, AnImageForAnotherVehicleChangesNothing) {
    FlashedVehicle vehicle(5);
    const Bytes before = vehicle.memory;
    Image foreign = makeImage(6, 1), unsignedOne = makeImage(6, 1), otherKey = makeImage(6, 1);
    foreign.header.product ^= 1;
    ours.sign(foreign.header);
    Image otherVendor = makeImage(6, 1), otherBoard = makeImage(6, 1);
    ++otherVendor.header.board[0];
    ++otherBoard.header.board[1];
    ours.sign(otherVendor.header);
    ours.sign(otherBoard.header);
    EXPECT_EQ(vehicle.begin(otherVendor), RECEIVER_FOREIGN);
    EXPECT_EQ(vehicle.begin(otherBoard), RECEIVER_FOREIGN);
    ++unsignedOne.header.version;
    others.sign(otherKey.header);
    EXPECT_EQ(vehicle.begin(foreign), RECEIVER_FOREIGN);
    // this image is linked for the other slot
    EXPECT_EQ(vehicle.begin(makeImage(6, 0)), RECEIVER_FOREIGN);
    EXPECT_EQ(vehicle.begin(makeImage(5, 1)), RECEIVER_OLD);
    EXPECT_EQ(vehicle.begin(makeImage(4, 1)), RECEIVER_OLD);
    EXPECT_EQ(vehicle.begin(unsignedOne), RECEIVER_UNSIGNED);
    EXPECT_EQ(vehicle.begin(otherKey), RECEIVER_UNSIGNED);
    EXPECT_EQ(vehicle.receiver.state, RECEIVER_IDLE);
    EXPECT_EQ(vehicle.memory, before);
    EXPECT_EQ(vehicle.operations(), 0u);
}

TEST(Update, AnImageMayRequireAConfirmedVersionOfTheOtherKind) {
    FlashedVehicle vehicle;
    Image image = makeImage(2, 1);
    image.header.needs = 5;
    ours.sign(image.header);
    EXPECT_EQ(vehicle.begin(image), RECEIVER_NEEDS_OTHER);
    Receiver other{};
    other.version = 4;
    vehicle.receiver.counterpart = &other;
    EXPECT_EQ(vehicle.begin(image), RECEIVER_NEEDS_OTHER);
    other.version = 5;
    other.isOnTrial = 1;
    EXPECT_EQ(vehicle.begin(image), RECEIVER_NEEDS_OTHER);
    EXPECT_EQ(vehicle.operations(), 0u);
    other.isOnTrial = 0;
    EXPECT_EQ(vehicle.begin(image), RECEIVER_OK);
}

// The newest image is damaged, and the power is cut at each operation of the update that replaces
// it.
TEST(Update, NoPowerLossLowersTheConfirmedVersion) {
    for (uint64_t cut = 1; cut < 12; ++cut) {
        FlashedVehicle vehicle(5);
        vehicle.updateTo(6);
        vehicle.memory[Slots_at(&slots_firmware, 1) + SLOTS_IMAGE_AT + 99] ^= 1;
        EXPECT_EQ(vehicle.boot(), 5u);
        EXPECT_EQ(vehicle.receiver.confirmed, 6u);
        vehicle.cutAt = vehicle.operations() + cut;
        EXPECT_THROW(vehicle.updateTo(7), PowerCut);
        vehicle.cutAt = 0;
        EXPECT_EQ(vehicle.boot(), 5u);
        EXPECT_EQ(vehicle.receiver.confirmed, 6u) << "cut at operation " << cut;
        EXPECT_EQ(vehicle.begin(makeImage(6, 1)), RECEIVER_OLD);
        vehicle.updateTo(7);
    }
}

TEST(Update, AHeaderWithAnyWrongBitIsRefused) {
    FlashedVehicle vehicle;
    for (size_t bit = 0; bit < 8 * sizeof(Slots_Header); ++bit) {
        Image image = makeImage(2, 1);
        reinterpret_cast<uint8_t*>(&image.header)[bit / 8] ^= static_cast<uint8_t>(1 << bit % 8);
        EXPECT_NE(vehicle.begin(image), RECEIVER_OK) << "bit " << bit;
    }
    EXPECT_EQ(vehicle.operations(), 0u);
}

TEST(Update, WithoutAKeyNoImageIsAccepted) {
    FlashedVehicle vehicle;
    std::fill_n(vehicle.memory.begin() + SLOTS_KEYS_AT + offsetof(Slots_Header, digest),
                SLOTS_DIGEST_BYTES, uint8_t{0xFF});
    EXPECT_EQ(vehicle.begin(makeImage(2, 1)), RECEIVER_UNSIGNED);
}

// The first key is lost. The second key signs an image, and a list that contains a third key
// instead of the lost key.
TEST(Update, TheSecondKeySignsImagesAndTheNextList) {
    FlashedVehicle vehicle;
    vehicle.updateTo(2, second);
    EXPECT_EQ(vehicle.take(second.list(2, third, second)), RECEIVER_OK);
    EXPECT_EQ(vehicle.boot(), 2u);
    // the key that signed this image, the first one, was withdrawn
    EXPECT_EQ(vehicle.begin(makeImage(3, 0)), RECEIVER_UNSIGNED);
    vehicle.updateTo(3, third);
    EXPECT_EQ(vehicle.take(third.list(3, others, third)), RECEIVER_OK);
    EXPECT_EQ(vehicle.boot(), 3u);
    vehicle.updateTo(4, others);
}

TEST(Update, AListOfKeysIsSignedByThePreviousListAndCountsUpByOne) {
    FlashedVehicle vehicle;
    EXPECT_EQ(vehicle.take(ours.list(2, third, second)), RECEIVER_OK);
    const Bytes before = vehicle.memory;
    const uint64_t operations = vehicle.operations();
    Slots_Header foreign = ours.list(3, third, ours), changed = foreign;
    ++foreign.board[1];
    ours.sign(foreign);
    ++changed.needs;
    EXPECT_EQ(vehicle.take(ours.list(1, second, ours)), RECEIVER_OLD);
    EXPECT_EQ(vehicle.take(ours.list(2, second, ours)), RECEIVER_OLD);
    EXPECT_EQ(vehicle.take(ours.list(4, third, ours)), RECEIVER_NEEDS_OTHER);
    EXPECT_EQ(vehicle.take(foreign), RECEIVER_FOREIGN);
    EXPECT_EQ(vehicle.take(changed), RECEIVER_UNSIGNED);
    // list 2 does not contain the key `second`, which signs this list
    EXPECT_EQ(vehicle.take(ours.list(3, second, second)), RECEIVER_UNSIGNED);
    EXPECT_EQ(vehicle.take(others.list(3, others, others)), RECEIVER_UNSIGNED);
    EXPECT_EQ(vehicle.memory, before);
    EXPECT_EQ(vehicle.operations(), operations);
}

TEST(Update, AListOfKeysCannotRevokeTheRunningImage) {
    FlashedVehicle vehicle;
    const Slots_Header list = second.list(2, third, second);
    // refused, because the current firmware is signed with a key that this list does not contain
    EXPECT_EQ(vehicle.take(list), RECEIVER_NEEDS_OTHER);
    vehicle.receive(makeImage(2, 1, imageBytes, second));
    EXPECT_EQ(vehicle.take(list), RECEIVER_BUSY);
    EXPECT_EQ(vehicle.boot(), 2u);
    EXPECT_EQ(vehicle.take(list), RECEIVER_ON_TRIAL);
    EXPECT_EQ(Receiver_confirm(&vehicle.receiver), RECEIVER_OK);
    // this vehicle's bitstream is signed with a key that the list does not contain
    FlashedVehicle other;
    vehicle.receiver.counterpart = &other.receiver;
    EXPECT_EQ(vehicle.take(list), RECEIVER_NEEDS_OTHER);
    other.receiver.isOnTrial = 1;
    EXPECT_EQ(vehicle.take(list), RECEIVER_ON_TRIAL);
    other.updateTo(2, second);
    EXPECT_EQ(vehicle.take(list), RECEIVER_OK);
    EXPECT_EQ(vehicle.boot(), 2u);
}

// Cuts the power at each word while a list is being written, and at a random word of the next
// attempt.
TEST(Update, APowerLossAtAnyPointLeavesAValidListOfKeys) {
    constexpr unsigned words = sizeof(Slots_Header) / 4 + 1;
    Random random(testSeed());
    for (uint64_t first = 1; first <= words; ++first) {
        FlashedVehicle vehicle(1, testSeed() * 1000 + first);
        vehicle.updateTo(2, second);
        const Slots_Header list = second.list(2, third, second);
        for (const uint64_t cut : {first, uint64_t{1} + random.below(words)}) {
            if (Slots_keys(&vehicle.port)->version == 2)
                break;
            vehicle.cutAt = vehicle.operations() + cut;
            EXPECT_THROW(vehicle.take(list), PowerCut);
            vehicle.cutAt = 0;
            EXPECT_EQ(vehicle.boot(), 2u) << "cut at word " << cut;
            const Slots_Header* keys = Slots_keys(&vehicle.port);
            EXPECT_EQ(keys->version == 2 ? std::memcmp(keys, &list, sizeof list) : 0, 0);
            EXPECT_GE(keys->version, 1u);
        }
        if (Slots_keys(&vehicle.port)->version == 1) {
            EXPECT_EQ(vehicle.take(list), RECEIVER_OK) << "cut at word " << first;
        }
        EXPECT_EQ(vehicle.boot(), 2u);
        vehicle.updateTo(3, third);
    }
}

TEST(Update, ADamagedOrTruncatedImageIsNotStarted) {
    FlashedVehicle vehicle;
    Image image = makeImage(2, 1);
    EXPECT_EQ(vehicle.begin(image), RECEIVER_OK);
    EXPECT_EQ(Receiver_write(&vehicle.receiver, 0, image.bytes.data(), chunk), RECEIVER_OK);
    EXPECT_EQ(Receiver_finish(&vehicle.receiver), RECEIVER_NOT_BEGUN);
    EXPECT_EQ(vehicle.boot(), 1u);
    EXPECT_EQ(vehicle.begin(image), RECEIVER_OK);
    image.bytes[700] ^= 4;
    EXPECT_EQ(vehicle.send(image), RECEIVER_DAMAGED);
    EXPECT_EQ(vehicle.boot(), 1u);
    vehicle.updateTo(2); // after that, the update can be sent again
    EXPECT_EQ(vehicle.boot(), 2u);
}

TEST(Update, PiecesMustBeInOrderAndWholeWords) {
    FlashedVehicle vehicle;
    const Image image = makeImage(2, 1);
    const uint8_t* bytes = image.bytes.data();
    EXPECT_EQ(Receiver_write(&vehicle.receiver, 0, bytes, 4), RECEIVER_NOT_BEGUN);
    EXPECT_EQ(vehicle.begin(image), RECEIVER_OK);
    EXPECT_EQ(Receiver_write(&vehicle.receiver, 4, bytes, 4), RECEIVER_MISPLACED);
    EXPECT_EQ(Receiver_write(&vehicle.receiver, 0, bytes, 6), RECEIVER_MISPLACED);
    EXPECT_EQ(Receiver_write(&vehicle.receiver, 0, bytes, imageBytes + 4), RECEIVER_MISPLACED);
    EXPECT_EQ(Receiver_write(&vehicle.receiver, 0, bytes, imageBytes), RECEIVER_OK);
    EXPECT_EQ(Receiver_write(&vehicle.receiver, 512, bytes + 512, 512), RECEIVER_OK); // again
    EXPECT_EQ(Receiver_write(&vehicle.receiver, imageBytes, bytes, 4), RECEIVER_MISPLACED);
    EXPECT_EQ(Receiver_write(&vehicle.receiver, 0xFFFFFFFC, bytes, 8), RECEIVER_MISPLACED);
}

TEST(Update, AnUpdateContinuesAfterAPowerLoss) {
    FlashedVehicle vehicle;
    const Image image = makeImage(2, 1);
    EXPECT_EQ(vehicle.begin(image), RECEIVER_OK);
    EXPECT_EQ(Receiver_write(&vehicle.receiver, 0, image.bytes.data(), 768), RECEIVER_OK);
    EXPECT_EQ(vehicle.boot(), 1u);
    const uint64_t before = vehicle.operations();
    EXPECT_EQ(vehicle.begin(image), RECEIVER_OK);
    EXPECT_EQ(vehicle.receiver.received, 512u);
    EXPECT_EQ(vehicle.operations(), before);
    EXPECT_EQ(vehicle.send(image), RECEIVER_OK);
    EXPECT_EQ(vehicle.boot(), 2u);
}

TEST(Update, AnOlderImageThatWasNeverTriedIsNotStarted) {
    FlashedVehicle vehicle(5);
    std::fill_n(vehicle.memory.begin() + Slots_at(&slots_firmware, 1), slots_firmware.bytes,
                uint8_t{0xFF});
    vehicle.put(1, makeImage(4, 1));
    vehicle.set(1, SLOTS_READY);
    EXPECT_EQ(vehicle.boot(), 5u);
    vehicle.put(1, makeImage(6, 1));
    EXPECT_EQ(vehicle.boot(), 6u);
}

// The header of an image in the format that vehicles in use can read. If these bytes change, the
// format has changed (docs/compatibility.md): a new SLOTS_MAGIC and a second recording are then
// needed.
constexpr char recordedHeader[] =
    "050ce51c31564155020000004000000000020800070000000300000000000000ee4320ebaf3fdb4f"
    "2c832b137200c08e235e0fa7bbd0eb1740c7063ba8a0d151da77e003398e1714a955d475b05e3e95"
    "0b639503b452ec185de4229bc48739495b68ed709bab55e1e64ec3a4cd9aaf32a5267d27a79cd10d"
    "ccff198d00eefce471c8fb660c639be2edacf6c9d5bdaa04dac1bfd0af05a074f79e7a469a653401";

TEST(Update, AnImageWithARecordedHeaderIsStarted) {
    Bytes content(64), recorded;
    for (size_t i = 0; i < content.size(); ++i)
        content[i] = static_cast<uint8_t>(i);
    for (const char* digit = recordedHeader; *digit; digit += 2)
        recorded.push_back(static_cast<uint8_t>(std::stoi(std::string(digit, 2), nullptr, 16)));
    const Image image(slots_firmware, product, 2, 1, content, ours);
    Bytes header(sizeof image.header);
    std::memcpy(header.data(), &image.header, header.size());
    EXPECT_EQ(header, recorded);

    FlashedVehicle vehicle;
    std::fill_n(vehicle.memory.begin() + Slots_at(&slots_firmware, 1), slots_firmware.bytes,
                uint8_t{0xFF});
    vehicle.put(1, image);
    std::copy(recorded.begin(), recorded.end(),
              vehicle.memory.begin() + Slots_at(&slots_firmware, 1));
    vehicle.set(1, SLOTS_READY);
    EXPECT_EQ(Slots_choose(&vehicle.port, product, 1), 1u);
}

TEST(Update, APowerLossAtAnyPointLeavesABootableImage) {
    FlashedVehicle whole;
    whole.updateTo(2);
    const uint64_t all = whole.operations();
    ASSERT_GT(all, imageBytes / 4);
    // Some of these cuts happen while the new image is on trial.
    cutAtEach(
        2, all, all, [](uint64_t seed) { return FlashedVehicle(1, seed); },
        [](FlashedVehicle& vehicle) { return vehicle.receiver.running == 1; });
}

} // namespace
