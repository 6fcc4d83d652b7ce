// SPDX-License-Identifier: MIT
//
// axil_uart_test: the foreign core sends bytes to a device on its line, and gets the device's.

#include "Vaxil_uart_slot.h"
#include "core_slot.h"
#include "serial_line.h"
#include <deque>
extern "C" {
#include "axil_uart_regs.h"
}

namespace {

constexpr int clocksOfBit = 100, clockNs = 10;

// The device at the other end of the line.
class Device : public SerialClient {
public:
    void fromHost(uint8_t byte, uint64_t) override { received.push_back(byte); }
    void framingError(uint64_t) override { ++broken; }
    bool nextToHost(uint8_t& byte) override {
        if (toSend.empty())
            return false;
        byte = toSend.front();
        toSend.pop_front();
        return true;
    }
    std::deque<uint8_t> toSend;
    std::vector<uint8_t> received;
    int broken = 0; // bytes without a stop bit
};

TEST(AxilUart, ExchangesBytesWithADevice) {
    CoreSlot<Vaxil_uart_slot> slot;
    auto& top = slot.bench_.top();
    Device device;
    UartPins line;
    line.attach(&device);
    line.setBitTime(clocksOfBit * clockNs);
    uint64_t now = 0; // ns
    top.rx_i = 1;
    slot.bench_.addModel([] {},
                         [&] {
                             now += clockNs;
                             line.setTxd(top.tx_o, now);
                             line.advance(now);
                             top.rx_i = line.rxd();
                         });
    EXPECT_EQ(slot.bus_.read(AXIL_UART_ID), AXIL_UART_ID_VALUE);
    EXPECT_EQ(slot.bus_.read(AXIL_UART_SETUP) & 0xFFFFFF, 868u);
    slot.bus_.write(AXIL_UART_SETUP, clocksOfBit);
    EXPECT_EQ(slot.bus_.read(AXIL_UART_SETUP) & 0xFFFFFF, static_cast<uint32_t>(clocksOfBit));
    slot.bus_.write(AXIL_UART_MASK, AXIL_UART_MASK_CORE_MASK);
    for (int i = 0; i < 20 * clocksOfBit; ++i)
        slot.bench_.tick(); // both sides see an idle line
    EXPECT_FALSE(top.irq_o);
    EXPECT_TRUE(slot.bus_.read(AXIL_UART_RX) & 1u << 8) << "nothing has come";

    const std::vector<uint8_t> up = {'$', 'G', 'P', 'G', 'G', 'A'}, down = {0xA5, 0x00, 0xFF, 0x3C};
    device.toSend.assign(up.begin(), up.end());
    line.wake(now);
    for (uint8_t byte : down)
        slot.bus_.write(AXIL_UART_TX, byte);
    std::vector<uint8_t> got;
    while (got.size() < up.size()) {
        slot.bench_.waitFor([&] { return top.irq_o; }, "a byte from the device", 30 * clocksOfBit);
        uint32_t word = slot.bus_.read(AXIL_UART_RX);
        EXPECT_EQ(word >> 8, 0u) << "no error of any kind";
        got.push_back(static_cast<uint8_t>(word));
        for (int i = 0; i < 4; ++i)
            slot.bench_.tick(); // the core's line falls
        slot.bus_.write(AXIL_UART_EVENT, AXIL_UART_EVENT_CORE_MASK);
    }
    EXPECT_EQ(got, up);
    slot.bench_.waitFor([&] { return device.received.size() == down.size(); }, "the last byte",
                        50 * clocksOfBit);
    EXPECT_EQ(device.received, down);
    EXPECT_EQ(device.broken, 0);
    EXPECT_EQ(slot.errors_, 0u);
}

} // namespace
