// SPDX-License-Identifier: MIT
//
// cutter_test: windows of a picture, cut by a core in VHDL.

#include "Vcutter_slot.h"
#include "cutter_proxy.h"

namespace {

class Cutter : public ::testing::Test {
protected:
    static constexpr Ice_Short width = 64, height = 48;
    static Ice_Byte pixel(int x, int y) { return static_cast<Ice_Byte>(x * 5 + y * 31); }
    std::vector<Ice_Byte> cut(Ice_Short x, Ice_Short y, Ice_Short columns, Ice_Short rows) {
        std::vector<Ice_Byte> picture;
        for (int v = 0; v < height; ++v)
            for (int u = 0; u < width; ++u)
                picture.push_back(pixel(u, v));
        Demo_Pixels in{static_cast<Ice_Int>(picture.size()), picture.data()};
        Demo_Pixels out = core_.cut(&in, width, x, y, columns, rows);
        return {out.data, out.data + out.size};
    }
    void expectWindow(Ice_Short x, Ice_Short y, Ice_Short columns, Ice_Short rows) {
        auto got = cut(x, y, columns, rows);
        ASSERT_EQ(got.size(), static_cast<size_t>(columns * rows));
        for (int v = 0; v < rows; ++v)
            for (int u = 0; u < columns; ++u)
                ASSERT_EQ(got[static_cast<size_t>(v * columns + u)], pixel(x + u, y + v));
    }
    CutterProxy<Vcutter_slot> core_;
};

TEST_F(Cutter, AWindowIsCutOut) {
    expectWindow(0, 0, 8, 1);
    expectWindow(8, 3, 24, 40);
    expectWindow(56, 47, 8, 1);
    expectWindow(0, 0, 64, 16);
}

TEST_F(Cutter, WhatIsNoWindowIsRefused) {
    EXPECT_THROW(cut(1, 0, 8, 8), CoreError);
    EXPECT_THROW(cut(0, 0, 0, 8), CoreError);
    EXPECT_THROW(cut(0, 0, 64, 17), CoreError) << "more than 1024 pixels";
    expectWindow(16, 16, 16, 16);
}

} // namespace
