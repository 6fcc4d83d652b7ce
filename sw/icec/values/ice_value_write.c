/* SPDX-License-Identifier: MIT
 *
 * ice_value_write: writes instances of classes to a stream.
 *
 * Encoding 1.1: an instance is written where it occurs first; later occurrences are written as its
 * number, counted from 2. In the sliced format, members of a slice are written as an index into a
 * table that follows the slice. Encoding 1.0: each occurrence is written as the negative number of
 * the instance, counted from 1; all instances follow after the parameters.
 */
#include "ice_slice.h"

#include <string.h>

static Ice_Bool writeTable(Ice_OutputStreamPtr os);

void Ice_OutputStream_beginValues(Ice_OutputStreamPtr os, Ice_OutputValues* values) {
    memset(values, 0, sizeof *values);
    values->writeTable = writeTable;
    values->pending = 1;
    os->values = values;
}

/* Returns the index of an instance in `known`. Returns -1 if the instance is new; it was then added
 * at the end. */
static Ice_Int placeOf(Ice_OutputStreamPtr os, const Ice_Value* v, Ice_Int* place) {
    Ice_OutputValues* values = os->values;
    Ice_Int i;
    for (i = 0; i < values->count; ++i)
        if (values->known[i] == v) {
            *place = i;
            return 0;
        }
    if (values->count == ICE_VALUES_MAX) {
        os->failed = ICE_FAILED_VALUES;
        return 0;
    }
    *place = values->count;
    values->known[values->count++] = v;
    return 1;
}

/* Returns the number of a type name that was written before. Returns 0 for a new name, and gives it
 * the next number. */
static Ice_Int typeNumber(Ice_OutputStreamPtr os, Ice_String id) {
    Ice_OutputValues* values = os->values;
    Ice_Int i;
    for (i = 0; i < values->typeCount; ++i)
        if (Ice_String_same(&values->types[i], &id))
            return i + 1;
    if (values->typeCount == ICE_VALUE_TYPES_MAX)
        os->failed = ICE_FAILED_VALUE_TYPES;
    else
        values->types[values->typeCount++] = id;
    return 0;
}

static void writeType(Ice_OutputStreamPtr os, Ice_String id, Ice_Int compactId) {
    Ice_Int number;
    if (compactId >= 0) {
        os->sliceFlags |= ICE_SLICE_COMPACT_ID;
        Ice_OutputStream_writeSize(os, compactId);
        return;
    }
    number = typeNumber(os, id);
    os->sliceFlags |= number ? ICE_SLICE_TYPE_INDEX : ICE_SLICE_TYPE_STRING;
    if (number)
        Ice_OutputStream_writeSize(os, number);
    else
        Ice_OutputStream_writeString(os, id);
}

/* Writes preserved slices. Slices of an exception have no flags for the kind of their type, because
 * this type is always a string. */
static void writeUnknown(Ice_OutputStreamPtr os, const Ice_UnknownSlice* slice,
                         Ice_Bool isException) {
    Ice_OutputValues* values = os->values;
    for (; slice && !os->failed; slice = slice->next) {
        Ice_Int begin = os->size, i;
        os->sliceFlags = (Ice_Byte)(ICE_SLICE_INSIDE | ICE_SLICE_SIZE | slice->flags);
        Ice_OutputStream_writeByte(os, 0);
        if (isException)
            Ice_OutputStream_writeString(os, slice->typeId);
        else
            writeType(os, slice->typeId, slice->compactId);
        i = os->size;
        Ice_OutputStream_writeInt(os, 0);
        Ice_OutputStream_writeBlob(os, slice->data, slice->size);
        if (slice->count > ICE_VALUES_MAX - values->tableEnd) {
            os->failed = ICE_FAILED_VALUES;
            return;
        }
        for (; values->tableEnd - values->tableBegin < slice->count; ++values->tableEnd)
            values->table[values->tableEnd] =
                slice->values[values->tableEnd - values->tableBegin].value;
        icec_finishSlice(os, begin, i);
    }
}

void Ice_OutputStream_writeUnknown(Ice_OutputStreamPtr os, const Ice_UnknownSlice* list) {
    if (os->minor != 0 && os->sliced)
        writeUnknown(os, list, 1);
}

