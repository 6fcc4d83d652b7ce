/* SPDX-License-Identifier: MIT
 *
 * ice_value: reads and writes class instances and graphs of them, in the encodings 1.0 and 1.1
 * (compact and sliced format).
 *
 * Generated code calls beginValues before the first member or parameter that may hold a class, and
 * endValues after the last. Both use tables on the stack of the generated function. Written
 * instances belong to the caller. Received instances are stored in the arena of the message. Slices
 * of unknown types that derive from a type with ["preserve-slice"] are also stored there (preserved
 * slices). When such an instance or exception is written in the sliced format, its preserved slices
 * are sent with it, as other peers of Ice do.
 */
#pragma once

#include "ice_stream.h"

typedef struct Ice_ValueType Ice_ValueType;

struct Ice_Value;

/* A preserved slice of unknown type. */
typedef struct Ice_UnknownSlice {
    /* next slice of the same instance, towards its base; 0 after the last one */
    struct Ice_UnknownSlice* next;
    /* next slice in the message; only the run time uses this member */
    struct Ice_UnknownSlice* nextRead;
    Ice_String typeId;
    /* compact id, which is sent instead of typeId; -1 if the slice has none */
    Ice_Int compactId;
    /* flags of the slice: whether it has optional members, and whether it is the last slice */
    Ice_Byte flags;
    const Ice_Byte* data; /* encoded members of the slice, in the message */
    Ice_Int size;
    Ice_Int count; /* number of instances to which the members refer */
    union {
        Ice_Int number; /* number of the slice in the message; valid until endValues */
        const struct Ice_Value* value;
    }* values;
} Ice_UnknownSlice;

/* First member of every class instance. */
typedef struct Ice_Value {
    const Ice_ValueType* type;
    /* slices of unknown types, the most derived one first; 0 without such slices */
    const Ice_UnknownSlice* unknown;
} Ice_Value;

struct Ice_ValueType {
    const char* id;            /* "::M::C" */
    const Ice_ValueType* base; /* direct base; 0 without a base */
    Ice_Int compactId;         /* compact id; -1 without one */
    Ice_Int size;              /* size of the struct in bytes */
    /* 1: slices of unknown types are preserved */
    Ice_Bool preserves;
    void (*write)(const void* object, Ice_OutputStreamPtr os); /* own members */
    void (*read)(void* object, Ice_InputStreamPtr is);
};

/* The class ::Ice::Object. It is the type of instances without members, and of received instances
 * that have only slices of unknown types. */
extern const Ice_ValueType Ice_Value_type;

/* Returns 1 if the instance has this type or a type derived from it; 0 for a null instance. */
int Ice_Value_isA(const Ice_Value* v, const Ice_ValueType* type);
/* Returns the instance `v` of any class if it has this type or a type derived from it, otherwise 0.
 * The generated M_Node_cast(v) does the same, with an M_Node* as its result. */
void* Ice_Value_cast(const void* v, const Ice_ValueType* type);

typedef struct Ice_OutputValues {
    const Ice_Value* known[ICE_VALUES_MAX]; /* instances in the order of their numbers */
    Ice_Int count, written;
    Ice_String types[ICE_VALUE_TYPES_MAX];
    Ice_Int typeCount;
    /* indirection tables of the slices that are being written */
    const Ice_Value* table[ICE_VALUES_MAX];
    Ice_Int tableBegin, tableEnd;
    /* Encoding 1.0: 1 if instances follow the parameters. It is 0 if only optional parameters have
     * classes, because encoding 1.0 omits these parameters. */
    Ice_Bool pending;
    /* function that writes the indirection table of an exception's slice */
    Ice_Bool (*writeTable)(Ice_OutputStreamPtr os);
} Ice_OutputValues;

void Ice_OutputStream_beginValues(Ice_OutputStreamPtr os, Ice_OutputValues* values);
/* Writes an instance; a pointer of 0 is written as the null instance. More than ICE_VALUES_MAX
 * instances fail the stream. */
void Ice_OutputStream_writeValue(Ice_OutputStreamPtr os, const Ice_Value* v);
void Ice_OutputStream_endValues(Ice_OutputStreamPtr os);

typedef struct Ice_InputValues {
    const Ice_ValueType* const* types; /* classes known to the program; 0 marks the end */
    /* instances by number; 0 for an instance of an unknown type */
    Ice_Value* known[ICE_VALUES_MAX];
    Ice_Int count;
    Ice_String typeIds[ICE_VALUE_TYPES_MAX];
    Ice_Int typeCount;
    struct {
        void* at; /* address of the pointer that is to be set */
        const Ice_ValueType* expected;
        Ice_Int number;
    } patches[ICE_VALUES_MAX]; /* pointers to instances that have not arrived yet */
    Ice_Int patchBegin, patchEnd;
    /* pointers to instances of types that are not known yet */
    struct Ice_LatePatch* late;
    /* slices of unknown types in the message, the last one first */
    Ice_UnknownSlice* unknown;
    Ice_Bool pending; /* same meaning as in Ice_OutputValues */
    /* function that reads the indirection table of an exception's slice */
    void (*readTable)(Ice_InputStreamPtr is);
    /* function that skips an optional value that the reader does not know */
    void (*skip)(Ice_InputStreamPtr is);
} Ice_InputValues;

void Ice_InputStream_beginValues(Ice_InputStreamPtr is, Ice_InputValues* values,
                                 const Ice_ValueType* const* types);
/* Sets the pointer at `at`, now or in endValues. Fails the stream if the instance is not of type
 * `expected` (0 allows any type), or if the type of the instance is unknown. */
void Ice_InputStream_readValue(Ice_InputStreamPtr is, void* at, const Ice_ValueType* expected);
void Ice_InputStream_endValues(Ice_InputStreamPtr is);

/* ---- unknown slices of exceptions, within beginValues and endValues ---- */

/* Skips a slice of type `id` as skipSlice does. If the encoding can preserve slices, also appends
 * the slice to the list; an empty list is 0. */
Ice_Bool Ice_InputStream_keepSlice(Ice_InputStreamPtr is, Ice_String id, Ice_UnknownSlice** list);
/* Writes preserved slices before the slices of the exception. In formats other than the sliced
 * format, writes nothing. */
void Ice_OutputStream_writeUnknown(Ice_OutputStreamPtr os, const Ice_UnknownSlice* list);
