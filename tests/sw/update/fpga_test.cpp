// SPDX-License-Identifier: MIT
//
// fpga_test: tests the update of the bitstream in the FPGA's flash. The power is cut at every erase
// and at every written page, and there must always be a bitstream that configures the FPGA.

#include "keys.h"
#include "spartan6_boot.h"
#include "spi_flash.h"
#include <cstring>
#include <map>

extern "C" {
#include "signature.h"
#include "spi_nor.h"
}

namespace {

using Bytes = std::vector<uint8_t>;
constexpr uint32_t product = 0x46504731, chunk = 4096;
const uint32_t golden = Slots_at(&slots_fpga, 0) + SLOTS_IMAGE_AT,
               multiBoot = Slots_at(&slots_fpga, 1) + SLOTS_IMAGE_AT;

// Returns the bitstream with this version, with its header and without its sync word.
const Image& bitstream(uint32_t version, uint32_t slot = 1) {
    static std::map<std::pair<uint32_t, uint32_t>, Image> images;
    auto at = images.find({version, slot});
    if (at == images.end()) {
        Bytes bytes = standInBitstream(version, 33'200);
        std::fill_n(bytes.begin() + SLOTS_SYNC_AT, 4, uint8_t{0xFF});
        bytes.resize((bytes.size() + 3) / 4 * 4, 0xFF);
        at = images
                 .try_emplace({version, slot}, slots_fpga, product, version, slot, std::move(bytes),
                              ours)
                 .first;
    }
    return at->second;
}

// The FPGA's flash, the FPGA, and the processor that is connected to both.
class Fpga : public ::testing::Test, public Updated {
public:
    Fpga() : Updated(chunk) {
        lists[0].list = ours.list(1, ours, ours);
        fill(1);
    }
    ~Fpga() override { flash_ = nullptr; }

    // Fills the flash as the factory does: a golden bitstream, and the header that makes the FPGA
    // look for a newer bitstream.
    void fill(uint64_t seed) {
        flash = SpiFlash([] { return now_; }, seed);
        flash_ = &flash;
        cutPowerOf(flash, now_);
        const Image& image = bitstream(1, 0);
        const auto at = [&](uint32_t offset) { return flash.memory.begin() + offset; };
        std::memcpy(&*at(golden - SLOTS_IMAGE_AT), &image.header, sizeof image.header);
        std::copy(image.bytes.begin(), image.bytes.end(), at(golden));
        const Bytes sync = {0xAA, 0x99, 0x55, 0x66};
        std::copy(sync.begin(), sync.end(), at(golden + SLOTS_SYNC_AT));
        const uint32_t isTrue = SLOTS_TRUE;
        std::memcpy(&*at(golden - SLOTS_IMAGE_AT + SLOTS_CONFIRMED), &isTrue, 4);
        Bytes header(16, 0xFF);
        for (uint32_t word :
             {0xAA99u, 0x5566u, 0x3261u, multiBoot & 0xFFFF, 0x3281u, 0x0300 | multiBoot >> 16,
              0x32A1u, golden & 0xFFFF, 0x32C1u, 0x0300 | golden >> 16, 0x30A1u, 0x000Eu}) {
            header.push_back(static_cast<uint8_t>(word >> 8));
            header.push_back(static_cast<uint8_t>(word));
        }
        std::copy(header.begin(), header.end(), at(0));
    }
    // Switches the power on, or restarts the processor. Returns the version of the bitstream that
    // configures the FPGA.
    uint32_t boot() override {
        if (Slots_settleFpga(&port, 0))
            fpga.configure(flash.memory);
        EXPECT_TRUE(fpga.running.has_value())
            << (fpga.isStuck ? "the FPGA is stuck" : "no bitstream configures the FPGA");
        const uint32_t slot = Slots_is(&port, 1, SLOTS_READY);
        EXPECT_EQ(fpga.running.value_or(0), slot ? multiBoot : golden);
        Receiver_init(&receiver, &port, product, slot);
        return receiver.version;
    }
    uint32_t powerOn() override {
        flash.powerOff();
        // the FPGA configures itself before the processor does anything
        fpga.configure(flash.memory);
        EXPECT_TRUE(fpga.running.has_value())
            << (fpga.isStuck ? "the FPGA is stuck" : "no bitstream configures the FPGA");
        return boot();
    }
    uint64_t operations() const override { return flash.operations(); }
    Image imageOf(uint32_t version, const Keys& = ours) override { return bitstream(version); }

    static inline uint64_t now_ = 0;
    static inline SpiFlash* flash_ = nullptr;
    static constexpr SpiNor_Bus bus{[](int isLow) { flash_->select(isLow != 0); },
                                    [](U8 byte) { return flash_->transfer(byte); },
                                    [] { now_ += flash_->busyNs(); }};
    SpiFlash flash{[] { return now_; }};
    Spartan6Boot fpga;
    std::vector<Slots_Keys> lists = std::vector<Slots_Keys>(SLOTS_LISTS);
    Slots_Port port{&slots_fpga,      const_cast<SpiNor_Bus*>(&bus),
                    SpiNor_read,      SpiNor_erase,
                    SpiNor_program,   Signature_isGood,
                    Signature_digest, lists.data(),
                    nullptr};
};

TEST_F(Fpga, ANewBitstreamStaysIfItIsConfirmed) {
    EXPECT_EQ(powerOn(), 1u);
    expectTriedAndConfirmed();
}

TEST_F(Fpga, AnUnconfirmedBitstreamIsTriedOnce) {
    expectTriedOnce();
}

// This bitstream is signed but invalid. The FPGA hangs, and the next start of the processor reverts
// to the previous bitstream.
TEST_F(Fpga, ABitstreamThatHangsTheFpgaIsRolledBack) {
    powerOn();
    Image image = imageOf(2);
    image.bytes[SLOTS_SYNC_AT + 4] = 0; // no packet
    image.sign(ours);
    receive(image);
    EXPECT_EQ(Slots_settleFpga(&port, 0), 1);
    fpga.configure(flash.memory);
    EXPECT_TRUE(fpga.isStuck);
    EXPECT_EQ(boot(), 1u);
}

TEST_F(Fpga, ABitstreamRefusedByTheFpgaIsReported) {
    powerOn();
    receive(imageOf(2));
    EXPECT_EQ(Slots_settleFpga(&port, 0), 1);
    EXPECT_EQ(Slots_settleFpga(&port, 1), 1);
    EXPECT_EQ(powerOn(), 1u);
    EXPECT_EQ(receiver.reason, RECEIVER_REFUSED);
    EXPECT_EQ(receiver.isOnTrial, 0);
    EXPECT_EQ(Receiver_confirm(&receiver), RECEIVER_OK);
    EXPECT_EQ(receiver.confirmed, 1u);
    updateTo(3);
}

// All other rules are the same as for firmware (update_test.cpp).
TEST_F(Fpga, TheGoldenBitstreamIsNeverOverwritten) {
    updateTo(5);
    const Bytes before = flash.memory;
    EXPECT_EQ(begin(bitstream(6, 0)), RECEIVER_FOREIGN);
    EXPECT_EQ(flash.memory, before);
}

TEST_F(Fpga, AConfirmedVersionIsRememberedAfterItIsErased) {
    updateTo(5);
    EXPECT_EQ(begin(imageOf(6)), RECEIVER_OK);
    EXPECT_EQ(powerOn(), 1u); // version 5 has been erased, and version 6 has not arrived yet
    EXPECT_EQ(begin(imageOf(4)), RECEIVER_OLD);
    updateTo(6);
}

TEST_F(Fpga, ADamagedBitstreamGetsNoSyncWord) {
    powerOn();
    Image image = imageOf(2);
    EXPECT_EQ(begin(image), RECEIVER_OK);
    image.bytes[60'000] ^= 4;
    EXPECT_EQ(send(image), RECEIVER_DAMAGED);
    EXPECT_EQ(powerOn(), 1u);
    updateTo(2);
}

TEST_F(Fpga, OnlySignedAndCompleteBitstreamsAreLoaded) {
    EXPECT_TRUE(Slots_isLoadable(&port, product)); // the golden bitstream may be loaded
    updateTo(2);
    EXPECT_TRUE(Slots_isLoadable(&port, product));
    lists[1] = {second.list(2, second, ours), {}, SLOTS_TRUE};
    // the key that signed version 2 has been withdrawn
    EXPECT_FALSE(Slots_isLoadable(&port, product));
    EXPECT_TRUE(Slots_settleFpga(&port, 1));
    // the golden bitstream may be loaded, because keys of the first list still count for it
    EXPECT_TRUE(Slots_isLoadable(&port, product));
    flash.memory[golden + 5000] ^= 1;
    EXPECT_FALSE(Slots_isLoadable(&port, product));
    flash.memory[golden + 5000] ^= 1;
    flash.memory[golden - SLOTS_IMAGE_AT + 8] ^= 1; // its version
    EXPECT_FALSE(Slots_isLoadable(&port, product));
}

// Cuts the power during an update that replaces an older bitstream.
TEST_F(Fpga, APowerLossAtAnyPointLeavesABootableBitstream) {
    updateTo(2);
    const uint64_t before = flash.operations();
    updateTo(3);
    const uint64_t all = flash.operations() - before;
    ASSERT_GT(all, 250u);
    cutAtEach(
        3, all, all + 60,
        [this](uint64_t seed) -> Fpga& {
            fill(seed);
            cutAt = 0;
            updateTo(2);
            return *this;
        },
        [](Fpga& cut) { return cut.powerOn() == 1; }); // returns true if the golden bitstream runs
}

} // namespace
