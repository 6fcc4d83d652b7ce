/* SPDX-License-Identifier: MIT
 *
 * lines: tests each wire between microcontroller and FPGA from both sides, while the FPGA is loaded
 * with line_tester (hdl/bringup/line_tester.v). The microcontroller drives its pins as
 * general-purpose outputs, so neither the FSMC nor the clock of the board has to work.
 */
#pragma once

#include "base.h"

#define LINES 50U     /* lines of the microcontroller */
#define FPGA_PINS 55U /* number of tested FPGA pins, for these lines and for the modem */
#define CHANNELS 3U

/* The value of a macro as a text. */
#define TEXT_OF(macro) TEXT_OF_TOKEN(macro)
#define TEXT_OF_TOKEN(token) #token

/* Numbers of lines and of the FPGA's pins; see line_tester.v. */
enum {
    LINE_D0 = 0,
    LINE_A0 = 16,
    LINE_NE1 = 41,
    LINE_NE2,
    LINE_NOE,
    LINE_NWE,
    LINE_NBL0,
    LINE_NBL1,
    LINE_NADV,
    LINE_NWAIT,
    LINE_IRQ,
    PIN_RXD,
    PIN_TXD,
    PIN_CTS,
    PIN_RTS,
    PIN_RESET
};

typedef enum Pull { PULL_NONE, PULL_UP, PULL_DOWN } Pull;

/* One bit for each tested pin of the FPGA. */
typedef struct Pins {
    U8 bytes[(FPGA_PINS + 7U) / 8U];
} Pins;

typedef struct Answer {
    U32 id, clocks, edges; /* clocks: cycles of the board clock / 64, modulo 65536 */
    Pins pins;
    /* levels of the modem pins shortly after the last frame has set the tester's outputs */
    Pins early;
} Answer;

/* Levels and enables of the tester's outputs. */
extern Pins lines_value, lines_enable;

const char* Lines_name(U32 line);
int Lines_isWired(U32 line);
void Lines_input(U32 line, Pull pull);
void Lines_drive(U32 line, int high);
int Lines_read(U32 line);
/* Makes all lines inputs with this pull-up, pull-down or neither. */
void Lines_release(Pull pull);
/* Switches all lines except IRQ to the FSMC. */
void Lines_useForFsmc(void);
/* Returns the level of NWAIT between accesses. */
int Lines_idleNwait(void);
int Pins_get(const Pins* pins, U32 pin);
void Pins_set(Pins* pins, U32 pin, int high);

/* Tries to reach the tester on each channel. Returns one bit for each channel that answers.
 * Lines_exchange then uses the first of these channels. */
U32 Lines_find(void);
/* Returns 1 if the line is one of the three lines of the channel in use. These lines need no test,
 * because the tester answers over them. */
int Lines_isChannels(U32 line);
/* Sends the tester the levels that it must drive. Sets `answer` to the levels that the tester has
 * read at its pins before it drives the new levels. Returns 0 if the tester does not answer. */
int Lines_exchange(Answer* answer);

/* Steps of the test. `found` is the result of Lines_find: one bit for each channel that works; 0 if
 * the tester does not answer. */
/* Finds stuck lines and shorts, without the FPGA. Returns 0 if another chip drives the bus, because
 * the other steps for the wires would then be meaningless. */
int Lines_testAlone(U32 found);
void Lines_testThrough(U32 found); /* finds open, swapped and inverted lines */
void Lines_testClock(void);        /* tests the FPGA's clock and the edges of NWE */
void Lines_testModem(void);        /* tests the wires between FPGA and modem */
