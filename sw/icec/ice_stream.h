/* SPDX-License-Identifier: MIT
 *
 * ice_stream: Ice's types, and their encodings 1.0 and 1.1. A failed stream stays failed, so one
 * check at the end is enough.
 *
 * Streams allocate no memory and share nothing. One stream is used by one task; different tasks may
 * use different streams.
 */
#pragma once

#include "base.h"
#include "ice_config.h"

typedef U8 Ice_Bool;
typedef U8 Ice_Byte;
typedef S16 Ice_Short;
typedef S32 Ice_Int;
typedef float Ice_Float;
typedef double Ice_Double;
typedef struct Ice_Long {
    U32 low; /* C90 has no 64-bit integer */
    S32 high;
} Ice_Long;

/* A string with its size. It has no terminating zero. Its bytes are in a message or in the caller's
 * memory. */
typedef struct Ice_String {
    Ice_Int size;
    const char* data;
} Ice_String;

Ice_String Ice_String_from(const char* terminated);
int Ice_String_equals(Ice_String a, const char* terminated);
/* Returns whether a string equals a C string. The string is passed by pointer, because this makes
 * shorter code. */
int Ice_String_is(const Ice_String* a, const char* terminated);
int Ice_String_same(const Ice_String* a, const Ice_String* b);

/* Copies as many whole UTF-8 characters of the string as fit into `size` bytes, including a
 * terminating zero. Returns 1 if the whole string fits. */
int Ice_String_copy(Ice_String s, char* to, Ice_Int size);
/* The two arguments for "%.*s": printf("%.*s\n", ICE_PRINTF(name)). `s` is evaluated three times.
 */
#define ICE_PRINTF(s) (int)(s).size, (s).data ? (s).data : ""

/* Convert Ice_Long from and to `long long`, if the compiler has this type. */
#if (defined(__STDC_VERSION__) && __STDC_VERSION__ >= 199901L) || \
    (defined(__cplusplus) && __cplusplus >= 201103L)
static inline Ice_Long Ice_Long_from(long long v) {
    Ice_Long parts;
    parts.low = (U32)(v & 0xFFFFFFFFLL);
    parts.high = (S32)((v - (long long)parts.low) / 0x100000000LL);
    return parts;
}
static inline long long Ice_Long_get(Ice_Long v) {
    return v.high * 0x100000000LL + v.low;
}
#endif

struct Ice_Communicator;
struct Ice_OutputValues; /* ice_value.h */
struct Ice_InputValues;

/* Reason why a stream has failed: malformed bytes, or a limit. A stream keeps its first reason. */
typedef enum Ice_Failed {
    ICE_FAILED_MALFORMED = 1,
    /* the output buffer is full; unless stated otherwise, its size is ICE_RESULT_MAX */
    ICE_FAILED_RESULT,
    ICE_FAILED_REQUEST,
    ICE_FAILED_REPLY,
    ICE_FAILED_ARENA,
    ICE_FAILED_VALUES,
    ICE_FAILED_VALUE_TYPES,
    ICE_FAILED_IDENTITY,
    ICE_FAILED_ENDPOINT,
    ICE_FAILED_CALLS, /* the limit of calls; the reason of an ICE_LIMIT, never of a failed stream */
    ICE_FAILED_CONNECTIONS,
    ICE_FAILED_NESTING,
    /* the limit that ["c:max:N"] sets for a type in Slice; the stream's `bound` names the type */
    ICE_FAILED_BOUND
} Ice_Failed;

/* Returns the reason as text: the limit, its macro and its value. `bound` is the field of the
 * stream. */
const char* Ice_Failed_text(Ice_Byte failed, const char* bound);

typedef struct Ice_OutputStream {
    Ice_Byte* data;
    Ice_Int size, capacity;
    Ice_Byte minor;  /* minor version of the encoding: 1.minor */
    Ice_Byte failed; /* reason of the failure (Ice_Failed); 0 without a failure */
    /* 1 if user exceptions are written in the sliced format, which lets a peer skip slices of
     * unknown types */
    Ice_Byte sliced;
    Ice_Byte sliceFlags; /* flags of the current slice */
    const char* bound;   /* text of the reason ICE_FAILED_BOUND, or reason of a refused call */
    struct Ice_OutputValues* values; /* table of class instances; 0 until the first instance */
} Ice_OutputStream, *Ice_OutputStreamPtr;

