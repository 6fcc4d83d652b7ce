/* SPDX-License-Identifier: MIT
 *
 * ice_slice: shared by slices of exceptions and of classes.
 */
#pragma once

#include "ice_value.h"

/* Flags before a slice in encoding 1.1. Exceptions have no flags for the type: it is a string. */
enum {
    ICE_SLICE_TYPE_STRING = 0x01,
    ICE_SLICE_TYPE_INDEX = 0x02,
    ICE_SLICE_COMPACT_ID = 0x03,
    ICE_SLICE_OPTIONALS = 0x04,
    ICE_SLICE_TABLE = 0x08,
    ICE_SLICE_SIZE = 0x10,
    ICE_SLICE_LAST = 0x20,
    ICE_SLICE_INSIDE = 0x80 /* never on the wire: inside a slice */
};

/* Fails a stream that has not failed yet. */
void icec_failRead(Ice_InputStreamPtr is, Ice_Failed why);

/* Reads the size of a slice with these flags: four bytes, which count themselves. Returns the end
 * of the slice; 0 if it has no size, or a wrong one, which fails the stream. */
Ice_Int icec_readSliceEnd(Ice_InputStreamPtr is, Ice_Byte flags);

/* Ends a slice of 1.1 with its flags at `flags`, and its size at `size` (-1: no size). */
void icec_finishSlice(Ice_OutputStreamPtr os, Ice_Int flags, Ice_Int size);
/* Fills in the size of four bytes at `begin`; it counts itself. */
void icec_patchSize(Ice_OutputStreamPtr os, Ice_Int begin);
