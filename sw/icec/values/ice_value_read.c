/* SPDX-License-Identifier: MIT
 *
 * ice_value_read: reads class instances from a stream, and finds their types. ice_value_write.c
 * describes the layout.
 */
#include "ice_slice.h"

#include <string.h>

static void noMembers(void* object, Ice_InputStreamPtr is) {
    (void)object, (void)is;
}

static void writeNoMembers(const void* object, Ice_OutputStreamPtr os) {
    (void)object, (void)os;
}

const Ice_ValueType Ice_Value_type = {"::Ice::Object", 0,        -1, (Ice_Int)sizeof(Ice_Value), 1,
                                      writeNoMembers,  noMembers};

int Ice_Value_isA(const Ice_Value* v, const Ice_ValueType* type) {
    const Ice_ValueType* t = v ? v->type : 0;
    while (t && t != type)
        t = t->base;
    return t != 0;
}

void* Ice_Value_cast(const void* v, const Ice_ValueType* type) {
    return Ice_Value_isA((const Ice_Value*)v, type) ? (void*)v : 0;
}

static void readTable(Ice_InputStreamPtr is);
static void skip(Ice_InputStreamPtr is);
static Ice_Int readInstance(Ice_InputStreamPtr is, Ice_Int number);

struct Ice_LatePatch {
    struct Ice_LatePatch* next;
    void* at;
    const Ice_ValueType* expected;
    Ice_Int number;
};

void Ice_InputStream_beginValues(Ice_InputStreamPtr is, Ice_InputValues* values,
                                 const Ice_ValueType* const* types) {
    memset(values, 0, sizeof *values);
    values->types = types;
    values->readTable = readTable;
    values->skip = skip;
    values->pending = 1;
    is->values = values;
}

/* Sets a pointer to the instance with this number. If the type of the instance is not known yet,
 * the pointer is set at the end of the message instead. */
static void set(Ice_InputStreamPtr is, void* at, Ice_Int number, const Ice_ValueType* expected,
                Ice_Bool last) {
    Ice_InputValues* values = is->values;
    Ice_Bool begun = number >= 1 && number <= values->count;
    Ice_Value* v = begun ? values->known[number - 1] : 0;
    if (begun && !v && !last && is->minor != 0) {
        struct Ice_LatePatch* patch =
            (struct Ice_LatePatch*)Ice_InputStream_allocate(is, 1, (Ice_Int)sizeof *patch);
        if (!patch)
            return;
        patch->next = values->late;
        patch->at = at;
        patch->number = number;
        patch->expected = expected;
        values->late = patch;
    } else if (!v || (expected && !Ice_Value_isA(v, expected))) {
        icec_failRead(is, ICE_FAILED_MALFORMED);
    } else {
        memcpy(at, &v, sizeof v);
    }
}