typedef struct Ice_InputStream {
    const Ice_Byte* data;
    Ice_Int position, size;
    Ice_Byte minor;
    Ice_Byte failed;
    Ice_Byte sliceFlags; /* flags of the current slice; 0 outside a slice */
    const char* bound;   /* text of the reason ICE_FAILED_BOUND, or reason of a refused call */
    Ice_Int sliceEnd;    /* end of the current slice; 0 if it is not known */
    U32* arena;          /* memory for decoded sequences */
    /* used part of the arena, and its size, in words of 4 bytes */
    Ice_Int arenaUsed, arenaSize;
    /* communicator of the proxies that are read from the stream */
    struct Ice_Communicator* communicator;
    struct Ice_InputValues* values; /* table of class instances; 0 until the first instance */
} Ice_InputStream, *Ice_InputStreamPtr;

/* ---- writing ---- */

void Ice_OutputStream_init(Ice_OutputStreamPtr os, Ice_Byte* data, Ice_Int capacity);
void Ice_OutputStream_writeBlob(Ice_OutputStreamPtr os, const Ice_Byte* data, Ice_Int size);
void Ice_OutputStream_writeByte(Ice_OutputStreamPtr os, Ice_Byte v);
void Ice_OutputStream_writeBool(Ice_OutputStreamPtr os, Ice_Bool v);
void Ice_OutputStream_writeShort(Ice_OutputStreamPtr os, Ice_Short v);
void Ice_OutputStream_writeInt(Ice_OutputStreamPtr os, Ice_Int v);
void Ice_OutputStream_writeLong(Ice_OutputStreamPtr os, Ice_Long v);
void Ice_OutputStream_writeFloat(Ice_OutputStreamPtr os, Ice_Float v);
void Ice_OutputStream_writeDouble(Ice_OutputStreamPtr os, Ice_Double v);
void Ice_OutputStream_writeSize(Ice_OutputStreamPtr os, Ice_Int v);
void Ice_OutputStream_writeString(Ice_OutputStreamPtr os, Ice_String v);
void Ice_OutputStream_writeText(Ice_OutputStreamPtr os, const char* terminated);
/* Writes an enumerator. `largest` is the enum's largest value, which determines the width in
 * encoding 1.0. */
void Ice_OutputStream_writeEnum(Ice_OutputStreamPtr os, Ice_Int v, Ice_Int largest);
/* An enumerator of a small enum is a byte in both encodings. */
#define Ice_OutputStream_writeEnum(os, v, largest)                   \
    ((largest) < 127 ? Ice_OutputStream_writeByte(os, (Ice_Byte)(v)) \
                     : (Ice_OutputStream_writeEnum)(os, v, largest))
/* Reserves 4 bytes for a size, which endSize writes. The size does not include these 4 bytes. */
Ice_Int Ice_OutputStream_startSize(Ice_OutputStreamPtr os);
void Ice_OutputStream_endSize(Ice_OutputStreamPtr os, Ice_Int begin);
/* Overwrites the four bytes at `at`. */
void icec_patchInt(Ice_OutputStreamPtr os, Ice_Int at, Ice_Int value);

/* ---- reading ---- */

