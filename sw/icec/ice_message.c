/* SPDX-License-Identifier: MIT
 *
 * ice_message: heads of messages and encapsulations.
 */
#include "ice_private.h"

void Ice_patchInt(Ice_OutputStreamPtr os, Ice_Int at, Ice_Int value) {
    Ice_Int end = os->size;
    if (os->failed)
        return;
    os->size = at;
    Ice_OutputStream_writeInt(os, value);
    os->size = end;
}

const Ice_Byte Ice_head[ICE_HEADER] = {'I', 'c', 'e', 'P', 1, 0, 1, 0, 0, 0, ICE_HEADER, 0, 0, 0};

void Ice_beginMessage(Ice_OutputStreamPtr os, Ice_Byte type) {
    Ice_OutputStream_writeBlob(os, Ice_head, ICE_HEADER);
    os->data[ICE_TYPE_AT] = type;
}

void Ice_endMessage(Ice_OutputStreamPtr os) {
    Ice_patchInt(os, 10, os->size);
}

Ice_Int Ice_beginEncapsulation(Ice_OutputStreamPtr os) {
    Ice_Int begin = os->size;
    Ice_OutputStream_writeInt(os, 6);
    Ice_OutputStream_writeShort(os, (Ice_Short)(1 | os->minor << 8));
    return begin;
}

void Ice_endEncapsulation(Ice_OutputStreamPtr os, Ice_Int begin) {
    Ice_patchInt(os, begin, os->size - begin);
}

Ice_Status Ice_enterEncapsulation(Ice_InputStreamPtr is) {
    U32 size = (U32)Ice_InputStream_readInt(is) - 6U;
    U32 version = (U16)Ice_InputStream_readShort(is); /* major, minor */
    if (size > (U32)(is->size - is->position))
        return ICE_MARSHAL;
    is->size = is->position + (Ice_Int)size;
    is->minor = (Ice_Byte)(version >> 8);
    return (version & 0xFEFFU) == 1U ? ICE_OK : ICE_PROTOCOL;
}

void Ice_writeFacet(Ice_OutputStreamPtr os, const Ice_String* facet) {
    Ice_OutputStream_writeByte(os, facet->size != 0);
    if (facet->size)
        Ice_OutputStream_writeString(os, *facet);
}

/* More than one is malformed, as it is to Ice. */
void Ice_readFacet(Ice_InputStreamPtr is, Ice_String* facet) {
    Ice_Byte n = Ice_InputStream_readByte(is);
    facet->size = 0;
    if (n > 1)
        is->failed = 1;
    else if (n == 1)
        Ice_InputStream_takeString(is, facet);
}

void Ice_skipStrings(Ice_InputStreamPtr is, U32 count) {
    Ice_String skipped;
    for (; count && !is->failed; --count)
        Ice_InputStream_takeString(is, &skipped);
}
