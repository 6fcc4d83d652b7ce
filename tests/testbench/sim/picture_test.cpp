// SPDX-License-Identifier: MIT
//
// picture_test: tests that photographs are turned upright, and that grey levels are correct.

#include "picture.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

namespace {

using Bytes = std::vector<uint8_t>;

// A JPEG file of 32 x 16 pixels without its first marker. Its four quarters have the grey levels 20
// and 80 (upper half) and 140 and 220 (lower half).
const Bytes quarters = {
    0xFF, 0xDB, 0x00, 0x43, 0x00, 0x10, 0x0B, 0x0C, 0x0E, 0x0C, 0x0A, 0x10, 0x0E, 0x0D, 0x0E,
    0x12, 0x11, 0x10, 0x13, 0x18, 0x28, 0x1A, 0x18, 0x16, 0x16, 0x18, 0x31, 0x23, 0x25, 0x1D,
    0x28, 0x3A, 0x33, 0x3D, 0x3C, 0x39, 0x33, 0x38, 0x37, 0x40, 0x48, 0x5C, 0x4E, 0x40, 0x44,
    0x57, 0x45, 0x37, 0x38, 0x50, 0x6D, 0x51, 0x57, 0x5F, 0x62, 0x67, 0x68, 0x67, 0x3E, 0x4D,
    0x71, 0x79, 0x70, 0x64, 0x78, 0x5C, 0x65, 0x67, 0x63, 0xFF, 0xC0, 0x00, 0x0B, 0x08, 0x00,
    0x10, 0x00, 0x20, 0x01, 0x01, 0x11, 0x00, 0xFF, 0xC4, 0x00, 0x16, 0x00, 0x01, 0x01, 0x01,
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x05,
    0x06, 0xFF, 0xC4, 0x00, 0x14, 0x10, 0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xFF, 0xDA, 0x00, 0x08, 0x01, 0x01, 0x00,
    0x00, 0x3F, 0x00, 0xC4, 0x8B, 0xC2, 0xF0, 0xD4, 0x0F, 0xFF, 0xD9,
};

class Pictures : public ::testing::Test {
protected:
    Pictures() {
        std::string name = std::filesystem::temp_directory_path() / "picture_XXXXXX";
        if (const int file = mkstemp(name.data()); file >= 0)
            close(file);
        path_ = name;
    }
    ~Pictures() override { std::filesystem::remove(path_); }

    Picture read(const Bytes& file) {
        std::ofstream(path_, std::ios::binary)
            .write(reinterpret_cast<const char*>(file.data()), std::streamsize(file.size()));
        return readPicture(path_);
    }
    Picture read(const std::string& file) { return read(Bytes(file.begin(), file.end())); }

    // Returns the message for a file that must be rejected.
    std::string reasonFor(const std::string& file) {
        try {
            read(file);
        } catch (const std::runtime_error& error) {
            return error.what();
        }
        return "accepted";
    }

    // Returns an EXIF block that contains an orientation, in either byte order, as a number of 16
    // or 32 bits.
    static Bytes exif(int orientation, bool isLittle, int bits = 16) {
        const auto number = [&](size_t value, int bytes) {
            Bytes text;
            for (int i = 0; i < bytes; ++i)
                text.push_back(uint8_t(value >> 8 * (isLittle ? i : bytes - 1 - i)));
            return text;
        };
        Bytes block = isLittle ? Bytes{'I', 'I'} : Bytes{'M', 'M'};
        const auto add = [&](const Bytes& more) {
            block.insert(block.end(), more.begin(), more.end());
        };
        add(number(42, 2));
        add(number(8, 4));
        add(number(2, 2)); // two entries
        for (const auto& [tag, value] : {std::pair{0x0103, 6}, {0x0112, orientation}}) {
            add(number(size_t(tag), 2));
            add(number(bits == 16 ? 3 : 4, 2)); // type of the entry: 16-bit or 32-bit number
            add(number(1, 4));
            add(number(size_t(value), bits / 8));
            add(Bytes(size_t(4 - bits / 8)));
        }
        add(number(0, 4));
        return block;
    }
    // Returns a JPEG file with such a block.
    static Bytes oriented(int orientation, bool isLittle, int bits = 16) {
        Bytes file = {0xFF, 0xD8, 0xFF, 0xE1, 0, 46, 'E', 'x', 'i', 'f', 0, 0};
        for (const Bytes& part : {exif(orientation, isLittle, bits), quarters})
            file.insert(file.end(), part.begin(), part.end());
        return file;
    }