static void setLater(Ice_InputStreamPtr is, void* at, Ice_Int number,
                     const Ice_ValueType* expected) {
    Ice_InputValues* values = is->values;
    if (values->patchEnd == ICE_VALUES_MAX) {
        icec_failRead(is, ICE_FAILED_VALUES);
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
        icec_failRead(is, ICE_FAILED_MALFORMED);
    if (is->failed)
        return;
    if (is->minor == 0) {
        number = Ice_InputStream_readInt(is);
        if (number > 0 || number < -ICE_VALUES_MAX)
            icec_failRead(is, number > 0 ? ICE_FAILED_MALFORMED : ICE_FAILED_VALUES);
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
        set(is, at, number, expected, 0);
}

static void skip(Ice_InputStreamPtr is) {
    Ice_Int number = Ice_InputStream_readSize(is);
    if (number != 0 && !(is->sliceFlags & ICE_SLICE_TABLE))
        (void)readInstance(is, number);
}

/* Reads the indirection table that follows a slice. The table contains the instances to which the
 * slice's members refer. The pointers in these members are the patches patchBegin to patchEnd. */
static void readTable(Ice_InputStreamPtr is) {
    Ice_InputValues* values = is->values;
    Ice_Int count = Ice_InputStream_readSequence(is, 1), first = values->patchBegin;
    Ice_Int last = values->patchEnd, i, p;
    values->patchBegin = last;
    for (i = 1; i <= count && !is->failed; ++i) {
        Ice_Int number = readInstance(is, Ice_InputStream_readSize(is));
        for (p = first; p < last && !is->failed; ++p)
            if (values->patches[p].number == i)
                set(is, values->patches[p].at, number, values->patches[p].expected, 0);
    }
    for (p = first; p < last; ++p)
        if (values->patches[p].number > count)
            icec_failRead(is, ICE_FAILED_MALFORMED);
    values->patchBegin = first;
    values->patchEnd = first;
}

/* Preserves the current slice and skips it; only possible in encoding 1.1. Returns 0 if the end of
 * the slice is unknown, or if it does not fit. */
static Ice_UnknownSlice* keepSlice(Ice_InputStreamPtr is, Ice_String id, Ice_Int compactId) {
    Ice_Byte flags = is->sliceFlags, optionals = (flags & ICE_SLICE_OPTIONALS) != 0;
    Ice_UnknownSlice* slice;
    if (is->failed || is->sliceEnd - is->position < optionals) {
        icec_failRead(is, ICE_FAILED_MALFORMED);
        return 0;
    }
    slice = (Ice_UnknownSlice*)Ice_InputStream_allocate(is, 1, (Ice_Int)sizeof *slice);
    if (!slice)
        return 0;
    memset(slice, 0, sizeof *slice);
    slice->typeId = id;
    slice->compactId = compactId;
    slice->flags = flags & (ICE_SLICE_OPTIONALS | ICE_SLICE_LAST);
    slice->data = is->data + is->position;
    /* excludes the end mark of optional members, because writing the slice adds it again */
    slice->size = is->sliceEnd - is->position - optionals;
    is->position = is->sliceEnd;
    if (flags & ICE_SLICE_TABLE) {
        Ice_Int count = Ice_InputStream_readSequence(is, 1), i;
        void* room = Ice_InputStream_allocate(is, count, (Ice_Int)sizeof *slice->values);
        /* copies the pointer, because the type to which `values` points has no name for a cast */
        memcpy(&slice->values, &room, sizeof room);
        for (i = 0; i < count && !is->failed; ++i)
            slice->values[i].number = readInstance(is, Ice_InputStream_readSize(is));
        slice->count = is->failed ? 0 : count;
    }
    slice->nextRead = is->values->unknown;
    is->values->unknown = slice;
    return is->failed ? 0 : slice;
}

Ice_Bool Ice_InputStream_keepSlice(Ice_InputStreamPtr is, Ice_String id, Ice_UnknownSlice** list) {
    Ice_UnknownSlice* slice;
    if (is->minor == 0 || is->failed || is->sliceEnd == 0)
        return Ice_InputStream_skipSlice(is);
    slice = keepSlice(is, id, -1);
    while (*list)
        list = &(*list)->next;
    *list = slice;
    return slice && !(slice->flags & ICE_SLICE_LAST) && is->position < is->size;
}

/* Sets the pointers in preserved slices; called at the end of the message. */
static void endUnknown(Ice_InputStreamPtr is) {
    Ice_InputValues* values = is->values;
    Ice_UnknownSlice* slice;
    Ice_Int i;
    for (slice = values->unknown; slice && !is->failed; slice = slice->nextRead)
        for (i = 0; i < slice->count; ++i)
            slice->values[i].value = values->known[slice->values[i].number - 1];
}

typedef struct SliceHead {
    Ice_String id;
    Ice_Int compactId;         /* compact id; -1 without one */
    const Ice_ValueType* type; /* type of the slice; 0 if it is unknown */
    /* 1 for ::Ice::Object, the base of all classes; its slice ends an instance in encoding 1.0 */
    Ice_Bool isObject;
} SliceHead;

static Ice_String typeByIndex(Ice_InputStreamPtr is) {
    static const Ice_String none = {0, ""};
    Ice_Int index = Ice_InputStream_readSize(is);
    if (index >= 1 && index <= is->values->typeCount)
        return is->values->typeIds[index - 1];
    icec_failRead(is, ICE_FAILED_MALFORMED);
    return none;
}

static Ice_String typeByName(Ice_InputStreamPtr is) {
    Ice_String id = Ice_InputStream_readString(is);
    if (is->values->typeCount == ICE_VALUE_TYPES_MAX)
        icec_failRead(is, ICE_FAILED_VALUE_TYPES);
    else
        is->values->typeIds[is->values->typeCount++] = id;
    return id;
}

/* Reads the header of an instance's slice. */
static void startSlice(Ice_InputStreamPtr is, SliceHead* head) {
    const Ice_ValueType* const* type = is->values->types;
    head->id = Ice_String_from("");
    head->compactId = -1;
    head->type = 0;
    if (is->minor == 0) {
        is->sliceFlags = ICE_SLICE_SIZE | ICE_SLICE_INSIDE;
        head->id = Ice_InputStream_readBool(is) ? typeByIndex(is) : typeByName(is);
    } else {
        is->sliceFlags = (Ice_Byte)(Ice_InputStream_readByte(is) | ICE_SLICE_INSIDE);
        switch (is->sliceFlags & ICE_SLICE_COMPACT_ID) {
        case ICE_SLICE_COMPACT_ID:
            head->compactId = Ice_InputStream_readSize(is);
            break;
        case ICE_SLICE_TYPE_INDEX:
            head->id = typeByIndex(is);
            break;
        case ICE_SLICE_TYPE_STRING:
            head->id = typeByName(is);
            break;
        default: /* in the compact format, the slice of a base has no type */
            break;
        }
    }
    is->sliceEnd = icec_readSliceEnd(is, is->sliceFlags);
    head->isObject = (Ice_Bool)(Ice_String_equals(head->id, Ice_Value_type.id) != 0);
    if (head->isObject)
        head->type = &Ice_Value_type;
    for (; *type && !is->failed && !head->type; ++type)
        if (head->compactId >= 0 ? (*type)->compactId == head->compactId
                                 : Ice_String_equals(head->id, (*type)->id))
            head->type = *type;
}

/* Reads the last slice of an instance in encoding 1.0: the slice of ::Ice::Object, with a size
 * of 0. */
static void readEnd10(Ice_InputStreamPtr is) {
    if (Ice_InputStream_readSize(is) != 0)
        icec_failRead(is, ICE_FAILED_MALFORMED);
}

/* Skips slices up to the first one with a known type. If all types are unknown, the instance
 * becomes an Ice_Value_type without slices. Encoding 1.0 cannot preserve slices, so such an
 * instance is dropped. */
static const Ice_ValueType* knownType(Ice_InputStreamPtr is, Ice_UnknownSlice** list) {
    Ice_Bool isFirst;
    for (isFirst = 1;; isFirst = 0) {
        SliceHead head;
        startSlice(is, &head);
        if (is->minor == 0 && head.isObject && !isFirst) {
            readEnd10(is); /* no pointer may refer to the dropped instance */
            return 0;
        }
        if (is->failed || (head.isObject && !isFirst)) {
            icec_failRead(is, ICE_FAILED_MALFORMED);
            return 0;
        }
        if (head.type)
            return head.type;
        if (is->sliceEnd == 0) {
            /* in this format, the end of the slice is unknown */
            icec_failRead(is, ICE_FAILED_MALFORMED);
            return 0;
        }
        if (is->minor == 0) {
            is->position = is->sliceEnd;
            continue;
        }
        *list = keepSlice(is, head.id, head.compactId);
        if (!*list)
            return 0;
        if ((*list)->flags & ICE_SLICE_LAST)
            return &Ice_Value_type;
        list = &(*list)->next;
    }
}

/* Reads the slices of one instance, which gets this number. */
static void readSlices(Ice_InputStreamPtr is, Ice_Int number) {
    Ice_UnknownSlice* unknown = 0;
    const Ice_ValueType* type = knownType(is, &unknown);
    SliceHead head;
    Ice_Value* v;
    if (is->failed || !type)
        return;
    v = (Ice_Value*)Ice_InputStream_allocate(is, 1, type->size);
    if (!v)
        return;
    memset(v, 0, (size_t)type->size);
    v->type = type;
    v->unknown = type->preserves ? unknown : 0;
    is->values->known[number - 1] = v;
    if (is->minor == 0 && type == &Ice_Value_type) {
        readEnd10(is);
        return;
    }
    if (type == &Ice_Value_type && unknown)
        return; /* all slices had unknown types */
    for (; type && !is->failed; type = type->base) {
        type->read(v, is);
        Ice_InputStream_endSlice(is);
        if (!type->base != (is->minor != 0 && is->sliceFlags & ICE_SLICE_LAST) && is->minor != 0)
            icec_failRead(is, ICE_FAILED_MALFORMED);
        else if (type->base)
            startSlice(is, &head);
    }
    if (is->minor == 0 && !is->failed) {
        startSlice(is, &head);
        if (!head.isObject)
            icec_failRead(is, ICE_FAILED_MALFORMED);
        readEnd10(is);
    }
}

/* Reads a reference to an instance: its number, or 1, which means that a new instance follows.
 * Returns the instance's number, counted from 1. */
static Ice_Int readInstance(Ice_InputStreamPtr is, Ice_Int number) {
    Ice_InputValues* values = is->values;
    Ice_Byte flags = is->sliceFlags;
    Ice_Int sliceEnd = is->sliceEnd, patchBegin = values->patchBegin;
    if (number < 1 || number > values->count + 1)
        icec_failRead(is, ICE_FAILED_MALFORMED);
    if (number == 1 && values->count == ICE_VALUES_MAX)
        icec_failRead(is, ICE_FAILED_VALUES);
    if (is->failed)
        return 0;
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
                icec_failRead(is, ICE_FAILED_MALFORMED);
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
        set(is, values->patches[p].at, values->patches[p].number, values->patches[p].expected, 1);
    for (; values->late && !is->failed; values->late = values->late->next)
        set(is, values->late->at, values->late->number, values->late->expected, 1);
    endUnknown(is);
    is->values = 0;
}
