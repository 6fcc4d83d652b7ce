/* SPDX-License-Identifier: MIT
 *
 * ice_operation: the tables by which generated code describes an interface.
 */
#pragma once

#include "icec.h"

#include <stddef.h>

enum { ICE_NORMAL = 0, ICE_NONMUTATING = 1, ICE_IDEMPOTENT = 2 };

/* Added to the mode of a request that arrived by broadcast (Ice_markBroadcast). */
#define ICE_BROADCAST 4

/* Request modes that an operation accepts, one bit each; with metadata [":broadcast"] also requests
 * by broadcast. */
enum {
    ICE_TAKES_NORMAL = 1 << ICE_NORMAL,
    ICE_TAKES_IDEMPOTENT = 1 << ICE_NONMUTATING | 1 << ICE_IDEMPOTENT
};
#define ICE_TAKES_BROADCAST(modes) ((modes) | (modes) << ICE_BROADCAST)

typedef struct Ice_Operation {
    const char* name; /* 0 marks the end of a table */
    /* `table`: the servant's M_I_Operations */
    Ice_Status (*dispatch)(Ice_ObjectPtr self, const void* table, const Ice_Current* current,
                           Ice_InputStreamPtr is, Ice_OutputStreamPtr os);
    Ice_Byte modes;
} Ice_Operation;

typedef struct Ice_Base Ice_Base;

typedef struct Ice_Interface {
    const Ice_Operation* operations;
    const Ice_Base* bases; /* 0 if none */
} Ice_Interface;

struct Ice_Base {
    const Ice_Interface* interface; /* 0 marks the end */
    size_t offset;                  /* offset of its table of operations in the derived one */
};

/* Calls the operation that `current` names. ICE_PROTOCOL: it was called as idempotent and is not,
 * or the reverse, or by broadcast and is not meant to be. */
Ice_Status Ice_Object_dispatch(const Ice_Interface* interface, const void* table,
                               Ice_ObjectPtr self, const Ice_Current* current,
                               Ice_InputStreamPtr is, Ice_OutputStreamPtr os);
