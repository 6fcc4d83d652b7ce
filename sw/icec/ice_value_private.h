/* SPDX-License-Identifier: MIT
 *
 * ice_value_private: shared by the files that read instances.
 */
#ifndef ICE_VALUE_PRIVATE_H
#define ICE_VALUE_PRIVATE_H

#include "ice_slice.h"
#include "ice_value.h"

typedef struct Icec_SliceHead {
    Ice_String id;
    Ice_Int compactId;         /* -1: none */
    const Ice_ValueType* type; /* 0: not known */
    Ice_Bool isObject;         /* the base of all; it ends an instance of 1.0 */
} Icec_SliceHead;

/* Reads the head of an instance's slice. */
void icec_startSlice(Ice_InputStreamPtr is, Icec_SliceHead* head);

/* Reads an instance's number on the wire; 1 precedes an instance. Returns the instance's number,
 * from 1. */
Ice_Int icec_readInstance(Ice_InputStreamPtr is, Ice_Int number);

/* Keeps the current slice, in 1.1, and goes behind it. 0: it has no end, or there is no room. */
Ice_UnknownSlice* icec_keepSlice(Ice_InputStreamPtr is, Ice_String id, Ice_Int compactId);

/* Sets the targets of kept slices; at the end of the message. */
void icec_endUnknown(Ice_InputStreamPtr is);

#endif
