/* SPDX-License-Identifier: MIT
 *
 * program: the functions of a program that the board calls; the program implements them.
 */
#pragma once

/* Runs the program after a reset, when memory is initialised. Does not return. */
void Program_run(void);

/* Handles the FPGA's interrupt, which is level-sensitive: called until the pin is low. */
void Program_onFpgaInterrupt(void);
