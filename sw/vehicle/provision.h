/* SPDX-License-Identifier: MIT
 *
 * provision: accepts the vehicle's address, keys and peers from the serial port, before the tasks
 * start.
 */
#pragma once

/* Returns at once if the serial port does not receive a break. Otherwise reports whether read
 * protection is off, and waits ten seconds for one of these lines:
 *   key KEY ADDRESS             sets the key of the first ground station and the vehicle's address
 *                               (UAV_provide)
 *   open ADDRESS                sets the address, without a key
 *   ground ADDRESS [KEY]        adds an observer (UAV_providePeer)
 *   group NUMBER KEY            adds the group; calls to all vehicles must then have a number above
 *                               NUMBER, which has eight digits
 *   fellow ADDRESS [KEY]        adds another vehicle
 *   protect                     sets read protection
 * KEY has 32 hexadecimal digits, ADDRESS four. If the vehicle has a key, each line must end with
 * one of its current keys, or PC2 must be connected to ground. */
void Provision_listen(void);
