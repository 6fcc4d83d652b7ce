/* SPDX-License-Identifier: MIT
 *
 * client: IceC as the client of ZeroC's own servers: client ENCODING PORT PORT. Prints how many
 * checks passed.
 */
#ifndef ZEROC_CLIENT_H
#define ZEROC_CLIENT_H

#include "icec.h"

/* Calls the suite's server, whose objects this makes proxies to. */
void Suite_call(Ice_CommunicatorPtr ic);
/* Makes a proxy to an object of the server's first or second (1) adapter. */
Ice_ObjectPrx Suite_proxyAt(Ice_CommunicatorPtr ic, const char* identity, int adapter);
#define Suite_proxy(ic, identity) Suite_proxyAt(ic, identity, 0)
/* Counts a check, and prints those that fail. */
void Suite_check(int is, const char* what, int line);
#define CHECK(is) Suite_check(is, #is, __LINE__)
/* True if the two print the same: a proxy received in encoding 1.0 has endpoints of 1.0. */
int Suite_alike(const Ice_ObjectPrx* a, const Ice_ObjectPrx* b);
/* Casts `prx` to an interface that the object has. */
#define CAST(Type, prx, from) \
    CHECK(Type##Prx_checkedCast(prx, from) == ICE_OK && !Ice_ObjectPrx_isNull(prx))
#define SAME(string, text) CHECK(Ice_String_equals(string, text))

extern int Suite_minor; /* encoding 1.minor */

#endif
