/* SPDX-License-Identifier: MIT
 *
 * ice_stream: marshals the basic types in Ice's encodings 1.0 and 1.1. The encodings are
 * little-endian on every machine.
 */
#include "ice_stream.h"

#include <string.h>

Ice_String Ice_String_from(const char* terminated) {
    Ice_String s;
    s.data = terminated;
    s.size = (Ice_Int)strlen(terminated);
    return s;
}

int Ice_String_same(const Ice_String* a, const Ice_String* b) {
    /* The address of an empty string may be 0. */
    return a->size == b->size && (a->size == 0 || memcmp(a->data, b->data, (size_t)a->size) == 0);
}

int Ice_String_equals(Ice_String a, const char* terminated) {
    return Ice_String_is(&a, terminated);
}

int Ice_String_is(const Ice_String* a, const char* terminated) {
    Ice_Int i;
    for (i = 0; i < a->size; ++i)
        if (!terminated[i] || a->data[i] != terminated[i])
            return 0;
    return !terminated[i];
}

int Ice_String_copy(Ice_String s, char* to, Ice_Int size) {
    Ice_Int n = s.size;
    if (size <= 0)
        return 0;
    if (n >= size)
        for (n = size - 1; n > 0 && ((U8)s.data[n] & 0xC0U) == 0x80U; --n) {
        }
    if (n > 0)
        memcpy(to, s.data, (size_t)n);
    to[n] = '\0';
    return n == s.size;
}

void Ice_OutputStream_init(Ice_OutputStreamPtr os, Ice_Byte* data, Ice_Int capacity) {
    memset(os, 0, sizeof *os);
    os->data = data;
    os->capacity = capacity;
    os->minor = 1;
}

void Ice_OutputStream_writeBlob(Ice_OutputStreamPtr os, const Ice_Byte* data, Ice_Int size) {
    if (os->failed)
        return;
    if (size > os->capacity - os->size) {
        os->failed = ICE_FAILED_RESULT;
        return;
    }
    if (size)
        memcpy(os->data + os->size, data, (size_t)size);
    os->size += size;
}

void Ice_OutputStream_writeByte(Ice_OutputStreamPtr os, Ice_Byte v) {
    Ice_OutputStream_writeBlob(os, &v, 1);
}

void Ice_OutputStream_writeBool(Ice_OutputStreamPtr os, Ice_Bool v) {
    Ice_OutputStream_writeByte(os, v != 0);
}

static void writeWord(Ice_OutputStreamPtr os, U32 v, Ice_Int bytes) {
    Ice_Byte b[4];
    b[0] = (Ice_Byte)v;
    b[1] = (Ice_Byte)(v >> 8);
    b[2] = (Ice_Byte)(v >> 16);
    b[3] = (Ice_Byte)(v >> 24);
    Ice_OutputStream_writeBlob(os, b, bytes);
}

void Ice_OutputStream_writeShort(Ice_OutputStreamPtr os, Ice_Short v) {
    writeWord(os, (U32)(U16)v, 2);
}

void Ice_OutputStream_writeInt(Ice_OutputStreamPtr os, Ice_Int v) {
    writeWord(os, (U32)v, 4);
}

void Ice_OutputStream_writeLong(Ice_OutputStreamPtr os, Ice_Long v) {
    writeWord(os, v.low, 4);
    writeWord(os, (U32)v.high, 4);
}

void Ice_OutputStream_writeFloat(Ice_OutputStreamPtr os, Ice_Float v) {
    U32 bits;
    memcpy(&bits, &v, sizeof bits);
    writeWord(os, bits, 4);
}

/* Doubles have the IEEE 754 format with the byte order of integers, on the Cortex-M3 and on
 * hosts. */
void Ice_OutputStream_writeDouble(Ice_OutputStreamPtr os, Ice_Double v) {
    U32 bits[2];
    memcpy(bits, &v, sizeof bits);
    writeWord(os, bits[0], 4);
    writeWord(os, bits[1], 4);
}

void Ice_OutputStream_writeSize(Ice_OutputStreamPtr os, Ice_Int v) {
    if (v < 255) {
        Ice_OutputStream_writeByte(os, (Ice_Byte)v);
    } else {
        Ice_OutputStream_writeByte(os, 255);
        Ice_OutputStream_writeInt(os, v);
    }
}

static void writeSized(Ice_OutputStreamPtr os, const char* data, Ice_Int size) {
    Ice_OutputStream_writeSize(os, size);
    Ice_OutputStream_writeBlob(os, (const Ice_Byte*)data, size);
}

void Ice_OutputStream_writeString(Ice_OutputStreamPtr os, Ice_String v) {
    writeSized(os, v.data, v.size);
}

void Ice_OutputStream_writeText(Ice_OutputStreamPtr os, const char* terminated) {
    writeSized(os, terminated, (Ice_Int)strlen(terminated));
}

void(Ice_OutputStream_writeEnum)(Ice_OutputStreamPtr os, Ice_Int v, Ice_Int largest) {
    if (os->minor != 0)
        Ice_OutputStream_writeSize(os, v);
    else
        writeWord(os, (U32)v, largest < 127 ? 1 : largest < 32767 ? 2 : 4);
}