    std::string path_;
};

// EXIF 2.3, tag 0x0112: an orientation states at which sides of the upright picture the stored row
// 0 and column 0 are: 1 top and left, 2 top and right, 3 bottom and right, 4 bottom and left, 5
// left and top, 6 right and top, 7 right and bottom, 8 left and bottom.
TEST_F(Pictures, APhotographIsUprightInAllEightOrientations) {
    const int upright[][4] = {{20, 80, 140, 220}, {80, 20, 220, 140}, {220, 140, 80, 20},
                              {140, 220, 20, 80}, {20, 140, 80, 220}, {140, 20, 220, 80},
                              {220, 80, 140, 20}, {80, 220, 20, 140}};
    for (int orientation = 1; orientation <= 8; ++orientation)
        for (const bool isLittle : {false, true}) {
            const Picture picture = read(oriented(orientation, isLittle));
            const bool isOnItsSide = orientation >= 5;
            ASSERT_EQ(picture.width, isOnItsSide ? 16 : 32) << orientation;
            ASSERT_EQ(picture.height, isOnItsSide ? 32 : 16) << orientation;
            for (int i = 0; i < 4; ++i)
                EXPECT_NEAR(picture.at(picture.width * (1 + 2 * (i % 2)) / 4,
                                       picture.height * (1 + 2 * (i / 2)) / 4),
                            upright[orientation - 1][i], 2)
                    << orientation << ", quarter " << i;
        }
}

TEST_F(Pictures, ADamagedOrientationIsIgnored) {
    for (const int orientation : {0, 9, 65535})
        EXPECT_EQ(read(oriented(orientation, false)).width, 32);
    Bytes cut = oriented(6, false);
    cut[17] = 0xFF; // the directory would begin far beyond the end of the file
    EXPECT_EQ(read(cut).width, 32);
}

// Some programs write the orientation as a number of 32 bits.
TEST_F(Pictures, AnOrientationOf32BitsCounts) {
    for (const bool isLittle : {false, true})
        EXPECT_EQ(read(oriented(6, isLittle, 32)).width, 16) << isLittle;
}

// PNG, third edition: the chunk eXIf contains an EXIF block.
TEST_F(Pictures, AnOrientationInAPngFileCounts) {
    // The checksums of the chunks are 0; stb_image ignores them.
    const Bytes begin = {0x89, 'P', 'N', 'G', 0x0D, 0x0A, 0x1A, 0x0A, 0, 0, 0,
                         13,   'I', 'H', 'D', 'R',  0,    0,    0,    3, 0, 0,
                         0,    1,   8,   0,   0,    0,    0,    0,    0, 0, 0};
    const Bytes end = {0,    0,    0, 12, 'I', 'D',  'A', 'T',  0x78, 0xDA, 0x63, 0x10,
                       0x50, 0x70, 0, 0,  0,   0xB4, 0,   0x71, 0,    0,    0,    0,
                       0,    0,    0, 0,  'I', 'E',  'N', 'D',  0,    0,    0,    0};
    Bytes file = begin;
    const auto add = [&](const Bytes& more) { file.insert(file.end(), more.begin(), more.end()); };
    const Bytes block = exif(6, false);
    add({0, 0, 0, uint8_t(block.size()), 'e', 'X', 'I', 'f'});
    add(block);
    add({0, 0, 0, 0});
    add(end);
    const Picture picture = read(file);
    EXPECT_EQ(picture.width, 1);
    EXPECT_EQ(picture.height, 3);
    EXPECT_EQ(picture.grey, (Bytes{16, 32, 64}));
}

// netpbm's readers end a comment at a carriage return as well.
TEST_F(Pictures, LinesOfAPnmHeaderMayEndWithACarriageReturn) {
    EXPECT_EQ(read(std::string("P5\r# text\r2 1\r255\r\x0A\xFF")).grey, (Bytes{10, 255}));
}

TEST_F(Pictures, TheMaximumOfAPnmFileIsWhite) {
    EXPECT_EQ(read(std::string("P5\n# maxval\n3 1\n100\n\0\x32\x64", 24)).grey,
              (Bytes{0, 128, 255}));
    EXPECT_EQ(read(std::string("P5 3 1 1\n\0\1\1", 12)).grey, (Bytes{0, 255, 255}));
    EXPECT_EQ(read(std::string("P5 2 1 255\n\x0A\xFF", 13)).grey, (Bytes{10, 255}));
    EXPECT_EQ(read(std::string("P5 2 1 1000\n\x01\xF4\x03\xE8", 16)).grey, (Bytes{128, 255}));
    EXPECT_EQ(read(std::string("P6 1 1 100\n\x64\x64\x64", 14)).grey, (Bytes{255}));
}

TEST_F(Pictures, AnOrientationAfterFillBytesCounts) {
    Bytes filled = oriented(6, false);
    filled.insert(filled.begin() + 2, 3, 0xFF);
    EXPECT_EQ(read(filled).width, 16);
}

TEST_F(Pictures, OtherFormatsAndFoldersAreRejectedWithTheirNames) {
    const std::string gif("GIF89a\2\0\2\0\x80\0\0\xFF\xFF\xFF\0\0\0,\0\0\0\0\2\0\2\0\0\2", 30),
        targa("\0\0\2\0\0\0\0\0\0\0\0\0\2\0\2\0\x18\0\0\0\0\0\0\0\0\0\0\0\0\0", 30);
    for (const std::string& file : {gif, targa, std::string("any text")})
        EXPECT_EQ(reasonFor(file), "'" + path_ + "': expected a PNG, JPEG or PGM file");
    for (const std::string kind : {"P1", "P2", "P3", "P4"})
        EXPECT_EQ(reasonFor(kind + " 1 1 255\n1\n"),
                  "'" + path_ + "': expected a binary PGM or PPM file (P5 or P6), got " + kind +
                      ": save it again as PNG");
    EXPECT_NE(reasonFor("\xFF\xD8\xFF\xE1").find("the JPEG file is damaged"), std::string::npos);
    EXPECT_NE(reasonFor("P5 1 1 0\n1").find("1 to 65535, got 0"), std::string::npos);
    try {
        readPicture("/");
        ADD_FAILURE();
    } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(), "cannot read picture '/': it is a folder");
    }
}

TEST_F(Pictures, ATruncatedFileIsRejectedWithItsName) {
    for (const std::string text :
         {"P5", "P5 1 1 1000", "P5 9 9 255\n12345678", "P6 2 1 99999\n12345678901"})
        try {
            read(text);
            ADD_FAILURE() << text;
        } catch (const std::runtime_error& error) {
            EXPECT_NE(std::string(error.what()).find(path_), std::string::npos) << error.what();
        }
}

} // namespace
