/* SPDX-License-Identifier: MIT
 *
 * provision: gives the vehicle its key over USART 1 (PA9, PA10; 115,200 baud). The sender holds the
 * line in a break while the vehicle starts; whoever can do that could use the debugger as well.
 */
#ifndef PROVISION_H
#define PROVISION_H

/* Returns at once where nobody asks. Else listens for ten seconds for a line: "key" and 32
 * hexadecimal digits, or "open" (UAV_provide). */
void Provision_listen(void);

#endif
