/* SPDX-License-Identifier: MIT
 *
 * serve: the servants of a test, for server.c over tcp and radio.c over the air.
 */
#pragma once

#include "icec.h"

/* Adds the servants to an adapter. */
Ice_Status Suite_serve(Ice_ObjectAdapterPtr adapter);
extern const char* suite_argument; /* the first one of server.c's program */

/* The object behind the bridge that the request under way is for. */
extern Ice_ObjectPrx Bridge_far;
/* Returns the servant of an interface that bridge.py writes, from 0; 0: there are no more. */
Ice_ObjectPtr Bridge_servant(int number);
