// SPDX-License-Identifier: MIT
//
// i2c_master_test: the foreign core sends a byte, and a device on the line acknowledges it, or does
// not.

#include "Vi2c_master_slot.h"
#include "core_slot.h"
extern "C" {
#include "i2c_master_regs.h"
}

namespace {

class I2cMaster : public ::testing::Test {
protected:
    // The line: pulled up; the device samples at SCL's rise and acknowledges the ninth bit of its
    // address.
    void tick() {
        auto& top = slot_.bench_.top();
        bool scl = !top.scl_low_o;
        bool sda = !top.sda_low_o && !(acknowledges_ && bits_ == 8);
        if (scl && wasHigh_ && sda != wasData_) {
            starts_ += !sda;
            stops_ += sda;
            bits_ = 0;
        } else if (scl && !wasHigh_) {
            byte_ = taken_++ < 8 ? byte_ << 1 | sda : byte_;
        } else if (!scl && wasHigh_ && starts_ && ++edges_ > 1) {
            bits_ = bits_ == 8 ? 0 : bits_ + 1;
        }
        wasHigh_ = scl;
        wasData_ = sda;
        top.scl_i = scl;
        top.sda_i = sda;
        slot_.bench_.tick();
    }
    // Sends the byte with start and stop, until the core's interrupt; true if somebody acknowledged
    // it.
    bool send(uint32_t byte) {
        slot_.bus_.write(I2C_MASTER_DATA, byte);
        slot_.bus_.write(I2C_MASTER_COMMAND, 0x80 | 0x40 | 0x10);
        for (int i = 0; i < 20000 && !slot_.bench_.top().irq_o; ++i)
            tick();
        EXPECT_TRUE(slot_.bench_.top().irq_o) << "no interrupt in 20000 clocks";
        bool acknowledged = !(slot_.bus_.read(I2C_MASTER_COMMAND) & 0x80);
        slot_.bus_.write(I2C_MASTER_COMMAND, 0x01);
        for (int i = 0; i < 100; ++i)
            tick(); // the core's line falls, and the stop goes over the wire
        slot_.bus_.write(I2C_MASTER_EVENT, I2C_MASTER_EVENT_CORE_MASK);
        EXPECT_FALSE(slot_.bench_.top().irq_o);
        return acknowledged;
    }

    CoreSlot<Vi2c_master_slot> slot_;
    bool acknowledges_ = true, wasHigh_ = true, wasData_ = true;
    int taken_ = 0, bits_ = 0, edges_ = 0, starts_ = 0, stops_ = 0;
    unsigned byte_ = 0;
};

TEST_F(I2cMaster, SendsAByteToADeviceThatAnswers) {
    EXPECT_EQ(slot_.bus_.read(I2C_MASTER_ID), I2C_MASTER_ID_VALUE);
    for (bool answers : {true, false}) {
        acknowledges_ = answers;
        slot_.bus_.write(I2C_MASTER_PRER_LO, 4);
        slot_.bus_.write(I2C_MASTER_PRER_HI, 0);
        slot_.bus_.write(I2C_MASTER_CTR, 0xC0);
        slot_.bus_.write(I2C_MASTER_MASK, I2C_MASTER_MASK_CORE_MASK);
        for (int i = 0; i < 200; ++i)
            tick(); // the line is high before anything is sent
        EXPECT_EQ(slot_.bus_.read(I2C_MASTER_PRER_LO), 4u);
        starts_ = stops_ = edges_ = bits_ = taken_ = 0;
        byte_ = 0;
        EXPECT_EQ(send(0xA6), answers);
        EXPECT_EQ(byte_ & 0xFF, 0xA6u);
        EXPECT_GE(starts_, 1);
        EXPECT_GE(stops_, 1);
        EXPECT_EQ(slot_.errors_, 0u);
    }
}

} // namespace
