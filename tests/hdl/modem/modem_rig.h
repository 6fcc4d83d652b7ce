// SPDX-License-Identifier: MIT
//
// modem_rig: connects the modem controller to its memory and to a modem at its pins; a second modem
// is reached over the air.

#pragma once

#include "bench.h"
#include "bus_master.h"
#include "modem_regs.h"
#include "npi_memory.h"
#include "rf_channel.h"
#include "xbee.h"
#include <gtest/gtest.h>

// A test bench of the modem controller. `clkNs` is the clock period that belongs to the module's
// CLK_HZ.
template <class Module, uint64_t clkNs> class ModemRig : public ::testing::Test {
protected:
    static constexpr uint32_t txRing = 0xAAAAA800,
                              // together, the two addresses set every address line to 0 and to 1
        rxRing = 0x55555000;

    void power(XBee::Options options) {
        // the air is perfect, because these tests only test the controller
        air_.weather.perfect = true;
        near_ = std::make_unique<XBee>(pins_, air_, options);
        XBee::Options far;
        far.name = "far";
        far.set = {{"MY", 0x0000}, {"DL", 0x0001}, {"BD", 7}};
        far_ = std::make_unique<XBee>(plain_, air_, far);
        air_.onPacket([this](uint64_t, const RfPacket& packet, RfChannel::Outcome) {
            sizes_.push_back(packet.bytes.size());
            targets_.push_back(packet.to);
        });
        bench_.addModel([this] { sample(); }, [this] { drive(); });
        bench_.addClock([this] { movePins(); });
        bench_.reset();
        bus_.write(MODEM_MASK, 0x7F);
        bus_.write(MODEM_ADDR, 0x0000u << 16 | 0x0001u);
        bus_.write(MODEM_TX_BASE, txRing);
        bus_.write(MODEM_RX_BASE, rxRing);
        bus_.write(MODEM_NET, 0x3332u << MODEM_NET_PAN_LSB | 0x0C);
    }

    // Sets up the modem. The guard times of modem and controller are short, to make the tests
    // short.
    void configure(unsigned bd = 7, unsigned guardMs = 20) {
        bus_.write(MODEM_BAUD, guardMs << MODEM_BAUD_GUARD_MS_LSB | bd);
        bus_.write(MODEM_CONTROL, MODEM_CONTROL_CONFIGURE_MASK);
        bench_.waitFor([&] { return bench_.top().irq_o; }, "the end of the set-up", 40'000'000);
        // A command that is tried at a wrong baud rate may be sent as data, unless the modem is
        // still booting. Such data is discarded here.
        plain_.received.clear();
        sizes_.clear();
        targets_.clear();
    }
    uint32_t takeEvents() { return bus_.takeEvents(); }
    void runMs(double ms) {
        for (uint64_t end = bench_.cycles() + static_cast<uint64_t>(ms * 1e6 / clkNs);
             bench_.cycles() < end;)
            bench_.tick();
    }
    uint64_t now() const { return bench_.cycles() * clkNs; }
    static XBee::Options quick(std::map<std::string, uint32_t> more = {}) {
        XBee::Options options;
        options.set = {{"GT", 20}};
        for (auto& [letters, value] : more)
            options.set[letters] = value;
        return options;
    }
    void put(unsigned buffer, const std::vector<uint8_t>& packet) {
        memory_.store(txRing + 128 * buffer, packet);
        bus_.write(MODEM_TX_PUT, static_cast<uint32_t>(packet.size()));
    }
    // Returns a packet like the packets of the link layer, in which the first byte is the length.
    static std::vector<uint8_t> frame(unsigned size, uint8_t tag) {
        std::vector<uint8_t> bytes(size, tag);
        bytes[0] = static_cast<uint8_t>(size - 5);
        return bytes;
    }
    // oldest() returns the oldest packet in the ring, or an empty packet; take() also releases it.
    std::vector<uint8_t> oldest() {
        const uint32_t get = bus_.read(MODEM_RX_GET);
        const bool isValid = get & MODEM_RX_GET_VALID_MASK;
        return memory_.bytes(rxRing + 128 * (get >> 8 & 0xFF),
                             isValid ? get & MODEM_RX_GET_BYTES_MASK : 0);
    }
    std::vector<uint8_t> take() {
        auto packet = oldest();
        if (!packet.empty())
            bus_.write(MODEM_RX_RELEASE, 1);
        return packet;
    }

    // Returns the error counters, except the counter of set-up retries: the set-up may need retries
    // to find the baud rate.
    uint32_t errors() { return bus_.read(MODEM_ERRORS) & ~MODEM_ERRORS_RETRIES_MASK; }
    // Drives the line bit by bit in place of the modem's model, which cannot do this. The model is
    // silent during this time.
    void bytesIn(const std::vector<uint8_t>& bytes, unsigned bitClocks) {
        for (uint8_t byte : bytes)
            for (unsigned bits = byte << 1 | 0x200; bits > 0; bits >>= 1) {
                noise_ = !(bits & 1);
                bench_.tick(bitClocks);
            }
    }

    Bench<Module> bench_;
    BusMaster<Module> bus_{bench_};
    NpiMemory<Module> memory_{bench_, 0.3, testSeed()};
    RfChannel air_{testSeed()};
    UartPins pins_;
    HostLine plain_;
    std::unique_ptr<XBee> near_, far_;
    std::vector<size_t> sizes_; // sizes of the packets that were sent on the air
    std::vector<uint16_t> targets_;
    bool pinsIgnoreRts_ = false;
    bool noise_ = false; // true: the line to the controller is held low
    bool ctsWavers_ = false;

private:
    void sample() {
        if (bench_.top().modem_txd_o != txd_) {
            txd_ = bench_.top().modem_txd_o;
            pins_.setTxd(txd_, now());
        }
        near_->resetPin(!bench_.top().modem_reset_n_o, now());
        if (bench_.top().modem_rts_n_o != rtsN_) {
            rtsN_ = bench_.top().modem_rts_n_o;
            pins_.setRts(!rtsN_ || pinsIgnoreRts_, now());
        }
    }
    void drive() {
        air_.advance(now());
        near_->advance(now());
        far_->advance(now());
    }
    // Changes pins in the second half of a clock, like pins that belong to another clock.
    void movePins() {
        if (bench_.top().clk_i)
            return;
        bench_.top().modem_rxd_i = pins_.rxd() && !noise_;
        bench_.top().modem_cts_n_i = pins_.ctsN() || (ctsWavers_ && wavering_.chance(0.5));
    }
    Random wavering_{testSeed()};
    bool txd_ = true, rtsN_ = false;
};
