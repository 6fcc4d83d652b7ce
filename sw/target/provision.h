/* SPDX-License-Identifier: MIT
 *
 * provision: gives the vehicle its key over USART 1 (PA9, PA10; 115,200 baud), to who holds that
 * line in a break while the vehicle starts: who can do that could use the debugger as well.
 */
#ifndef PROVISION_H
#define PROVISION_H

/* Returns at once if nobody asks. Else listens for ten seconds, for a line: "key" and 32
 * hexadecimal digits, or "open" (UAV_provide). */
void Provision_listen(void);

#endif