static void writeSlices11(Ice_OutputStreamPtr os, const Ice_Value* v) {
    const Ice_ValueType* type = v->type;
    if (os->sliced && v->unknown) {
        writeUnknown(os, v->unknown, 0);
        if (type == &Ice_Value_type)
            return; /* one of the preserved slices was the last slice of the instance */
    }
    for (; type; type = type->base) {
        Ice_Int begin = os->size, body;
        os->sliceFlags = (Ice_Byte)(ICE_SLICE_INSIDE | (os->sliced ? ICE_SLICE_SIZE : 0) |
                                    (type->base ? 0 : ICE_SLICE_LAST));
        Ice_OutputStream_writeByte(os, 0);
        if (os->sliced || type == v->type)
            writeType(os, Ice_String_from(type->id), type->compactId);
        if (os->sliced)
            Ice_OutputStream_writeInt(os, 0);
        body = os->size;
        type->write(v, os);
        icec_finishSlice(os, begin, os->sliced ? body - 4 : -1);
    }
}

/* Writes an instance; if it was written before, writes its number. */
static void writeInstance(Ice_OutputStreamPtr os, const Ice_Value* v) {
    Ice_Int place = 0, tableBegin = os->values->tableBegin;
    Ice_Byte flags = os->sliceFlags;
    if (!placeOf(os, v, &place)) {
        Ice_OutputStream_writeSize(os, place + 2);
        return;
    }
    Ice_OutputStream_writeSize(os, 1);
    os->values->tableBegin = os->values->tableEnd;
    writeSlices11(os, v);
    os->values->tableBegin = tableBegin;
    os->sliceFlags = flags;
}

/* Writes the table of the instances to which a slice's members refer, after the slice. Returns 0 if
 * no such instances exist. */
static Ice_Bool writeTable(Ice_OutputStreamPtr os) {
    Ice_OutputValues* values = os->values;
    Ice_Int begin = values->tableBegin, end = values->tableEnd, i;
    if (begin == end)
        return 0;
    Ice_OutputStream_writeSize(os, end - begin);
    for (i = begin; i < end; ++i)
        writeInstance(os, values->table[i]);
    values->tableEnd = begin;
    return 1;
}

static void writeIndirect(Ice_OutputStreamPtr os, const Ice_Value* v) {
    Ice_OutputValues* values = os->values;
    Ice_Int i;
    for (i = values->tableBegin; i < values->tableEnd; ++i)
        if (values->table[i] == v)
            break;
    if (i == ICE_VALUES_MAX) {
        os->failed = ICE_FAILED_VALUES;
        return;
    }
    if (i == values->tableEnd)
        values->table[values->tableEnd++] = v;
    Ice_OutputStream_writeSize(os, i - values->tableBegin + 1);
}

void Ice_OutputStream_writeValue(Ice_OutputStreamPtr os, const Ice_Value* v) {
    Ice_Int place = 0;
    if (os->failed)
        return;
    if (!os->values) {
        os->failed = ICE_FAILED_MALFORMED;
    } else if (os->minor == 0) {
        if (v)
            (void)placeOf(os, v, &place);
        Ice_OutputStream_writeInt(os, v ? -(place + 1) : 0);
    } else if (!v) {
        Ice_OutputStream_writeSize(os, 0);
    } else if (os->sliced && os->sliceFlags & ICE_SLICE_INSIDE) {
        writeIndirect(os, v);
    } else {
        writeInstance(os, v);
    }
}

static void writeSlice10(Ice_OutputStreamPtr os, const Ice_ValueType* type, const Ice_Value* v) {
    Ice_String id = Ice_String_from(type->id);
    Ice_Int number = typeNumber(os, id), begin;
    Ice_OutputStream_writeBool(os, number != 0);
    if (number)
        Ice_OutputStream_writeSize(os, number);
    else
        Ice_OutputStream_writeString(os, id);
    begin = os->size;
    Ice_OutputStream_writeInt(os, 0);
    if (type == &Ice_Value_type)
        /* number of facets; only very old versions of Ice had facets here */
        Ice_OutputStream_writeSize(os, 0);
    else
        type->write(v, os);
    icec_patchSize(os, begin);
}

/* Ends the values. In encoding 1.0, the instances follow here, in groups: each group contains the
 * instances to which members of the previous group refer. */
void Ice_OutputStream_endValues(Ice_OutputStreamPtr os) {
    Ice_OutputValues* values = os->values;
    while (os->minor == 0 && !os->failed && values->written < values->count) {
        Ice_Int i = values->written, end = values->count;
        Ice_OutputStream_writeSize(os, end - i);
        for (; i < end; ++i) {
            const Ice_ValueType* type;
            Ice_OutputStream_writeInt(os, i + 1);
            for (type = values->known[i]->type; type && type != &Ice_Value_type; type = type->base)
                writeSlice10(os, type, values->known[i]);
            writeSlice10(os, &Ice_Value_type, values->known[i]);
        }
        values->written = end;
    }
    if (os->minor == 0 && values->pending)
        Ice_OutputStream_writeSize(os, 0);
    os->values = 0;
}
