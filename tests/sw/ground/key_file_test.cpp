// SPDX-License-Identifier: MIT
//
// key_file_test: tests which key files are accepted, and the messages about files that are
// rejected.

#include "key_file.h"
#include <cstdio>
#include <fstream>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

namespace {

using namespace XBeeAT;

const std::string a = "00112233445566778899AABBCCDDEEFF", b = "0102030405060708090a0b0c0d0e0f10";

class KeyFiles : public testing::Test {
protected:
    KeyFiles() { close(mkstemp(path_)); }
    ~KeyFiles() override { std::remove(path_); }
    KeyFile read(const std::string& text, mode_t mode = 0600) {
        std::ofstream(path_) << text;
        chmod(path_, mode);
        return KeyFile(path_);
    }
    // Returns the message with which a file is rejected, or "" if it is accepted. Checks that the
    // message does not contain the beginning of the key.
    std::string refusal(const std::string& text, mode_t mode = 0600) {
        try {
            read(text, mode);
        } catch (const std::runtime_error& e) {
            EXPECT_EQ(std::string(e.what()).find(a.substr(0, 8)), std::string::npos) << e.what();
            return e.what();
        }
        return "";
    }
    char path_[32] = "/tmp/key_file_test_XXXXXX";
};

TEST_F(KeyFiles, OneKeyMayServeAllVehicles) {
    const KeyFile file = read(a + "\n");
    for (int address : {0, 1, 0xFFFE}) {
        ASSERT_EQ(file.of(address).size(), 1u);
        EXPECT_EQ(file.of(address)[0][1], 0x11);
        EXPECT_EQ(file.of(address)[0][15], 0xFF);
    }
}

TEST_F(KeyFiles, ByteOrderMarksAndCarriageReturnsAreIgnored) {
    EXPECT_EQ(read("\xEF\xBB\xBF" + a + "\r\n").of(1)[0][1], 0x11);
}

TEST_F(KeyFiles, EachVehicleHasALineAndTheNextKeyIsFirst) {
    const KeyFile file = read("# fleet\n0x0001 " + a + "\n\n0xBEEF " + b + " " + a + " # soon\n");
    EXPECT_EQ(file.of(1).size(), 1u);
    ASSERT_EQ(file.of(0xBEEF).size(), 2u);
    EXPECT_EQ(file.of(0xBEEF)[0], file.of(1)[0]);
    EXPECT_EQ(file.of(0xBEEF)[1][0], 1);
    EXPECT_THROW(file.of(2), std::runtime_error);
}

TEST_F(KeyFiles, TheKeyForAllVehiclesIsNotTheGroupKey) {
    EXPECT_THROW(read(a + "\n").of(0xFFFF), std::runtime_error);
    EXPECT_EQ(read(a + "\n0xffff " + b + "\n").of(0xFFFF)[0][0], 1);
}

TEST_F(KeyFiles, WithoutAFileThereAreNoKeys) {
    EXPECT_TRUE(KeyFile().of(1).empty());
}

TEST_F(KeyFiles, AFileReadableByOthersIsRefused) {
    for (mode_t mode : {0640, 0604, 0620, 0666, 0611})
        EXPECT_NE(refusal(a, mode).find("chmod 600"), std::string::npos) << std::oct << mode;
    EXPECT_EQ(refusal(a, 0400), "");
}

TEST_F(KeyFiles, AWrongLineIsReportedWithTheExpectedForm) {
    for (const std::string& line :
         {a.substr(1), a + "0", a.substr(0, 31) + "g", a + " " + b + " " + a, "0x1 " + a + "1",
          "0x10000 " + a, "1 " + a, "0x " + a, std::string("0x0001")})
        EXPECT_NE(refusal("# ours\n" + line + "\n").find("line 2: expected [ADDRESS] KEY [NEXT]"),
                  std::string::npos)
            << line;
    EXPECT_NE(refusal(a + "\n" + b).find("line 2: duplicate line"), std::string::npos);
    EXPECT_NE(refusal("").find("has no key;"), std::string::npos);
    EXPECT_NE(refusal(std::string(70000, ' ')).find("too long"), std::string::npos);
}

TEST_F(KeyFiles, AMissingFileOrAFolderIsRefused) {
    std::remove(path_);
    try {
        KeyFile file(path_);
        FAIL();
    } catch (const std::runtime_error& e) {
        EXPECT_NE(std::string(e.what()).find("openssl rand -hex 16"), std::string::npos);
    }
    EXPECT_THROW(KeyFile("/tmp"), std::runtime_error);
    EXPECT_THROW(KeyFile("/dev/zero"), std::runtime_error);
}

TEST_F(KeyFiles, AFileOfAnotherUserIsRefused) {
    if (geteuid() != 0)
        GTEST_SKIP() << "only root may give a file away";
    std::ofstream(path_) << a;
    ASSERT_EQ(chown(path_, 4321, 4321), 0);
    EXPECT_NE(refusal(a).find("belongs to another user"), std::string::npos);
}

TEST_F(KeyFiles, AFileDescriptorMayReplaceTheName) {
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    ASSERT_EQ(write(ends[1], a.data(), a.size()), 32);
    close(ends[1]);
    EXPECT_EQ(KeyFile("/dev/fd/" + std::to_string(ends[0])).of(1).size(), 1u);
    close(ends[0]);
}

} // namespace
