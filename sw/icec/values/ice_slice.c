/* SPDX-License-Identifier: MIT
 *
 * ice_slice: reads and writes the slices of user exceptions, and optional values. With encoding
 * 1.0, a slice consists of its type id, a size of 4 bytes (which includes these bytes), and the
 * members; a byte before the first slice shows whether there are classes. With encoding 1.1, a
 * slice consists of flags, the type id, the size (only in the sliced format), the members, and
 * optional values up to an end mark.
 */
#include "ice_slice.h"

#define OPTIONAL_END 0xFF
#define TAG_ESCAPE 30

void icec_failRead(Ice_InputStreamPtr is, Ice_Failed why) {
    if (!is->failed)
        is->failed = (Ice_Byte)why;
}

Ice_Int Ice_OutputStream_startSize(Ice_OutputStreamPtr os) {
    Ice_OutputStream_writeInt(os, 0);
    return os->size - 4;
}

void Ice_OutputStream_endSize(Ice_OutputStreamPtr os, Ice_Int begin) {
    icec_patchInt(os, begin, os->size - begin - 4);
}

void Ice_OutputStream_startException(Ice_OutputStreamPtr os, Ice_Bool usesClasses) {
    if (os->minor == 0)
        Ice_OutputStream_writeBool(os, usesClasses);
}

Ice_Int Ice_OutputStream_startSlice(Ice_OutputStreamPtr os, const char* typeId, Ice_Bool last) {
    Ice_Int begin = os->size;
    os->sliceFlags = (Ice_Byte)(ICE_SLICE_INSIDE | (os->sliced ? ICE_SLICE_SIZE : 0) |
                                (last ? ICE_SLICE_LAST : 0));
    if (os->minor != 0)
        Ice_OutputStream_writeByte(os, 0);
    Ice_OutputStream_writeString(os, Ice_String_from(typeId));
    if (os->minor == 0 || os->sliced)
        Ice_OutputStream_writeInt(os, 0);
    return begin;
}

void icec_patchSize(Ice_OutputStreamPtr os, Ice_Int begin) {
    icec_patchInt(os, begin, os->size - begin);
}

void icec_finishSlice(Ice_OutputStreamPtr os, Ice_Int flags, Ice_Int size) {
    if (os->sliceFlags & ICE_SLICE_OPTIONALS)
        Ice_OutputStream_writeByte(os, OPTIONAL_END);
    if (size >= 0)
        icec_patchSize(os, size);
    if (os->values && os->values->writeTable(os))
        os->sliceFlags |= ICE_SLICE_TABLE;
    if (!os->failed)
        os->data[flags] = (Ice_Byte)(os->sliceFlags & ~ICE_SLICE_INSIDE);
    os->sliceFlags = 0;
}

void Ice_OutputStream_endSlice(Ice_OutputStreamPtr os, Ice_Int begin, Ice_Bool last) {
    Ice_InputStream is;
    (void)last;
    if (os->failed)
        return;
    Ice_InputStream_init(&is, os->data, os->size);
    is.position = begin + (os->minor != 0);
    (void)Ice_InputStream_readString(&is);
    if (os->minor != 0) {
        icec_finishSlice(os, begin, os->sliced ? is.position : -1);
    } else {
        icec_patchSize(os, is.position);
        os->sliceFlags = 0;
    }
}

Ice_Bool Ice_OutputStream_writeOptional(Ice_OutputStreamPtr os, Ice_Int tag, Ice_Int format) {
    if (os->minor == 0)
        return 0;
    os->sliceFlags |= ICE_SLICE_OPTIONALS;
    if (tag < TAG_ESCAPE) {
        Ice_OutputStream_writeByte(os, (Ice_Byte)(format | tag << 3));
    } else {
        Ice_OutputStream_writeByte(os, (Ice_Byte)(format | TAG_ESCAPE << 3));
        Ice_OutputStream_writeSize(os, tag);
    }
    return 1;
}

void Ice_InputStream_startException(Ice_InputStreamPtr is) {
    if (is->minor == 0) {
        Ice_Bool usesClasses = Ice_InputStream_readBool(is);
        if (is->values)
            is->values->pending = usesClasses;
    }
    is->sliceFlags = 0;
}

Ice_Int icec_readSliceEnd(Ice_InputStreamPtr is, Ice_Byte flags) {
    Ice_Int begin = is->position, size;
    if (!(flags & ICE_SLICE_SIZE))
        return 0;
    size = Ice_InputStream_readInt(is);
    if (size >= 4 && size <= is->size - begin)
        return begin + size;
    icec_failRead(is, ICE_FAILED_MALFORMED);
    return 0;
}

Ice_String Ice_InputStream_startSlice(Ice_InputStreamPtr is) {
    static const Ice_String none = {0, ""};
    Ice_String id;
    if (is->sliceFlags & ICE_SLICE_LAST || is->failed || is->position == is->size) {
        icec_failRead(is, ICE_FAILED_MALFORMED); /* the slice of a required base is missing */
        return none;
    }
    is->sliceFlags = is->minor != 0 ? Ice_InputStream_readByte(is) : ICE_SLICE_SIZE;
    is->sliceFlags |= ICE_SLICE_INSIDE;
    id = Ice_InputStream_readString(is);
    is->sliceEnd = icec_readSliceEnd(is, is->sliceFlags);
    return is->failed ? none : id;
}

/* Skips the table of instances that follows a slice. `depth` is limited, so that a peer cannot
 * overflow the stack by nested tables. */
