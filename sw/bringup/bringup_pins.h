/* SPDX-License-Identifier: MIT
 *
 * bringup_pins: pins of the microcontroller for the lines to the FPGA. Each line is X(name, place),
 * in the order of the FPGA's pins in hdl/bringup/line_tester.v. A place is a port and a pin; port 0
 * is A, and port 255 means that the line has no wire.
 */
#pragma once

#include "board_pins.h"

#define BRINGUP_LINES(X)     \
    X(D0, BOARD_AT_D0)       \
    X(D1, BOARD_AT_D1)       \
    X(D2, BOARD_AT_D2)       \
    X(D3, BOARD_AT_D3)       \
    X(D4, BOARD_AT_D4)       \
    X(D5, BOARD_AT_D5)       \
    X(D6, BOARD_AT_D6)       \
    X(D7, BOARD_AT_D7)       \
    X(D8, BOARD_AT_D8)       \
    X(D9, BOARD_AT_D9)       \
    X(D10, BOARD_AT_D10)     \
    X(D11, BOARD_AT_D11)     \
    X(D12, BOARD_AT_D12)     \
    X(D13, BOARD_AT_D13)     \
    X(D14, BOARD_AT_D14)     \
    X(D15, BOARD_AT_D15)     \
    X(A0, BOARD_AT_A0)       \
    X(A1, BOARD_AT_A1)       \
    X(A2, BOARD_AT_A2)       \
    X(A3, BOARD_AT_A3)       \
    X(A4, BOARD_AT_A4)       \
    X(A5, BOARD_AT_A5)       \
    X(A6, BOARD_AT_A6)       \
    X(A7, BOARD_AT_A7)       \
    X(A8, BOARD_AT_A8)       \
    X(A9, BOARD_AT_A9)       \
    X(A10, BOARD_AT_A10)     \
    X(A11, BOARD_AT_A11)     \
    X(A12, BOARD_AT_A12)     \
    X(A13, BOARD_AT_A13)     \
    X(A14, BOARD_AT_A14)     \
    X(A15, BOARD_AT_A15)     \
    X(A16, BOARD_AT_A16)     \
    X(A17, BOARD_AT_A17)     \
    X(A18, BOARD_AT_A18)     \
    X(A19, BOARD_AT_A19)     \
    X(A20, BOARD_AT_A20)     \
    X(A21, BOARD_AT_A21)     \
    X(A22, BOARD_AT_A22)     \
    X(A23, BOARD_AT_A23)     \
    X(A24, BOARD_AT_A24)     \
    X(NE1, BOARD_AT_NE1)     \
    X(NE2, BOARD_AT_NE2)     \
    X(NOE, BOARD_AT_NOE)     \
    X(NWE, BOARD_AT_NWE)     \
    X(NBL0, BOARD_AT_NBL0)   \
    X(NBL1, BOARD_AT_NBL1)   \
    X(NADV, BOARD_AT_NADV)   \
    X(NWAIT, BOARD_AT_NWAIT) \
    X(IRQ, BOARD_AT_IRQ)
