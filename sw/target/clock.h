/* SPDX-License-Identifier: MIT
 *
 * clock: the STM32F2's clock tree.
 */
#pragma once

/* Switches to 120 MHz, from a crystal of 25 MHz, with the flash's wait states. Does nothing where
 * this has been done. Uses no RAM. */
void Clock_start(void);