void Ice_InputStream_init(Ice_InputStreamPtr is, const Ice_Byte* data, Ice_Int size);
/* Returns 0 on failure. */
const Ice_Byte* Ice_InputStream_readBlob(Ice_InputStreamPtr is, Ice_Int size);
Ice_Byte Ice_InputStream_readByte(Ice_InputStreamPtr is);
Ice_Bool Ice_InputStream_readBool(Ice_InputStreamPtr is);
Ice_Short Ice_InputStream_readShort(Ice_InputStreamPtr is);
Ice_Int Ice_InputStream_readInt(Ice_InputStreamPtr is);
Ice_Long Ice_InputStream_readLong(Ice_InputStreamPtr is);
Ice_Float Ice_InputStream_readFloat(Ice_InputStreamPtr is);
Ice_Double Ice_InputStream_readDouble(Ice_InputStreamPtr is);
Ice_Int Ice_InputStream_readSize(Ice_InputStreamPtr is);
Ice_String Ice_InputStream_readString(Ice_InputStreamPtr is);
void Ice_InputStream_takeString(Ice_InputStreamPtr is, Ice_String* s);
Ice_Int Ice_InputStream_readEnum(Ice_InputStreamPtr is, Ice_Int largest);
/* Reads the size of a sequence of elements with at least `least` bytes each. Fails the stream if
 * such a sequence would exceed the message. */
Ice_Int Ice_InputStream_readSequence(Ice_InputStreamPtr is, Ice_Int least);
/* Returns room for `count` elements of `bytes` bytes each, aligned to 8. Without room, returns 0
 * and fails the stream. */
void* Ice_InputStream_allocate(Ice_InputStreamPtr is, Ice_Int count, Ice_Int bytes);

/* ---- optional values: encoding 1.1 only ---- */

enum {
    ICE_OPTIONAL_F1,
    ICE_OPTIONAL_F2,
    ICE_OPTIONAL_F4,
    ICE_OPTIONAL_F8,    /* value of a fixed size: 1, 2, 4 or 8 bytes */
    ICE_OPTIONAL_SIZE,  /* an enum */
    ICE_OPTIONAL_VSIZE, /* a size, followed by as many bytes */
    ICE_OPTIONAL_FSIZE, /* a size of 4 bytes, followed by as many bytes */
    ICE_OPTIONAL_CLASS
};

/* Begins an optional value that is present. Optional values follow the required values, in the
 * order of their tags. Returns 0 if the encoding has no optional values; the caller must then write
 * nothing. */
Ice_Bool Ice_OutputStream_writeOptional(Ice_OutputStreamPtr os, Ice_Int tag, Ice_Int format);
/* Returns 1 if the optional value with this tag is present; its bytes follow. Skips unknown tags
 * before it. */
Ice_Bool Ice_InputStream_readOptional(Ice_InputStreamPtr is, Ice_Int tag, Ice_Int format);
/* Skips the remaining optional values of the slice or encapsulation. */
void Ice_InputStream_skipOptionals(Ice_InputStreamPtr is);

/* Ends the reading of parameters, results or an exception: skips optional values that were not
 * read, and fails the stream if other bytes follow, as stock Ice does. Returns is->failed. The
 * minimal run time ignores such bytes. */
#ifdef ICEC_MINIMAL
#define Ice_InputStream_end(is) ((is)->failed)
#define Ice_InputStream_endEmpty(is) ((void)(is), 0)
#else
Ice_Bool Ice_InputStream_end(Ice_InputStreamPtr is);
/* Ends the reading of parameters, results or an exception without members. In encoding 1.1, skips
 * optional values, which a newer peer may have added; encoding 1.0 has no optional values. */
Ice_Bool Ice_InputStream_endEmpty(Ice_InputStreamPtr is);
#endif

/* ---- user exceptions: slices, the most derived one first ---- */

void Ice_OutputStream_startException(Ice_OutputStreamPtr os, Ice_Bool usesClasses);
/* Begins a slice. Returns the position that endSlice needs as `begin`. */
Ice_Int Ice_OutputStream_startSlice(Ice_OutputStreamPtr os, const char* typeId, Ice_Bool last);
void Ice_OutputStream_endSlice(Ice_OutputStreamPtr os, Ice_Int begin, Ice_Bool last);

void Ice_InputStream_startException(Ice_InputStreamPtr is);
/* Begins to read a slice. Returns its type id, or an empty string after the last slice. */
Ice_String Ice_InputStream_startSlice(Ice_InputStreamPtr is);
/* Skips to the next slice. Returns 0 if no slice follows, or if the format does not store the sizes
 * of slices. */
Ice_Bool Ice_InputStream_skipSlice(Ice_InputStreamPtr is);
void Ice_InputStream_endSlice(Ice_InputStreamPtr is);
