/* SPDX-License-Identifier: MIT
 *
 * program: the functions of a program that the board calls; the program implements them.
 */
#pragma once

/* Runs the program after a reset, once memory is set up. Does not return. */
void Program_run(void);

/* Handles the FPGA's interrupt, which is a level: called until the pin is low. */
void Program_onFpgaInterrupt(void);
