/* SPDX-License-Identifier: MIT
 *
 * ice_value_slice: classes and their types, and the heads of received instances' slices.
 */
#include "ice_slice.h"

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

void icec_startSlice(Ice_InputStreamPtr is, Icec_SliceHead* head) {
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
        default: /* a base, in the compact format */
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
