/* SPDX-License-Identifier: MIT
 *
 * client: IceC as the client of ZeroC's own servers: client ENCODING PORT. Says how many checks
 * passed.
 */
#ifndef ZEROC_CLIENT_H
#define ZEROC_CLIENT_H

#include "icec.h"

/* Calls the suite's server, whose objects this makes proxies to. */
void Suite_call(Ice_CommunicatorPtr ic);
/* Makes a proxy to an object of the server. */
Ice_ObjectPrx Suite_proxy(Ice_CommunicatorPtr ic, const char* identity);
/* Counts a check, and prints those that fail. */
void Suite_check(int is, const char* what, int line);
#define CHECK(is) Suite_check(is, #is, __LINE__)
#define SAME(string, text) CHECK(Ice_String_equals(string, text))

extern int Suite_minor; /* encoding 1.minor */

#endif
