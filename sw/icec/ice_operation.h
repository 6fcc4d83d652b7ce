/* SPDX-License-Identifier: MIT
 *
 * ice_operation: the tables by which generated code describes an interface.
 */
#pragma once

#include "icec.h"

#include <stddef.h>

enum { ICE_NORMAL = 0, ICE_NONMUTATING = 1, ICE_IDEMPOTENT = 2 };

typedef struct Ice_Operation {
    const char* name; /* 0 ends a table */
    /* `table`: the servant's M_I_Operations */
    Ice_Status (*dispatch)(Ice_ObjectPtr self, const void* table, const Ice_Current* current,
                           Ice_InputStreamPtr is, Ice_OutputStreamPtr os);
    Ice_Byte mode; /* ICE_NORMAL or ICE_IDEMPOTENT */
} Ice_Operation;

typedef struct Ice_Base Ice_Base;

typedef struct Ice_Interface {
    const Ice_Operation* operations;
    const Ice_Base* bases; /* 0: none */
} Ice_Interface;

struct Ice_Base {
    const Ice_Interface* interface; /* 0 ends */
    size_t offset;                  /* of its operations within those of the derived interface */
};

/* Calls the operation that `current` names. ICE_PROTOCOL: it was called as idempotent and is not,
 * or the reverse. */
Ice_Status Ice_Object_dispatch(const Ice_Interface* interface, const void* table,
                               Ice_ObjectPtr self, const Ice_Current* current,
                               Ice_InputStreamPtr is, Ice_OutputStreamPtr os);
