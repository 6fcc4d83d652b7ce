/* SPDX-License-Identifier: MIT
 *
 * ice_value_private: what the files that read instances share.
 */
#ifndef ICE_VALUE_PRIVATE_H
#define ICE_VALUE_PRIVATE_H

#include "ice_slice.h"
#include "ice_value.h"

typedef struct Ice_SliceHead {
    Ice_String id;
    Ice_Int compactId;         /* -1: none */
    const Ice_ValueType* type; /* 0: not known */
    Ice_Bool isObject;         /* the base of all; it ends an instance of 1.0 */
} Ice_SliceHead;

/* The head of an instance's slice. */
void Ice_startSlice(Ice_InputStreamPtr is, Ice_SliceHead* head);

/* `number` as it stands on the wire: 1 is followed by an instance. The result is its number,
 * from 1. */
Ice_Int Ice_readInstance(Ice_InputStreamPtr is, Ice_Int number);

/* Keeps the slice that has begun, in 1.1, and goes on behind it. 0: it has no end, or no room. */
Ice_UnknownSlice* Ice_keepSlice(Ice_InputStreamPtr is, Ice_String id, Ice_Int compactId);

/* At the end of the message: what kept slices point at. */
void Ice_endUnknown(Ice_InputStreamPtr is);

#endif
