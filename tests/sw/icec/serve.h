/* SPDX-License-Identifier: MIT
 *
 * serve: the servants of a test, for server.c over tcp and radio.c over the air.
 */
#ifndef SERVE_H
#define SERVE_H

#include "icec.h"

/* Adds the servants to an adapter. */
Ice_Status Suite_serve(Ice_ObjectAdapterPtr adapter);
extern const char* suite_argument; /* the first one of server.c's program */

#endif
