/* SPDX-License-Identifier: MIT
 *
 * ice_operation: tables that generated code contains, and that describe the operations of an
 * interface.
 */
#pragma once

#include "icec.h"

#include <stddef.h>

enum { ICE_NORMAL = 0, ICE_NONMUTATING = 1, ICE_IDEMPOTENT = 2 };

/* Number added to the mode of a request that arrived by broadcast (Ice_markBroadcast). */
#define ICE_BROADCAST 4

/* Request modes that an operation accepts, one bit each. ICE_TAKES_BROADCAST also accepts these
 * modes in requests that arrive by broadcast; it is set for operations with metadata
 * [":broadcast"]. */
enum {
    ICE_TAKES_NORMAL = 1 << ICE_NORMAL,
    ICE_TAKES_IDEMPOTENT = 1 << ICE_NONMUTATING | 1 << ICE_IDEMPOTENT
};
#define ICE_TAKES_BROADCAST(modes) ((modes) | (modes) << ICE_BROADCAST)

typedef struct Ice_Operation {
    const char* name; /* name; 0 marks the end of a table */
    /* Reads the parameters, calls the servant and writes the result. `table` is the servant's table
     * of functions, of type M_I_Operations. */
    Ice_Status (*dispatch)(Ice_ObjectPtr self, const void* table, const Ice_Current* current,
                           Ice_InputStreamPtr is, Ice_OutputStreamPtr os);
    Ice_Byte modes;
} Ice_Operation;

typedef struct Ice_Base Ice_Base;

typedef struct Ice_Interface {
    const Ice_Operation* operations;
    const Ice_Base* bases; /* interfaces from which this one is derived; 0 if none */
} Ice_Interface;

struct Ice_Base {
    const Ice_Interface* interface; /* 0 marks the end of the list */
    /* offset of the base's table of functions, inside the table of the derived interface */
    size_t offset;
};

/* Calls the operation that `current` names. Returns ICE_PROTOCOL if the mode of the request is not
 * allowed: only one of the request and the operation is idempotent, or the request arrived by
 * broadcast and the operation does not accept broadcasts. */
Ice_Status Ice_Object_dispatch(const Ice_Interface* interface, const void* table,
                               Ice_ObjectPtr self, const Ice_Current* current,
                               Ice_InputStreamPtr is, Ice_OutputStreamPtr os);
