/* SPDX-License-Identifier: MIT
 *
 * ice_slice: functions that read and write slices, used for exceptions and for classes.
 */
#pragma once

#include "ice_value.h"

/* Flags at the start of a slice in encoding 1.1. Slices of exceptions have none of the first three
 * flags, because an exception's type is always a string. */
enum {
    ICE_SLICE_TYPE_STRING = 0x01,
    ICE_SLICE_TYPE_INDEX = 0x02,
    ICE_SLICE_COMPACT_ID = 0x03,
    ICE_SLICE_OPTIONALS = 0x04,
    ICE_SLICE_TABLE = 0x08,
    ICE_SLICE_SIZE = 0x10,
    ICE_SLICE_LAST = 0x20,
    ICE_SLICE_INSIDE = 0x80 /* used only in memory: the stream is inside a slice */
};

/* Sets the failure of a stream, unless it has already failed. */
void icec_failRead(Ice_InputStreamPtr is, Ice_Failed why);

/* Reads the size of a slice with these flags. The size has four bytes and includes them. Returns
 * the end of the slice; 0 if the slice has no size, or if the size is wrong. A wrong size fails the
 * stream. */
Ice_Int icec_readSliceEnd(Ice_InputStreamPtr is, Ice_Byte flags);

/* Ends a slice in encoding 1.1. `flags` is the position of its flags. `size` is the position of its
 * size; -1 if it has no size. */
void icec_finishSlice(Ice_OutputStreamPtr os, Ice_Int flags, Ice_Int size);
/* Writes into the four bytes at `begin` the number of bytes from there to the end of the stream. */
void icec_patchSize(Ice_OutputStreamPtr os, Ice_Int begin);
