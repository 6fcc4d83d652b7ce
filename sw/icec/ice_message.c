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

void Ice_beginMessage(Ice_OutputStreamPtr os, Ice_Byte type) {
    Ice_OutputStream_writeInt(os, ICE_MAGIC);
    Ice_OutputStream_writeInt(os, ICE_VERSIONS);
    Ice_OutputStream_writeShort(os, type); /* and no compression */
    Ice_OutputStream_writeInt(os, ICE_HEADER);
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
    Ice_Int size = Ice_InputStream_readInt(is);
    U32 version = (U16)Ice_InputStream_readShort(is); /* major, minor */
    if (is->failed || size < 6 || size - 6 > is->size - is->position)
        return ICE_MARSHAL;
    is->size = is->position + size - 6;
    is->minor = (Ice_Byte)(version >> 8);
    return (version & 0xFEFFU) == 1U ? ICE_OK : ICE_PROTOCOL;
}

void Ice_writeFacet(Ice_OutputStreamPtr os, Ice_String facet) {
    Ice_OutputStream_writeSize(os, facet.size != 0);
    if (facet.size)
        Ice_OutputStream_writeString(os, facet);
}

/* More than one is malformed, as it is to Ice. */
Ice_String Ice_readFacet(Ice_InputStreamPtr is) {
    Ice_String facet = {0, ""};
    Ice_Int n = Ice_InputStream_readSize(is);
    if (n > 1)
        is->failed = 1;
    else if (n == 1)
        facet = Ice_InputStream_readString(is);
    return facet;
}

void Ice_skipStrings(Ice_InputStreamPtr is, Ice_Int count) {
    while (count-- > 0)
        (void)Ice_InputStream_readString(is);
}
