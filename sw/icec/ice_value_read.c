/* SPDX-License-Identifier: MIT
 *
 * ice_value_read: instances of classes from a stream. ice_value_write.c says how they lie there.
 */
#include "ice_slice.h"
#include "ice_value.h"

#include <string.h>

static void readTable(Ice_InputStreamPtr is);
static void skip(Ice_InputStreamPtr is);
static Ice_Int readInstance(Ice_InputStreamPtr is, Ice_Int number);

int Ice_Value_isA(const Ice_Value* v, const Ice_ValueType* type) {
    const Ice_ValueType* t = v ? v->type : 0;
    while (t && t != type)
        t = t->base;
    return t != 0;
}

void Ice_InputStream_beginValues(Ice_InputStreamPtr is, Ice_InputValues* values,
                                 const Ice_ValueType* const* types) {
    memset(values, 0, sizeof *values);
    values->types = types;
    values->readTable = readTable;
    values->skip = skip;
    values->pending = 1;
    is->values = values;
}

/* Sets a pointer to the instance of this number, which must have been read. */
static void set(Ice_InputStreamPtr is, void* at, Ice_Int number, const Ice_ValueType* expected) {
    Ice_InputValues* values = is->values;
    Ice_Value* v = number >= 1 && number <= values->count ? values->known[number - 1] : 0;
    if (!v || (expected && !Ice_Value_isA(v, expected)))
        is->failed = 1;
    else
        memcpy(at, &v, sizeof v);
}

static void setLater(Ice_InputStreamPtr is, void* at, Ice_Int number,
                     const Ice_ValueType* expected) {
    Ice_InputValues* values = is->values;
    if (values->patchEnd == ICE_VALUES_MAX) {
        is->failed = 1;
        return;
    }
    values->patches[values->patchEnd].at = at;
    values->patches[values->patchEnd].number = number;
    values->patches[values->patchEnd++].expected = expected;
}

void Ice_InputStream_readValue(Ice_InputStreamPtr is, void* at, const Ice_ValueType* expected) {
    void* none = 0;
    Ice_Int number;
    memcpy(at, &none, sizeof none);
    if (!is->values)
        is->failed = 1;
    if (is->failed)
        return;
    if (is->minor == 0) {
        number = Ice_InputStream_readInt(is);
        if (number > 0)
            is->failed = 1;
        else if (number < 0)
            setLater(is, at, -number, expected);
        return;
    }
    number = Ice_InputStream_readSize(is);
    if (number == 0)
        return;
    if (is->sliceFlags & ICE_SLICE_TABLE && is->sliceFlags & ICE_SLICE_INSIDE) {
        setLater(is, at, number, expected);
        return;
    }
    number = readInstance(is, number);
    if (!is->failed)
        set(is, at, number, expected);
}

static void skip(Ice_InputStreamPtr is) {
    Ice_Int number = Ice_InputStream_readSize(is);
    if (number != 0 && !(is->sliceFlags & ICE_SLICE_TABLE))
        (void)readInstance(is, number);
}

/* Behind a slice: the instances that its members, the patches from patchBegin, point at. */
static void readTable(Ice_InputStreamPtr is) {
    Ice_InputValues* values = is->values;
    Ice_Int count = Ice_InputStream_readSequence(is, 1), first = values->patchBegin;
    Ice_Int last = values->patchEnd, i, p;
    values->patchBegin = last;
    for (i = 1; i <= count && !is->failed; ++i) {
        Ice_Int number = readInstance(is, Ice_InputStream_readSize(is));
        for (p = first; p < last && !is->failed; ++p)
            if (values->patches[p].number == i)
                set(is, values->patches[p].at, number, values->patches[p].expected);
    }
    for (p = first; p < last; ++p)
        if (values->patches[p].number > count)
            is->failed = 1;
    values->patchBegin = first;
    values->patchEnd = first;
}

static Ice_String typeByIndex(Ice_InputStreamPtr is) {
    static const Ice_String none = {0, ""};
    Ice_Int index = Ice_InputStream_readSize(is);
    if (index >= 1 && index <= is->values->typeCount)
        return is->values->typeIds[index - 1];
    is->failed = 1;
    return none;
}

static Ice_String typeByName(Ice_InputStreamPtr is) {
    Ice_String id = Ice_InputStream_readString(is);
    if (is->values->typeCount == ICE_VALUE_TYPES_MAX)
        is->failed = 1;
    else
        is->values->typeIds[is->values->typeCount++] = id;
    return id;
}