static void skipTable(Ice_InputStreamPtr is, int depth) {
    Ice_Int count = Ice_InputStream_readSequence(is, 1);
    while (count-- > 0 && !is->failed) {
        Ice_Byte flags = ICE_SLICE_LAST;
        Ice_Int end;
        if (Ice_InputStream_readSize(is) != 1)
            continue; /* a reference to an earlier instance has no slices */
        do {
            flags = Ice_InputStream_readByte(is);
            if ((flags & ICE_SLICE_COMPACT_ID) == ICE_SLICE_TYPE_STRING)
                (void)Ice_InputStream_readString(is);
            else
                (void)Ice_InputStream_readSize(is);
            if (!(flags & ICE_SLICE_SIZE) || (flags & ICE_SLICE_TABLE && depth == 0))
                icec_failRead(is, ICE_FAILED_MALFORMED);
            end = icec_readSliceEnd(is, flags);
            if (!is->failed)
                is->position = end;
            if (flags & ICE_SLICE_TABLE && !is->failed)
                skipTable(is, depth - 1);
        } while (!(flags & ICE_SLICE_LAST) && !is->failed);
    }
}

/* Reads the table of instances that follows a slice, if the slice has one. If the program has no
 * function that reads classes, skips the table. */
static void readTable(Ice_InputStreamPtr is) {
    Ice_Byte flags = is->sliceFlags;
    if (is->sliceFlags & ICE_SLICE_TABLE) {
        if (is->values)
            is->values->readTable(is);
        else
            skipTable(is, 8);
    }
    is->sliceFlags = flags;
}

Ice_Bool Ice_InputStream_skipSlice(Ice_InputStreamPtr is) {
    if (is->failed || is->sliceEnd == 0)
        return 0;
    is->position = is->sliceEnd;
    readTable(is);
    return !is->failed && !(is->sliceFlags & ICE_SLICE_LAST) && is->position < is->size;
}

void Ice_InputStream_endSlice(Ice_InputStreamPtr is) {
    if (is->sliceFlags & ICE_SLICE_OPTIONALS) {
        Ice_InputStream_skipOptionals(is);
        if (Ice_InputStream_readByte(is) != OPTIONAL_END)
            icec_failRead(is, ICE_FAILED_MALFORMED);
    }
    if (is->sliceEnd && is->position != is->sliceEnd)
        icec_failRead(is, ICE_FAILED_MALFORMED);
    readTable(is);
}

/* Skips one optional value of this format. */
static void skip(Ice_InputStreamPtr is, Ice_Int format) {
    switch (format) {
    case ICE_OPTIONAL_SIZE:
        (void)Ice_InputStream_readSize(is);
        break;
    case ICE_OPTIONAL_VSIZE:
        (void)Ice_InputStream_readBlob(is, Ice_InputStream_readSize(is));
        break;
    case ICE_OPTIONAL_FSIZE:
        (void)Ice_InputStream_readBlob(is, Ice_InputStream_readInt(is));
        break;
    case ICE_OPTIONAL_CLASS:
        if (is->values)
            is->values->skip(is);
        else if (Ice_InputStream_readSize(is) == 1)
            icec_failRead(is, ICE_FAILED_MALFORMED); /* a class instance is not allowed here */
        break;
    default:
        (void)Ice_InputStream_readBlob(is, (Ice_Int)1 << format);
    }
}

/* Skips optional values with tags below `tag`. Returns 1 if the next optional value has this tag;
 * its bytes follow. */
static Ice_Bool seek(Ice_InputStreamPtr is, Ice_Int tag, Ice_Int format) {
    Ice_Int end = is->sliceFlags && is->sliceEnd ? is->sliceEnd : is->size;
    while (!is->failed && is->position < end) {
        Ice_Int begin = is->position, found;
        Ice_Byte head = Ice_InputStream_readByte(is);
        found = head >> 3;
        if (head != OPTIONAL_END && found == TAG_ESCAPE)
            found = Ice_InputStream_readSize(is);
        if (head == OPTIONAL_END || found > tag) {
            is->position = begin;
            break;
        }
        if (found == tag) {
            if ((head & 7) != format)
                icec_failRead(is, ICE_FAILED_MALFORMED);
            return !is->failed;
        }
        skip(is, head & 7);
    }
    return 0;
}

Ice_Bool Ice_InputStream_readOptional(Ice_InputStreamPtr is, Ice_Int tag, Ice_Int format) {
    if (is->minor == 0 || (is->sliceFlags && !(is->sliceFlags & ICE_SLICE_OPTIONALS)))
        return 0;
    return seek(is, tag, format);
}

void Ice_InputStream_skipOptionals(Ice_InputStreamPtr is) {
    if (is->minor != 0)
        (void)seek(is, 0x7FFFFFFF, -1);
}

#ifndef ICEC_MINIMAL

Ice_Bool Ice_InputStream_end(Ice_InputStreamPtr is) {
    /* Before version 3.3, Ice could send one byte too many after class instances in encoding
     * 1.0. */
    Ice_Int most = is->minor == 0 ? 1 : 0;
    is->sliceFlags = 0;
    Ice_InputStream_skipOptionals(is);
    if (is->minor != 0 && is->position < is->size && is->data[is->position] == OPTIONAL_END)
        ++is->position;
    if (is->size - is->position > most)
        icec_failRead(is, ICE_FAILED_MALFORMED);
    return is->failed;
}

Ice_Bool Ice_InputStream_endEmpty(Ice_InputStreamPtr is) {
    if (is->minor == 0 && is->position != is->size)
        icec_failRead(is, ICE_FAILED_MALFORMED);
    return is->failed;
}

#endif
