/* SPDX-License-Identifier: MIT
 *
 * tester: IceC's servant of Everything.ice, for any transport.
 */
#ifndef TESTER_H
#define TESTER_H

#include "Everything.h"

/* Adds the servant as tester, as its facet side and for the category any; activates the adapter. */
Ice_Status Tester_serve(Ice_ObjectAdapterPtr adapter);

#endif
