// SPDX-License-Identifier: MIT
//
// soc_state: names the bytes of the Verilated chip's state, for differences between two moments.

#ifndef SOC_STATE_H
#define SOC_STATE_H

#include <string>
#include <vector>

class VSoc___024root;

class SocState {
public:
    using Image = std::vector<unsigned char>;

    static Image of(const VSoc___024root& root);
    // Returns the signals that differ, by their paths in the chip: "u_modem.u_timer.clocks".
    static std::vector<std::string> differences(const Image& a, const Image& b);
};

#endif
