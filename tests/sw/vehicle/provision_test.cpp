// SPDX-License-Identifier: MIT
//
// provision_test: tests that the ground's program can set a key in the firmware's ARM binary over
// the processor's serial port, which is a pseudo-terminal here.

#include "stm32f2.h"
#include <algorithm>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

namespace {

class Provision : public ::testing::Test {
protected:
    Provision() {
        chip.load(FIRMWARE "uav.elf");
        chip.onSerial = [this](uint8_t byte) { said += static_cast<char>(byte); };
        chip.onTime([this] {
            if (chip.cpu().cycles() >= limit || (!said.empty() && said.back() == '\n'))
                chip.cpu().stop();
            return uint64_t(0);
        });
    }
    // Runs until the firmware has sent a line, or for this number of cycles. Returns the line.
    std::string run(uint64_t cycles = 10'000'000) {
        said.clear();
        limit = chip.cpu().cycles() + cycles;
        chip.run();
        return said;
    }
    // Starts the firmware while there is a break on the line, and then ends the break.
    std::string start() {
        chip.isSerialBreak = true;
        chip.powerOn();
        run(2'000'000);
        chip.isSerialBreak = false;
        return run();
    }
    std::string answerTo(const std::string& line) {
        chip.serialIn.insert(chip.serialIn.end(), line.begin(), line.end());
        return run();
    }
    // Starts the firmware during a break, and sends it a line.
    std::string startAndAnswer(const std::string& line) {
        start();
        return answerTo(line + "\n");
    }
    // Returns true if the battery-backed memory contains this key (uav_keys.h) and this address. An
    // empty `key` means that the vehicle accepts links without a key.
    bool has(const std::vector<uint8_t>& key, uint32_t address = 0x2A) {
        std::array<uint32_t, 4> words = {};
        for (size_t i = 0; i < key.size(); ++i)
            words[i / 4] |= uint32_t(key[i]) << 8 * (i % 4);
        constexpr uint32_t open = 0x4F50454E;
        return std::equal(words.begin(), words.end(), chip.backup().begin()) &&
               (chip.backup()[10] == open) == key.empty() && chip.backup()[12] == address;
    }

