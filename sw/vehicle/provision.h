/* SPDX-License-Identifier: MIT
 *
 * provision: gives a vehicle its address, keys and peers over the serial port, before the tasks
 * start.
 */
#pragma once

/* Returns at once if the serial port has no break. Otherwise reports whether read protection is
 * off, and waits ten seconds for one line:
 *   key KEY ADDRESS             sets the first ground's key and the vehicle's address (UAV_provide)
 *   open ADDRESS                the same without a key
 *   ground ADDRESS [KEY]        adds an observer (UAV_providePeer)
 *   group NUMBER KEY            adds the group; calls to all need a higher number (eight digits)
 *   fellow ADDRESS [KEY]        adds another vehicle
 *   protect                     sets read protection
 * KEY has 32 hexadecimal digits, ADDRESS four. A vehicle with a key requires one of its current
 * keys at the end of the line, or PC2 wired to ground. */
void Provision_listen(void);
