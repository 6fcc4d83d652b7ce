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

// A line as a device sees it: a level counts once it has lasted longer than the spikes of up to
// 50 ns which a device must not see (UM10204, table 10: tSP). This core makes one: it lets go of
// SDA for one clock when it sees its own start, as its slave half then resets the master half
// (slave_reset in i2c_master_byte_ctrl.v).
class Filtered {
public:
    // Once each clock; true when the level changes.
    bool see(bool now) {
        clocks_ = now == level ? 0 : clocks_ + 1;
        if (clocks_ <= spikeClocks)
            return false;
        level = now;
        clocks_ = 0;
        return true;
    }
    bool level = true;

private:
    static constexpr int spikeClocks = 5; // 50 ns at 100 MHz
    int clocks_ = 0;
};

class I2cMaster : public ::testing::Test {
protected:
    // The line: pulled up; the device samples at SCL's rise and acknowledges the ninth bit of its
    // address.
    void tick() {
        auto& top = slot_.bench_.top();
        bool scl = !top.scl_low_o;
        bool sda = !top.sda_low_o && !(acknowledges_ && bits_ == 8);
        bool clocked = scl_.see(scl), changed = sda_.see(sda);
        if (changed && !clocked && scl_.level) {
            (sda_.level ? stops_ : starts_)++;
            bits_ = 0;
        } else if (clocked && scl_.level) {
            byte_ = taken_++ < 8 ? byte_ << 1 | sda_.level : byte_;
        } else if (clocked && starts_ && ++edges_ > 1) {
            bits_ = bits_ == 8 ? 0 : bits_ + 1;
        }
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
        for (int i = 0; i < 1000; ++i)
            tick(); // the core's line falls, and the stop goes over the wire
        slot_.bus_.write(I2C_MASTER_EVENT, I2C_MASTER_EVENT_CORE_MASK);
        EXPECT_FALSE(slot_.bench_.top().irq_o);
        return acknowledged;
    }

    CoreSlot<Vi2c_master_slot> slot_;
    Filtered scl_, sda_;
    bool acknowledges_ = true;
    int taken_ = 0, bits_ = 0, edges_ = 0, starts_ = 0, stops_ = 0;
    unsigned byte_ = 0;
};

TEST_F(I2cMaster, SendsAByteToADeviceThatAnswers) {
    EXPECT_EQ(slot_.bus_.read(I2C_MASTER_ID), I2C_MASTER_ID_VALUE);
    for (bool answers : {true, false}) {
        acknowledges_ = answers;
        slot_.bus_.write(I2C_MASTER_PRER_LO, 49); // 400 kHz at 100 MHz
        slot_.bus_.write(I2C_MASTER_PRER_HI, 0);
        slot_.bus_.write(I2C_MASTER_CTR, 0xC0);
        slot_.bus_.write(I2C_MASTER_MASK, I2C_MASTER_MASK_CORE_MASK);
        for (int i = 0; i < 200; ++i)
            tick(); // the line is high before anything is sent
        EXPECT_EQ(slot_.bus_.read(I2C_MASTER_PRER_LO), 49u);
        starts_ = stops_ = edges_ = bits_ = taken_ = 0;
        byte_ = 0;
        EXPECT_EQ(send(0xA6), answers);
        EXPECT_EQ(byte_ & 0xFF, 0xA6u);
        EXPECT_EQ(starts_, 1);
        EXPECT_EQ(stops_, 1);
        EXPECT_EQ(slot_.errors_, 0u);
    }
}

} // namespace
