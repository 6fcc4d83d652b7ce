/* SPDX-License-Identifier: MIT
 *
 * ice_message: writes and reads the headers of IceP messages, and the encapsulations of parameters
 * and results.
 */
#include "ice_message.h"
#include "ice_operation.h"

#include <string.h>

#define TYPE_AT 8
/* offset of the compression byte; 0 and 1 mean not compressed, 2 means compressed */
#define COMPRESSION_AT 9
#define SIZE_AT 10

/* Template of a message header: "IceP", version of the protocol, version of the encoding, type,
 * compression, size. */
static const Ice_Byte head[ICEC_HEADER] = {'I', 'c', 'e', 'P', 1, 0, 1, 0, 0, 0, ICEC_HEADER};

void icec_beginMessage(Ice_OutputStreamPtr os, Ice_Byte type) {
    Ice_OutputStream_init(os, os->data, os->capacity);
    Ice_OutputStream_writeBlob(os, head, ICEC_HEADER);
    os->data[TYPE_AT] = type;
}

void icec_endMessage(Ice_OutputStreamPtr os) {
    icec_patchInt(os, SIZE_AT, os->size);
}

Ice_Int icec_messageSize(const Ice_Byte* header, int* isCompressed) {
    Ice_InputStream is;
    Ice_Int size;
    Ice_InputStream_init(&is, header + COMPRESSION_AT, ICEC_HEADER - COMPRESSION_AT);
    *isCompressed = Ice_InputStream_readByte(&is) == 2;
    size = Ice_InputStream_readInt(&is);
    return memcmp(header, head, TYPE_AT) == 0 && size >= ICEC_HEADER ? size : -1;
}

Ice_Int icec_readHead(Ice_InputStreamPtr is) {
    Ice_Int type;
    const Ice_Byte* begin = Ice_InputStream_readBlob(is, TYPE_AT);
    if (!begin || memcmp(begin, head, TYPE_AT) != 0)
        return -1;
    /* the mask removes bit 0 of the compression, because 0 and 1 both mean not compressed */
    type = Ice_InputStream_readShort(is) & 0xFEFF;
    return Ice_InputStream_readInt(is) == is->size ? type : -1;
}

Ice_Int icec_beginEncapsulation(Ice_OutputStreamPtr os) {
    Ice_Int begin = os->size;
    Ice_OutputStream_writeInt(os, 6);
    Ice_OutputStream_writeShort(os, (Ice_Short)(1 | os->minor << 8));
    return begin;
}

void icec_endEncapsulation(Ice_OutputStreamPtr os, Ice_Int begin) {
    icec_patchInt(os, begin, os->size - begin);
}

Ice_Status icec_enterEncapsulation(Ice_InputStreamPtr is) {
    U32 size = (U32)Ice_InputStream_readInt(is) - 6U;
    U32 version = (U16)Ice_InputStream_readShort(is); /* major, minor */
    if (size > (U32)(is->size - is->position))
        return ICE_MARSHAL;
    is->size = is->position + (Ice_Int)size;
    is->minor = (Ice_Byte)(version >> 8);
    return (version & 0xFEFFU) == 1U ? ICE_OK : ICE_PROTOCOL;
}

void icec_writeFacet(Ice_OutputStreamPtr os, const Ice_String* facet) {
    Ice_OutputStream_writeByte(os, facet->size != 0);
    if (facet->size)
        Ice_OutputStream_writeString(os, *facet);
}

void icec_readFacet(Ice_InputStreamPtr is, Ice_String* facet) {
    Ice_Byte n = Ice_InputStream_readByte(is);
    facet->size = 0;
    if (n > 1)
        is->failed = ICE_FAILED_MALFORMED;
    if (n)
        Ice_InputStream_takeString(is, facet);
}

void icec_skipStrings(Ice_InputStreamPtr is, U32 count) {
    Ice_String skipped;
    for (; count && !is->failed; --count)
        Ice_InputStream_takeString(is, &skipped);
}

void icec_beginReply(Ice_OutputStreamPtr os, Ice_Int id) {
    Ice_OutputStream_writeInt(os, id);
    os->size = ICEC_REPLY_BODY; /* leaves room for the status, which is written last */
    (void)icec_beginEncapsulation(os);
}

void icec_endReply(Ice_OutputStreamPtr os, Ice_Status status, const Icec_Target* target) {
    if (status > ICE_UNKNOWN_EXCEPTION)
        status = status <= ICE_PROTOCOL ? ICE_UNKNOWN_LOCAL_EXCEPTION : ICE_UNKNOWN_EXCEPTION;
    os->data[ICEC_REPLY_BODY - 1] = (Ice_Byte)status;
    if (status <= ICE_USER_EXCEPTION) {
        icec_endEncapsulation(os, ICEC_REPLY_BODY);
    } else {
        os->failed = 0;
        os->size = ICEC_REPLY_BODY;
        if (status <= ICE_OPERATION_NOT_EXIST)
            Ice_OutputStream_writeBlob(os, target->data, target->size);
        else
            Ice_OutputStream_writeByte(os, 0); /* empty reason */
    }
}

Ice_Status icec_readReply(Ice_InputStreamPtr is) {
    Ice_Status code = (Ice_Status)Ice_InputStream_readByte(is);
    Ice_Status entered = ICE_OK;
    if (code > ICE_UNKNOWN_EXCEPTION)
        return ICE_MARSHAL;
    if (code <= ICE_USER_EXCEPTION)
        entered = icec_enterEncapsulation(is);
    return entered != ICE_OK ? entered : code;
}

Ice_Status Ice_Object_dispatch(const Ice_Interface* interface, const void* table,
                               Ice_ObjectPtr self, const Ice_Current* current,
                               Ice_InputStreamPtr is, Ice_OutputStreamPtr os) {
    const Ice_Operation* o;
    const Ice_Base* base;
    for (o = interface->operations; o->name; ++o)
        if (Ice_String_is(&current->operation, o->name)) {
            if (current->mode > 7 || !(o->modes >> current->mode & 1))
                return ICE_PROTOCOL;
            return o->dispatch(self, table, current, is, os);
        }
    for (base = interface->bases; base && base->interface; ++base) {
        Ice_Status status = Ice_Object_dispatch(base->interface, (const char*)table + base->offset,
                                                self, current, is, os);
        if (status != ICE_OPERATION_NOT_EXIST)
            return status;
    }
    return ICE_OPERATION_NOT_EXIST;
}
