/* SPDX-License-Identifier: MIT
 *
 * bridge: what bridge.py writes, and what calls it.
 */
#ifndef BRIDGE_H
#define BRIDGE_H

#include "icec.h"

/* The object behind the bridge that the request under way is for. */
extern Ice_ObjectPrx Bridge_far;

/* Returns the servant of an interface, from 0; 0: there are no more. */
Ice_ObjectPtr Bridge_servant(int number);

#endif
