// SPDX-License-Identifier: MIT
//
// table1_test: runs the simulator with the netlist of Table I's blocks instead of the chip. The
// processor writes and reads memory and registers, the modem is set up from its factory settings,
// and packets are sent in both directions.

#include "map_regs.h"
#include "modem_regs.h"
#include "random.h"
#include "soc_model.h"
#include <algorithm>
#include <cstring>
#include <gtest/gtest.h>

namespace {

constexpr uint32_t ddr = MAP_DDR_WINDOW, slot = MAP_CONTROL_WINDOW + 64 * MAP_SLOT_MODEM;
// together, these addresses set many address lines to 0 and to 1
constexpr uint32_t txRing = 0x02AAA800, rxRing = 0x01555000;

XBee::Options options(const char* name, std::map<std::string, uint32_t> set) {
    XBee::Options o;
    o.name = name;
    o.set = std::move(set);
    return o;
}

class Table1 : public ::testing::Test {
protected:
    void SetUp() override {
        air_.weather.perfect = true;
        chip_.reset();
        for (uint32_t bank : {0u, 1u}) {
            fsmc_.write32(0xA0000004 + 8 * bank, 0x00010402);
            fsmc_.write32(0xA0000000 + 8 * bank, 0x00009091);
        }
        chip_.onTime([this](uint64_t now) {
            far_.advance(now);
            // at least every 0.1 ms, because bytes on the line may cause new events
            return std::min(far_.nextEvent(), now + 100'000);
        });
    }
    uint32_t read(uint32_t word) { return fsmc_.read32(slot + 4 * word); }
    void write(uint32_t word, uint32_t value) { fsmc_.write32(slot + 4 * word, value); }
    template <class Done> void tickUntil(Done done, const char* what) {
        for (const uint64_t end = chip_.cycles() + 20 * SocModel::clkHz; !done(); chip_.tick())
            ASSERT_LT(chip_.cycles(), end) << what;
    }

    RfChannel air_{testSeed()};
    HostLine host_;
    XBee far_{host_, air_, options("far", {{"MY", 0x0000}, {"DL", 0x0001}, {"BD", 7}})};
    SocModel chip_{air_, options("near", {{"GT", 20}})};
    FsmcMaster& fsmc_ = chip_.fsmc();
};

TEST_F(Table1, MemoryKeepsWrittenData) {
    Random random(testSeed());
    for (int i = 0; i < 500; ++i) {
        const uint32_t place = random.below(1 << 24) << 2, value = random.next();
        fsmc_.write32(ddr + place, value);
        EXPECT_EQ(fsmc_.read32(ddr + place), value);
        EXPECT_EQ(std::memcmp(chip_.memory().data() + place, &value, 4), 0);
    }
}

TEST_F(Table1, TheModemIsSetUpAndPacketsPassInBothDirections) {
    EXPECT_EQ(read(MODEM_ID), MODEM_ID_VALUE);
    write(MODEM_MASK, 0x7F);
    write(MODEM_ADDR, 0x0000u << 16 | 0x0001u);
    write(MODEM_TX_BASE, txRing);
    write(MODEM_RX_BASE, rxRing);
    write(MODEM_NET, 0x3332u << MODEM_NET_PAN_LSB | 0x0C);
    write(MODEM_BAUD, 20 << MODEM_BAUD_GUARD_MS_LSB | 7);
    EXPECT_FALSE(chip_.irq());
    write(MODEM_CONTROL, MODEM_CONTROL_CONFIGURE_MASK);
    tickUntil([&] { return chip_.irq(); }, "the set-up");
    EXPECT_EQ(read(MODEM_EVENT), MODEM_EVENT_CONFIGURED_MASK);
    write(MODEM_EVENT, MODEM_EVENT_CONFIGURED_MASK);

    std::vector<uint8_t> packet(60);
    for (uint8_t n = 1; n < packet.size(); ++n)
        packet[n] = static_cast<uint8_t>(37 * n);
    packet[0] = 55; // the first byte of a packet is its length
    for (uint32_t n = 0; n < packet.size(); n += 4) {
        uint32_t word;
        std::memcpy(&word, &packet[n], 4);
        fsmc_.write32(ddr + txRing + n, word);
    }
    host_.received.clear(); // discards bytes that the search for the baud rate has sent
    write(MODEM_TX_PUT, static_cast<uint32_t>(packet.size()));
    tickUntil([&] { return host_.received.size() >= packet.size(); }, "a packet to the ground");
    EXPECT_EQ(host_.received, packet);

    host_.send(packet, chip_.now());
    tickUntil([&] { return read(MODEM_RX_GET) & MODEM_RX_GET_VALID_MASK; }, "one from there");
    const uint32_t get = read(MODEM_RX_GET), buffer = ddr + rxRing + 128 * (get >> 8 & 0xFF);
    EXPECT_EQ(get & MODEM_RX_GET_BYTES_MASK, packet.size());
    for (uint32_t n = 0; n < packet.size(); ++n)
        EXPECT_EQ(fsmc_.read8(buffer + n), packet[n]) << n;
}

} // namespace
