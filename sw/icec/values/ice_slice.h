/* SPDX-License-Identifier: MIT
 *
 * ice_slice: functions shared by the slices of exceptions and of classes.
 */
#pragma once

#include "ice_value.h"

/* Flags at the start of a slice in encoding 1.1. Slices of exceptions have none of the first three
 * flags, because their type is always a string. */
enum {
    ICE_SLICE_TYPE_STRING = 0x01,
    ICE_SLICE_TYPE_INDEX = 0x02,
    ICE_SLICE_COMPACT_ID = 0x03,
    ICE_SLICE_OPTIONALS = 0x04,
    ICE_SLICE_TABLE = 0x08,
    ICE_SLICE_SIZE = 0x10,
    ICE_SLICE_LAST = 0x20,
    ICE_SLICE_INSIDE = 0x80 /* never sent: the stream is inside a slice */
};

/* Sets the failure of a stream, unless it has already failed. */
void icec_failRead(Ice_InputStreamPtr is, Ice_Failed why);

/* Reads the size of a slice with these flags; it has four bytes and includes them. Returns
 * the end of the slice. Returns 0 if the slice has no size, or a wrong size; a wrong size
 * fails the stream. */
Ice_Int icec_readSliceEnd(Ice_InputStreamPtr is, Ice_Byte flags);

/* Ends a slice in encoding 1.1. `flags`: position of its flags; `size`: position of its size, or -1
 * if it has none. */
void icec_finishSlice(Ice_OutputStreamPtr os, Ice_Int flags, Ice_Int size);
/* Writes the size of everything since `begin` into the four bytes there, which are included. */
void icec_patchSize(Ice_OutputStreamPtr os, Ice_Int begin);
