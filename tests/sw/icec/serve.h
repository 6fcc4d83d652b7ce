/* SPDX-License-Identifier: MIT
 *
 * serve: the servants of a test, for server.c over tcp and radio.c over the air.
 */
#pragma once

#include "icec.h"

/* Adds the servants to an adapter. */
Ice_Status Suite_serve(Ice_ObjectAdapterPtr adapter);
extern const char* suite_argument; /* the first one of server.c's program */

/* Object behind the bridge for the current request. */
extern Ice_ObjectPrx Bridge_far;
/* Returns the servant of interface `number`, counted from 0, of those that bridge.py generates;
 * null after the last one. */
Ice_ObjectPtr Bridge_servant(int number);
