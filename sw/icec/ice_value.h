/* SPDX-License-Identifier: MIT
 *
 * ice_value: classes: graphs of instances, in the encodings 1.0 and 1.1 (compact and sliced).
 *
 * Generated code calls beginValues before the first member or parameter that may hold a class, and
 * endValues after the last. The tables are on its stack. Written instances belong to the caller.
 * Received instances are stored in the message's arena, and so are preserved slices: slices of
 * unknown types derived from one with ["preserve-slice"]. They are sent again with the instance (or
 * exception) when it is written in the sliced format, as by Ice's other peers.
 */
#pragma once

#include "ice_stream.h"

typedef struct Ice_ValueType Ice_ValueType;

struct Ice_Value;

/* A preserved slice of an unknown type. */
typedef struct Ice_UnknownSlice {
    struct Ice_UnknownSlice* next;     /* next of the same instance, towards the base; 0: end */
    struct Ice_UnknownSlice* nextRead; /* next in the message, for the run time */
    Ice_String typeId;
    Ice_Int compactId;    /* replaces typeId; -1: not used */
    Ice_Byte flags;       /* whether it has optional members, whether it is the last */
    const Ice_Byte* data; /* its members, in the message */
    Ice_Int size;
    Ice_Int count; /* number of instances that the members refer to */
    union {
        Ice_Int number; /* valid until the end of the message */
        const struct Ice_Value* value;
    }* values;
} Ice_UnknownSlice;

/* First member of every class instance. */
typedef struct Ice_Value {
    const Ice_ValueType* type;
    const Ice_UnknownSlice* unknown; /* the most derived one; 0 if none */
} Ice_Value;

struct Ice_ValueType {
    const char* id;                                            /* "::M::C" */
    const Ice_ValueType* base;                                 /* 0 if none */
    Ice_Int compactId;                                         /* -1 if none */
    Ice_Int size;                                              /* bytes of the struct */
    Ice_Bool preserves;                                        /* it preserves unknown slices */
    void (*write)(const void* object, Ice_OutputStreamPtr os); /* own members */
    void (*read)(void* object, Ice_InputStreamPtr is);
};

/* The class ::Ice::Object: the type of instances without members, and of instances received with
 * unknown slices only. */
extern const Ice_ValueType Ice_Value_type;

/* Returns 1 if the instance is of this type or of one derived from it; 0 for a null instance. */
int Ice_Value_isA(const Ice_Value* v, const Ice_ValueType* type);
/* Returns the instance `v` of any class if it has this type or a type derived from it, else 0.
 * Generated M_Node_cast(v) returns it as an M_Node*. */
void* Ice_Value_cast(const void* v, const Ice_ValueType* type);

typedef struct Ice_OutputValues {
    const Ice_Value* known[ICE_VALUES_MAX]; /* instances by their numbers */
    Ice_Int count, written;
    Ice_String types[ICE_VALUE_TYPES_MAX];
    Ice_Int typeCount;
    const Ice_Value* table[ICE_VALUES_MAX]; /* indirection tables of the current slices */
    Ice_Int tableBegin, tableEnd;
    /* Encoding 1.0: 1 if instances follow the parameters; 0 if only optional parameters, which 1.0
     * omits, have classes. */
    Ice_Bool pending;
    Ice_Bool (*writeTable)(Ice_OutputStreamPtr os); /* for slices of exceptions */
} Ice_OutputValues;

void Ice_OutputStream_beginValues(Ice_OutputStreamPtr os, Ice_OutputValues* values);
/* Writes an instance, 0 as the null instance. More than ICE_VALUES_MAX fail the stream. */
void Ice_OutputStream_writeValue(Ice_OutputStreamPtr os, const Ice_Value* v);
void Ice_OutputStream_endValues(Ice_OutputStreamPtr os);

typedef struct Ice_InputValues {
    const Ice_ValueType* const* types; /* known classes; 0 marks the end */
    Ice_Value* known[ICE_VALUES_MAX];  /* by number; 0 for an unknown type */
    Ice_Int count;
    Ice_String typeIds[ICE_VALUE_TYPES_MAX];
    Ice_Int typeCount;
    struct {
        void* at; /* address of the pointer */
        const Ice_ValueType* expected;
        Ice_Int number;
    } patches[ICE_VALUES_MAX]; /* for instances that arrive later */
    Ice_Int patchBegin, patchEnd;
    struct Ice_LatePatch* late;               /* pointers to instances of types not known yet */
    Ice_UnknownSlice* unknown;                /* slices of the message, the last one first */
    Ice_Bool pending;                         /* as in Ice_OutputValues */
    void (*readTable)(Ice_InputStreamPtr is); /* for slices of exceptions */
    void (*skip)(Ice_InputStreamPtr is);      /* skips an optional that the reader does not know */
} Ice_InputValues;

void Ice_InputStream_beginValues(Ice_InputStreamPtr is, Ice_InputValues* values,
                                 const Ice_ValueType* const* types);
/* Sets the pointer at `at`, now or in endValues. An instance that is not an `expected` (0: any), or
 * has no known type, fails the stream. */
void Ice_InputStream_readValue(Ice_InputStreamPtr is, void* at, const Ice_ValueType* expected);
void Ice_InputStream_endValues(Ice_InputStreamPtr is);

/* ---- unknown slices of exceptions, within beginValues and endValues ---- */

/* Skips a slice of type `id` as skipSlice does, and appends it to the list if the encoding can
 * preserve slices. The list begins as 0. */
Ice_Bool Ice_InputStream_keepSlice(Ice_InputStreamPtr is, Ice_String id, Ice_UnknownSlice** list);
/* Writes preserved slices before the exception's; nothing unless the format is sliced. */
void Ice_OutputStream_writeUnknown(Ice_OutputStreamPtr os, const Ice_UnknownSlice* list);
