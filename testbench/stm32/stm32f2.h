// SPDX-License-Identifier: MIT
//
// stm32f2: models the parts of an STM32F2 that the firmware uses: the Cortex-M3, flash, RAM, FSMC,
// clock, pins, EXTI, CRC unit, watchdog, random number generator and backup SRAM, as described in
// RM0033. An access causes a bus fault in three cases: it goes to any other address, the clock of
// its peripheral is off, or it goes to the FSMC while one of the FSMC's pins has another function.

#pragma once

#include "cortex_m3.h"
#include "elf_image.h"
#include "fpga_pins.h"
#include "fsmc_master.h"
#include "pin_wires.h"
#include "random_block.h"
#include "stm32_flash.h"
#include <array>
#include <deque>
#include <functional>
#include <map>
#include <optional>

class Stm32F2 : private CpuBus {
public:
    struct Config {
        // Number of HCLK cycles of the processor in one HCLK cycle of the FSMC pins. The number is
        // more than 1 if the FPGA's clock is slower than on the board: the FSMC pins are then
        // slower as well, but the processor keeps its speed.
        unsigned coreCyclesPerHclk = 1;
        uint32_t hclkHz = 120'000'000;     // processor clock, Hz in simulated time
        uint64_t seed = 1;                 // seed of the random number generator
        uint32_t oscillatorHz = 8'000'000; // frequency of the clock or crystal at OSC_IN (HSE), Hz
    };
    // Creates the chip. `now` returns simulated time in ns.
    Stm32F2(FsmcMaster& fsmc, std::function<uint64_t()> now, Config config);

    CortexM3& cpu() { return cpu_; }
    Stm32Flash& flash() { return flash_; }
    const ElfImage* image() const { return image_ ? &*image_ : nullptr; }

    void load(const std::string& elf);
    // Loads a program into RAM and starts it, as a debugger does. Call powerOn() first.
    void startInRam(const std::string& elf);
    void powerOn();
    CortexM3::Stop run(bool singleStep = false) { return cpu_.run(singleStep); }
    // Sets the level at one of the pins 0 to 4 of port B, which can be inputs of EXTI.
    void setPinB(unsigned pin, bool high) { setPin(1, pin, high); }
    // Sets a function that is called when time has passed, after each step of the pins. The
    // function returns the time, ns, at which it must be called next. While the processor sleeps,
    // calls before this time may be omitted.
    void onTime(std::function<uint64_t()> called) { onTime_ = std::move(called); }

    // Model of the FPGA's flash, connected to SPI 1 (PA4..7), with PROGRAM_B on PC0 and DONE on
    // PC1. Flash and processor lose power together.
    FpgaPins fpga;

    // Connects the wires of the board to all pins. With a null pointer, only the connections that
    // this class models exist.
    void wire(PinWires* wires) { wires_ = wires; }
    // Returns the function of a pin according to its GPIO registers. Port 0 is A.
    PinSetting pinSetting(unsigned port, unsigned pin) const;

    // Called when the program changes HCLK, with the frequency in Hz. If this function is empty,
    // HCLK stays as configured.
    std::function<void(uint64_t hz)> onHclk;

    // USART 1, with its baud rate: bytes that the firmware has not received yet (PA10), whether
    // this line is in a break, and a function that is called for each byte that the firmware sends.
    std::deque<uint8_t> serialIn;
    bool isSerialBreak = false;
    bool isJumperWired = false; // true if the jumper connects PC2 to ground
    std::function<void(uint8_t)> onSerial;

    // Returns the 4 KiB of SRAM that VBAT preserves through resets and without power.
    std::array<uint32_t, 1024>& backup() { return backup_; }

    // Called when the watchdog expires, before it resets the processor.
    std::function<void()> onWatchdog;

    struct Resets {
        unsigned power = 0, software = 0, watchdog = 0;
    };
    const Resets& resets() const { return resets_; }

private:
    uint32_t read(uint32_t address, unsigned bytes) override;
    void write(uint32_t address, unsigned bytes, uint32_t value) override;
    void writeFlash(uint32_t offset, unsigned bytes, uint32_t value) override;
    void pass(unsigned cycles) override;
    unsigned sleep(unsigned limit) override;
    void lookAround();
    unsigned takeWaited() override;

    uint32_t readPeripheral(uint32_t address);
    void writePeripheral(uint32_t address, uint32_t value);
    uint64_t hclk();
    void checkWaitStates();
    struct Peripheral;
    static const Peripheral peripherals[];
    const Peripheral& peripheralAt(uint32_t address) const;
    static Error noRegister();
    uint32_t& storedIn(uint32_t base, uint32_t offset, uint32_t bytes);
    bool isSet(uint32_t address, unsigned bit) const;
    void requireFsmc();
    void waitForFlash();
    void setPin(unsigned port, unsigned pin, bool high);
    void updateExti();
    void updateFpgaPins();
    void followFpga();
    bool drivesLow(uint32_t port, unsigned pin) const;
    void resetPeripherals();
    // Functions that read and write a word of each peripheral, at an offset.
    uint32_t readGpio(uint32_t offset), readCrc(uint32_t offset), readBackup(uint32_t offset),
        readRandom(uint32_t offset), readPower(uint32_t offset), readUsart(uint32_t offset),
        readSpi(uint32_t offset), readSyscfg(uint32_t offset), readRcc(uint32_t offset),
        readExti(uint32_t offset), readFlashInterface(uint32_t offset),
        readWatchdog(uint32_t offset);
    void writeGpio(uint32_t offset, uint32_t value), writeCrc(uint32_t offset, uint32_t value),
        writeBackup(uint32_t offset, uint32_t value), writeRandom(uint32_t offset, uint32_t value),
        writePower(uint32_t offset, uint32_t value), writeUsart(uint32_t offset, uint32_t value),
        writeSpi(uint32_t offset, uint32_t value), writeSyscfg(uint32_t offset, uint32_t value),
        writeRcc(uint32_t offset, uint32_t value), writeExti(uint32_t offset, uint32_t value),
        writeFlashInterface(uint32_t offset, uint32_t value),
        writeWatchdog(uint32_t offset, uint32_t value);
    uint64_t watchdogNs() const;
    uint32_t& stored(uint32_t address) { return registers_[address]; }

    FsmcMaster& fsmc_;
    std::function<uint64_t()> now_;
    Config config_;
    PinWires* wires_ = nullptr;
    std::function<uint64_t()> onTime_;
    uint64_t wantedNs_ = 0; // time at which the function set by onTime wants to be called next, ns
    CortexM3 cpu_;
    Stm32Flash flash_;
    std::optional<ElfImage> image_;
    std::map<uint32_t, uint32_t> registers_; // registers that only store the written value
    RandomBlock random_{config_.seed};
    std::array<uint32_t, 1024> backup_{};
    unsigned carry_ = 0, waited_ = 0;
    uint32_t resetFlags_ = 0, crc_ = 0xFFFFFFFF, pendingExti_ = 0;
    uint32_t pins_[2] = {0x410, 2}; // levels of the pins of ports A and B
    bool fsmcUsable_ = false, lineChanged_ = false;
    uint64_t fpgaEdgeNs_ = ~0ull; // time of the next change of the pin PA4, ns
    uint64_t spiTaken_ = 0;       // number of bytes from the FPGA that the program has received
    uint8_t spiIn_ = 0xFF;
    struct {
        bool on = false, unlocked = false, fired = false;
        uint32_t prescaler = 0, reload = 0xFFF;
        uint64_t due = ~0ull;
    } watchdog_;
    Resets resets_;
};
