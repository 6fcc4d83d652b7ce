/* SPDX-License-Identifier: MIT
 *
 * serve: functions that a test's servants provide, for server.c (over tcp) and radio.c (over the
 * air).
 */
#pragma once

#include "icec.h"

/* Adds the servants to an adapter. */
Ice_Status Suite_serve(Ice_ObjectAdapterPtr adapter);
extern const char* suite_argument; /* first argument of the program server.c */

/* Proxy of the object on the other side of the bridge, for the current request. */
extern Ice_ObjectPrx Bridge_far;
/* Returns the servant of the interface with this number, counted from 0 in the output of bridge.py;
 * returns null after the last one. */
Ice_ObjectPtr Bridge_servant(int number);
