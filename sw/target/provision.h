/* SPDX-License-Identifier: MIT
 *
 * provision: gives the vehicle its key over USART 1 (PA9, PA10; 115,200 baud). The sender holds the
 * line in a break while the vehicle starts.
 */
#ifndef PROVISION_H
#define PROVISION_H

/* Returns at once where nobody asks. Else says whether read protection is off, and listens for ten
 * seconds for a line: "key" and 32 hexadecimal digits, or "open" (UAV_provide); where there is a
 * key, a present one's digits behind it, or PC2 wired to ground. "protect" sets read protection. */
void Provision_listen(void);

#endif
