/* SPDX-License-Identifier: MIT
 *
 * ice_escape: reads escape sequences in the identities, facets and adapter ids of proxy strings, as
 * Ice does.
 */
#include "ice_private.h"

#include <string.h>

static const char letters[] = "abfnrtv", controls[] = "\a\b\f\n\r\t\v";

static Ice_Byte isControl(char c) {
    return (U8)c < 32 || c == 127;
}

/* Reads up to `most` digits of base 8 or 16 as `value`. Returns the number of digits. */
static int digits(Ice_String* text, int most, U32 base, U32* value) {
    int count = 0;
    for (*value = 0; count < most && text->size > 0; ++count, ++text->data, --text->size) {
        const char c = *text->data;
        U32 digit = c >= '0' && c <= '9' ? (U32)(c - '0') : 99U;
        if (base == 16 && ((c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F')))
            digit = ((U32)c & 0xFU) + 9U;
        if (digit >= base)
            break;
        *value = *value * base + digit;
    }
    return count;
}

static void writeUtf8(Ice_OutputStreamPtr os, U32 c) {
    const int more = c < 0x80 ? 0 : c < 0x800 ? 1 : c < 0x10000U ? 2 : 3;
    static const Ice_Byte first[] = {0, 0xC0, 0xE0, 0xF0};
    int i;
    Ice_OutputStream_writeByte(os, (Ice_Byte)(first[more] | c >> 6 * more));
    for (i = more - 1; i >= 0; --i)
        Ice_OutputStream_writeByte(os, (Ice_Byte)(0x80U | (c >> 6 * i & 0x3FU)));
}

/* Reads the escape sequence after a backslash. Returns 0 if it is malformed. */
static int unescapeOne(Ice_String* text, char special, Ice_OutputStreamPtr os) {
    const char c = *text->data;
    const char* known = c ? strchr(letters, c) : 0;
    U32 value;
    if (c >= '0' && c <= '7') {
        (void)digits(text, 3, 8, &value);
        Ice_OutputStream_writeByte(os, (Ice_Byte)value);
        return value <= 255;
    }
    ++text->data;
    --text->size;
    if (c == 'x') {
        const int count = digits(text, 2, 16, &value);
        Ice_OutputStream_writeByte(os, (Ice_Byte)value);
        return count > 0;
    }
    if (c == 'u' || c == 'U') {
        const int wanted = c == 'u' ? 4 : 8, count = digits(text, wanted, 16, &value);
        writeUtf8(os, value);
        return count == wanted && (value < 0xD800U || value > 0xDFFFU) && value <= 0x10FFFFU;
    }
    if (known) {
        Ice_OutputStream_writeByte(os, (Ice_Byte)controls[known - letters]);
        return 1;
    }
    if (!strchr("\\'\"?", c) && c != special)
        Ice_OutputStream_writeByte(os, '\\'); /* an unknown escape sequence is kept unchanged */
    Ice_OutputStream_writeByte(os, (Ice_Byte)c);
    return !isControl(c);
}

void icec_unescape(Ice_String text, char special, Ice_OutputStreamPtr os) {
    while (text.size > 0 && !os->failed) {
        const char c = *text.data++;
        int isRight = !isControl(c);
        --text.size;
        if (c == '\\' && text.size > 0)
            isRight = unescapeOne(&text, special, os);
        else
            Ice_OutputStream_writeByte(os, (Ice_Byte)c);
        if (!isRight && !os->failed)
            os->failed = ICE_FAILED_MALFORMED;
    }
}