    std::string said;
    uint64_t limit = 0;
    FsmcPins pins;
    FsmcMaster fsmc{pins, {[] {}, [] {}, [](uint64_t clocks, uint64_t) { return clocks; }}};
    Stm32F2 chip{fsmc, [this] { return fsmc.hclks() * 25 / 3; }, {}};
};

const std::string prompt = "icesoc: key? (read protection is off: anyone who opens the vehicle can "
                           "read its key)\r\n";
const std::string digits = "00112233445566778899aabbccddeeff", at = " 002a";
const std::vector<uint8_t> key = {0x00, 0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77,
                                  0x88, 0x99, 0xAA, 0xBB, 0xCC, 0xDD, 0xEE, 0xFF};

TEST_F(Provision, AcceptsAKeyOrOpensTheVehicle) {
    EXPECT_EQ(start(), prompt);
    EXPECT_EQ(answerTo("key " + digits + at + "\n"), "ok\r\n");
    EXPECT_TRUE(has(key));
    EXPECT_EQ(start(), prompt);
    EXPECT_EQ(answerTo("open beef " + digits + "\r\n"), "ok\r\n");
    EXPECT_TRUE(has({}, 0xBEEF));
}

TEST_F(Provision, AChangeNeedsTheOldKeyOrTheJumper) {
    const std::string other(32, 'a');
    startAndAnswer("key " + digits + at);
    for (const std::string& line : {"key " + other + at, "open" + at,
                                    "key " + other + at + " " + other, "open" + at + " " + other}) {
        EXPECT_EQ(startAndAnswer(line), "no: it has a key; append it, or fit the jumper\r\n")
            << line;
        EXPECT_TRUE(has(key)) << line;
    }
    chip.isJumperWired = true;
    EXPECT_EQ(startAndAnswer("key " + other + at), "ok\r\n");
    EXPECT_TRUE(has(std::vector<uint8_t>(16, 0xAA)));
    chip.isJumperWired = false;
    EXPECT_EQ(startAndAnswer("key " + digits + at + " " + other), "ok\r\n");
    EXPECT_TRUE(has(key));
}

TEST_F(Provision, AcceptsASecondGroundWithASeparateKey) {
    const std::string other(32, 'a');
    startAndAnswer("key " + digits + at);
    EXPECT_EQ(startAndAnswer("ground 00f0 " + other).substr(0, 3), "no:");
    EXPECT_EQ(chip.backup()[27], 0u);
    EXPECT_EQ(startAndAnswer("ground 00f0 " + other + " " + digits), "ok\r\n");
    EXPECT_EQ(chip.backup()[27], ~0xF0u);
    EXPECT_EQ(chip.backup()[16], 0xAAAAAAAAu);
    EXPECT_TRUE(has(key));
    EXPECT_EQ(startAndAnswer("fellow 0007 " + other + " " + digits), "ok\r\n");
    EXPECT_EQ(chip.backup()[43], ~7u);
    EXPECT_EQ(chip.backup()[32], 0xAAAAAAAAu);
    EXPECT_EQ(chip.backup()[27], ~0xF0u) << "the second ground station must be kept";
    EXPECT_EQ(startAndAnswer("ground 00f0 " + other + " " + other).substr(0, 3), "no:")
        << "the key of the second ground station must not authorise this change";
}

TEST_F(Provision, AcceptsTheGroupKey) {
    startAndAnswer("key " + digits + at);
    EXPECT_EQ(startAndAnswer("group 06dacba9 " + std::string(32, 'a')).substr(0, 3), "no:");
    EXPECT_EQ(chip.backup()[58], 0u)
        << "the command must be refused, because the present key is missing";
    EXPECT_EQ(startAndAnswer("group 06dacba9 " + std::string(32, 'a') + " " + digits), "ok\r\n");
    EXPECT_EQ(chip.backup()[58], 0x06DACBA9u);
    EXPECT_EQ(chip.backup()[48], 0xAAAAAAAAu);
    EXPECT_EQ(chip.backup()[27], ~0xFFFFFFFFu) << "the vehicle has no second ground station";
    EXPECT_TRUE(has(key));
}

TEST_F(Provision, ReportsMissingReadProtectionAndSetsIt) {
    EXPECT_EQ(start(), prompt);
    EXPECT_EQ(answerTo("protect\n"), "ok\r\n");
    EXPECT_EQ(start(), "icesoc: key?\r\n");
    answerTo("key " + digits + at + "\n");
    EXPECT_EQ(chip.flash().protection(), 0x55);
    EXPECT_TRUE(has(key));
}

TEST_F(Provision, InvalidLinesChangeNothing) {
    startAndAnswer("key " + digits + at);
    for (const std::string& line :
         {"key " + digits.substr(1) + at, "key " + digits + "0" + at,
          "key x" + digits.substr(1) + at, "key " + digits, "key " + digits + " ",
          "key " + digits + " 02a", "key " + digits + at + "0", "key " + digits + at + " ",
          "open " + digits, std::string("open  002a"), "protect " + digits, "Open" + at,
          std::string("key"), std::string(""), std::string(200, 'k')}) {
        EXPECT_EQ(start(), prompt);
        EXPECT_EQ(answerTo(line + "\n").substr(0, 3), "no:") << line;
        EXPECT_TRUE(has(key)) << line;
        chip.serialIn.clear();
    }
}

TEST_F(Provision, WithoutABreakNothingIsAccepted) {
    chip.powerOn();
    EXPECT_EQ(answerTo("key " + digits + at + "\n"), "");
    EXPECT_FALSE(has(key));
}

// The model waits for the program, so the result does not depend on the program's speed.
TEST_F(Provision, TheProgramOfTheGroundSendsTheKey) {
    const std::string file = FOLDER + std::to_string(getpid()) + ".key";
    std::ofstream(file) << "# demo\n0x0001 " << std::string(32, 'a') << "\n0x002A " << digits
                        << "\n";
    ::chmod(file.c_str(), 0600);
    const std::string other = std::string("/usr/bin/python3 ") + PROVIDE_KEY + " --key " + file +
                              " --port /dev/null --address 0x0003 2>&1 | grep -q 0x0003";
    EXPECT_EQ(std::system(other.c_str()), 0) << "the file has no line for this vehicle";
    std::ofstream(file + ".wrong") << digits << "\n\xff\n";
    ::chmod((file + ".wrong").c_str(), 0600);
    const std::string senseless = std::string("/usr/bin/python3 ") + PROVIDE_KEY + " --key " +
                                  file +
                                  ".wrong --port /dev/null 2>&1 | grep -q 'line 2: expected'";
    EXPECT_EQ(std::system(senseless.c_str()), 0);
    const std::string group = std::string("/usr/bin/python3 ") + PROVIDE_KEY + " --key " + file +
                              " --port /dev/null --group 2>&1 | grep -q 'no line.* 0xffff'";
    EXPECT_EQ(std::system(group.c_str()), 0)
        << "the line of a vehicle must not be used for the group";
    const int port = posix_openpt(O_RDWR | O_NOCTTY);
    ASSERT_TRUE(port >= 0 && grantpt(port) == 0 && unlockpt(port) == 0);
    const std::string name = ptsname(port);
    // stays open, because otherwise a write before the program opens the port would be lost
    const int held = open(name.c_str(), O_RDWR | O_NOCTTY);
    const pid_t child = fork();
    if (child == 0) {
        execl("/usr/bin/python3", "python3", PROVIDE_KEY, "--port", name.c_str(), "--key",
              file.c_str(), "--address", "0x002a", nullptr);
        _exit(127);
    }
    // the firmware sends no prompt, because the program holds a break on the line
    usleep(1'000'000);
    std::string line;
    // The vehicle sends its prompt more often than every 0.5 s, which is the time for which the
    // program listens between two breaks.
    for (int tries = 0; tries < 300 && line.find('\n') == std::string::npos; ++tries) {
        const std::string asked = start();
        ASSERT_EQ(write(port, asked.data(), asked.size()), ssize_t(asked.size()));
        pollfd wanted = {port, POLLIN, 0};
        char bytes[64];
        if (poll(&wanted, 1, 300) > 0)
            line.append(bytes,
                        static_cast<size_t>(std::max<ssize_t>(0, read(port, bytes, sizeof bytes))));
    }
    const std::string answer = answerTo(line);
    ASSERT_EQ(write(port, answer.data(), answer.size()), ssize_t(answer.size()));
    int status = -1;
    waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
    EXPECT_TRUE(has(key));
    close(held);
    close(port);
    std::filesystem::remove(file);
}

} // namespace