void icec_patchInt(Ice_OutputStreamPtr os, Ice_Int at, Ice_Int value) {
    Ice_Int end = os->size;
    if (os->failed)
        return;
    os->size = at;
    Ice_OutputStream_writeInt(os, value);
    os->size = end;
}

void Ice_InputStream_init(Ice_InputStreamPtr is, const Ice_Byte* data, Ice_Int size) {
    memset(is, 0, sizeof *is);
    is->data = data;
    is->size = size;
    is->minor = 1;
}

const Ice_Byte* Ice_InputStream_readBlob(Ice_InputStreamPtr is, Ice_Int size) {
    const Ice_Byte* at = is->data + is->position;
    if (is->failed)
        return 0;
    if ((U32)size > (U32)(is->size - is->position)) { /* the cast also catches negative sizes */
        is->failed = ICE_FAILED_MALFORMED;
        return 0;
    }
    is->position += size;
    return at;
}

static U32 readWord(Ice_InputStreamPtr is, Ice_Int bytes) {
    const Ice_Byte* b = Ice_InputStream_readBlob(is, bytes);
    if (!b)
        return 0;
    /* compilers make one load of these four bytes */
    if (bytes == 4)
        return (U32)b[0] | (U32)b[1] << 8 | (U32)b[2] << 16 | (U32)b[3] << 24;
    return bytes == 1 ? b[0] : (U32)b[0] | (U32)b[1] << 8;
}

Ice_Byte Ice_InputStream_readByte(Ice_InputStreamPtr is) {
    return (Ice_Byte)readWord(is, 1);
}

Ice_Bool Ice_InputStream_readBool(Ice_InputStreamPtr is) {
    return readWord(is, 1) != 0;
}

Ice_Short Ice_InputStream_readShort(Ice_InputStreamPtr is) {
    return (Ice_Short)readWord(is, 2);
}

Ice_Int Ice_InputStream_readInt(Ice_InputStreamPtr is) {
    return (Ice_Int)readWord(is, 4);
}

Ice_Long Ice_InputStream_readLong(Ice_InputStreamPtr is) {
    Ice_Long v;
    v.low = readWord(is, 4);
    v.high = (S32)readWord(is, 4);
    return v;
}

Ice_Float Ice_InputStream_readFloat(Ice_InputStreamPtr is) {
    U32 bits = readWord(is, 4);
    Ice_Float v;
    memcpy(&v, &bits, sizeof v);
    return v;
}

Ice_Double Ice_InputStream_readDouble(Ice_InputStreamPtr is) {
    U32 bits[2];
    Ice_Double v;
    bits[0] = readWord(is, 4);
    bits[1] = readWord(is, 4);
    memcpy(&v, bits, sizeof v);
    return v;
}

Ice_Int Ice_InputStream_readSize(Ice_InputStreamPtr is) {
    Ice_Int size = Ice_InputStream_readByte(is);
    if (size == 255)
        size = Ice_InputStream_readInt(is);
    if (size < 0)
        is->failed = ICE_FAILED_MALFORMED;
    return is->failed ? 0 : size;
}

void Ice_InputStream_takeString(Ice_InputStreamPtr is, Ice_String* s) {
    s->size = Ice_InputStream_readSize(is);
    s->data = (const char*)Ice_InputStream_readBlob(is, s->size);
    if (!s->data)
        s->size = 0;
}

Ice_String Ice_InputStream_readString(Ice_InputStreamPtr is) {
    Ice_String s;
    Ice_InputStream_takeString(is, &s);
    return s;
}

Ice_Int Ice_InputStream_readEnum(Ice_InputStreamPtr is, Ice_Int largest) {
    Ice_Int v = is->minor != 0 ? Ice_InputStream_readSize(is)
                               : (Ice_Int)readWord(is, largest < 127     ? 1
                                                       : largest < 32767 ? 2
                                                                         : 4);
    if (v < 0 || v > largest)
        is->failed = ICE_FAILED_MALFORMED;
    return is->failed ? 0 : v;
}

Ice_Int Ice_InputStream_readSequence(Ice_InputStreamPtr is, Ice_Int least) {
    Ice_Int count = Ice_InputStream_readSize(is);
    if (count > (is->size - is->position) / least)
        is->failed = ICE_FAILED_MALFORMED;
    return is->failed ? 0 : count;
}

void* Ice_InputStream_allocate(Ice_InputStreamPtr is, Ice_Int count, Ice_Int bytes) {
    Ice_Int words;
    void* at;
    if (count == 0)
        return 0;
    if (is->failed)
        return 0;
    if (count > is->arenaSize * 4 / bytes) {
        is->failed = ICE_FAILED_ARENA;
        return 0;
    }
    words = (count * bytes + 3) / 4;
    /* On hosts, doubles and pointers need an alignment of 8, wherever the arena begins. */
    if ((size_t)(is->arena + is->arenaUsed) & 7U)
        ++is->arenaUsed;
    if (words > is->arenaSize - is->arenaUsed) {
        is->failed = ICE_FAILED_ARENA;
        return 0;
    }
    at = is->arena + is->arenaUsed;
    is->arenaUsed += words;
    return at;
}
