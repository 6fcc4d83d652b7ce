/* SPDX-License-Identifier: MIT
 *
 * program: the functions that the board calls and that each program must implement.
 */
#pragma once

/* Runs the program. Called after a reset, when memory is initialised; does not return. */
void Program_run(void);

/* Handles the FPGA's interrupt. It is level-sensitive, so the function is called until the pin is
 * low. */
void Program_onFpgaInterrupt(void);