/* The head of a slice. The type is found, or 0. `isObject`: it ends an instance of 1.0. */
static const Ice_ValueType* startSlice(Ice_InputStreamPtr is, Ice_Bool* isObject) {
    const Ice_ValueType* const* type = is->values->types;
    Ice_String id = {0, ""};
    Ice_Int compact = -1, begin, size;
    if (is->minor == 0) {
        is->sliceFlags = ICE_SLICE_SIZE | ICE_SLICE_INSIDE;
        id = Ice_InputStream_readBool(is) ? typeByIndex(is) : typeByName(is);
    } else {
        is->sliceFlags = (Ice_Byte)(Ice_InputStream_readByte(is) | ICE_SLICE_INSIDE);
        switch (is->sliceFlags & ICE_SLICE_COMPACT_ID) {
        case ICE_SLICE_COMPACT_ID:
            compact = Ice_InputStream_readSize(is);
            break;
        case ICE_SLICE_TYPE_INDEX:
            id = typeByIndex(is);
            break;
        case ICE_SLICE_TYPE_STRING:
            id = typeByName(is);
            break;
        default: /* a base, in the compact format */
            break;
        }
    }
    is->sliceEnd = 0;
    begin = is->position;
    if (is->sliceFlags & ICE_SLICE_SIZE) {
        size = Ice_InputStream_readInt(is);
        if (size < 4 || size > is->size - begin)
            is->failed = 1;
        else
            is->sliceEnd = begin + size;
    }
    *isObject = (Ice_Bool)(Ice_String_equals(id, "::Ice::Object") != 0);
    for (; *type && !is->failed; ++type)
        if (compact >= 0 ? (*type)->compactId == compact : Ice_String_equals(id, (*type)->id))
            return *type;
    return 0;
}

/* Skips slices down to one whose type is known; 0: there is none. */
static const Ice_ValueType* knownType(Ice_InputStreamPtr is) {
    for (;;) {
        Ice_Bool isObject;
        const Ice_ValueType* type = startSlice(is, &isObject);
        Ice_Byte flags = is->sliceFlags;
        if (is->failed || type)
            return type;
        if (is->sliceEnd == 0 || (is->minor == 0 && isObject)) {
            is->failed = 1; /* the format does not say where it ends */
            return 0;
        }
        is->position = is->sliceEnd;
        if (flags & ICE_SLICE_TABLE)
            readTable(is);
        if (flags & ICE_SLICE_LAST)
            return 0;
    }
}

/* The slices of one instance, which gets this number. */
static void readSlices(Ice_InputStreamPtr is, Ice_Int number) {
    const Ice_ValueType* type = knownType(is);
    Ice_Bool isObject;
    Ice_Value* v;
    if (is->failed || !type)
        return;
    v = (Ice_Value*)Ice_InputStream_allocate(is, 1, type->size);
    if (!v)
        return;
    memset(v, 0, (size_t)type->size);
    v->type = type;
    is->values->known[number - 1] = v;
    for (; type && !is->failed; type = type->base) {
        type->read(v, is);
        Ice_InputStream_endSlice(is);
        if (!type->base != (is->minor != 0 && is->sliceFlags & ICE_SLICE_LAST) && is->minor != 0)
            is->failed = 1;
        else if (type->base)
            (void)startSlice(is, &isObject);
    }
    if (is->minor == 0 && !is->failed) {
        (void)startSlice(is, &isObject);
        if (!isObject || Ice_InputStream_readSize(is) != 0)
            is->failed = 1;
    }
}

/* `number` as it stands on the wire: 1 is followed by an instance. The result is its number,
 * from 1. */
static Ice_Int readInstance(Ice_InputStreamPtr is, Ice_Int number) {
    Ice_InputValues* values = is->values;
    Ice_Byte flags = is->sliceFlags;
    Ice_Int sliceEnd = is->sliceEnd, patchBegin = values->patchBegin;
    if (is->failed || number < 1 || number > values->count + 1 ||
        (number == 1 && values->count == ICE_VALUES_MAX)) {
        is->failed = 1;
        return 0;
    }
    if (number > 1)
        return number - 1;
    number = ++values->count;
    values->patchBegin = values->patchEnd;
    readSlices(is, number);
    values->patchBegin = patchBegin;
    is->sliceFlags = flags;
    is->sliceEnd = sliceEnd;
    return number;
}

void Ice_InputStream_endValues(Ice_InputStreamPtr is) {
    Ice_InputValues* values = is->values;
    Ice_Int n, p;
    while (is->minor == 0 && values->pending && !is->failed) {
        n = Ice_InputStream_readSequence(is, 5);
        if (n == 0)
            break;
        while (n-- > 0 && !is->failed) {
            Ice_Int number = Ice_InputStream_readInt(is);
            if (number < 1 || number > ICE_VALUES_MAX || values->known[number - 1]) {
                is->failed = 1;
                break;
            }
            if (number > values->count)
                values->count = number;
            readSlices(is, number);
        }
    }
    is->sliceFlags = 0;
    is->sliceEnd = 0;
    for (p = 0; is->minor == 0 && p < values->patchEnd && !is->failed; ++p)
        set(is, values->patches[p].at, values->patches[p].number, values->patches[p].expected);
    is->values = 0;
}
