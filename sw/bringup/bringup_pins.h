/* SPDX-License-Identifier: MIT
 *
 * bringup_pins: the microcontroller's pins of the lines to the FPGA.
 *
 * X(name, port, pin), in the order of the FPGA's pins in hdl/bringup/line_tester.v. Port 0 is A;
 * 255 stands for a line without a wire.
 */
#pragma once

#define BRINGUP_LINES(X) \
    X(D0, 3, 14)         \
    X(D1, 3, 15)         \
    X(D2, 3, 0)          \
    X(D3, 3, 1)          \
    X(D4, 4, 7)          \
    X(D5, 4, 8)          \
    X(D6, 4, 9)          \
    X(D7, 4, 10)         \
    X(D8, 4, 11)         \
    X(D9, 4, 12)         \
    X(D10, 4, 13)        \
    X(D11, 4, 14)        \
    X(D12, 4, 15)        \
    X(D13, 3, 8)         \
    X(D14, 3, 9)         \
    X(D15, 3, 10)        \
    X(A0, 5, 0)          \
    X(A1, 5, 1)          \
    X(A2, 5, 2)          \
    X(A3, 5, 3)          \
    X(A4, 5, 4)          \
    X(A5, 5, 5)          \
    X(A6, 5, 12)         \
    X(A7, 5, 13)         \
    X(A8, 5, 14)         \
    X(A9, 5, 15)         \
    X(A10, 6, 0)         \
    X(A11, 6, 1)         \
    X(A12, 6, 2)         \
    X(A13, 6, 3)         \
    X(A14, 6, 4)         \
    X(A15, 6, 5)         \
    X(A16, 3, 11)        \
    X(A17, 3, 12)        \
    X(A18, 3, 13)        \
    X(A19, 4, 3)         \
    X(A20, 4, 4)         \
    X(A21, 4, 5)         \
    X(A22, 4, 6)         \
    X(A23, 4, 2)         \
    X(A24, 6, 13)        \
    X(NE1, 3, 7)         \
    X(NE2, 6, 9)         \
    X(NOE, 3, 4)         \
    X(NWE, 3, 5)         \
    X(NBL0, 4, 0)        \
    X(NBL1, 4, 1)        \
    X(NADV, 255, 0)      \
    X(NWAIT, 3, 6)       \
    X(IRQ, 1, 0)
