/* SPDX-License-Identifier: MIT
 *
 * ice_proxy_parse: makes a proxy from its string form, which the manual of Ice defines ("Proxy and
 * Endpoint Syntax").
 */
#include "ice_private.h"

#include <stdlib.h>
#include <string.h>

U32 Ice_numberOption(const char* options, char letter, U32 otherwise) {
    Ice_Int size;
    const char* at = Ice_findOption(options, letter, &size);
    char* end;
    U32 value;
    if (!at)
        return otherwise;
    value = (U32)strtoul(at, &end, at[0] == '0' && at[1] == 'x' ? 16 : 10);
    return end == at + size && *at != '-' ? value : 0xFFFFFFFFU;
}

/* Sets `found` to the next word, without its quotes. A word ends before any of the characters in
 * `ends`. Escape sequences remain in the word. Returns the text after the word; 0 if a quote is not
 * closed. */
static const char* word(const char* text, const char* ends, Ice_String* found) {
    const char quote = *text;
    int isQuoted = quote == '"' || quote == '\'';
    text += isQuoted;
    found->data = text;
    if (isQuoted) {
        while (*text && (*text != quote || text[-1] == '\\'))
            ++text;
        if (!*text)
            return 0;
    } else {
        text += strcspn(text, ends);
    }
    found->size = (Ice_Int)(text - found->data);
    return text + isQuoted;
}

/* Returns whether an odd number of backslashes precedes the character at `at`. */
static int isEscaped(Ice_String text, Ice_Int at) {
    Ice_Int count = 0;
    while (count < at && text.data[at - count - 1] == '\\')
        ++count;
    return count % 2;
}

/* Parses "name" or "category/name"; a slash may be escaped. */
static Ice_Status parseIdentity(Ice_String text, Ice_String facet, Ice_ObjectPrxPtr prx) {
    Ice_Byte bytes[ICE_IDENTITY_MAX];
    Ice_OutputStream os;
    Ice_String parts[3], raw[3];
    Ice_Int i, slash = -1;
    for (i = 0; i < text.size; ++i)
        if (text.data[i] == '/' && !isEscaped(text, i)) {
            if (slash >= 0)
                return ICE_PARSE;
            slash = i;
        }
    raw[0].data = text.data + slash + 1;
    raw[0].size = text.size - slash - 1;
    raw[1].data = text.data;
    raw[1].size = slash < 0 ? 0 : slash;
    raw[2] = facet;
    Ice_OutputStream_init(&os, bytes, (Ice_Int)sizeof bytes);
    for (i = 0; i < 3; ++i) {
        parts[i].data = (const char*)bytes + os.size;
        parts[i].size = os.size;
        icec_unescape(raw[i], i < 2 ? '/' : 0, &os);
        parts[i].size = os.size - parts[i].size;
    }
    if (os.failed)
        return icec_parseFailure(&os);
    if (parts[0].size == 0)
        return ICE_PARSE;
    return icec_setIdentity(prx, &parts[0], &parts[1], &parts[2]);
}

/* Returns the six bits of a character of base 64; 63 for '='; -1 for other characters. */
static int base64(char c) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char* digit = c ? strchr(digits, c) : 0;
    return digit ? (int)(digit - digits) : c == '=' ? 63 : -1;
}

/* Decodes base 64 in groups of four characters. Characters missing at the end count as 'A', as in
 * Ice. */
static void decodeBase64(const char* text, Ice_Int size, Ice_OutputStreamPtr os) {
    for (; size > 0 && !os->failed; size -= 4, text += 4) {
        char c[4];
        U32 bits = 0;
        int i;
        for (i = 0; i < 4; ++i) {
            int six;
            c[i] = i < size ? text[i] : 'A';
            six = base64(c[i]);
            if (six < 0)
                os->failed = ICE_FAILED_MALFORMED;
            bits = bits << 6 | ((U32)six & 63U);
        }
        Ice_OutputStream_writeByte(os, (Ice_Byte)(bits >> 16));
        if (c[2] != '=')
            Ice_OutputStream_writeByte(os, (Ice_Byte)(bits >> 8));
        if (c[3] != '=')
            Ice_OutputStream_writeByte(os, (Ice_Byte)bits);
    }
}

/* Parses a version such as "1.1", from 1.0 to 255.255. Returns 0 for other text. */
static int parseVersion(Ice_String text, Ice_Byte* version) {
    int part;
    Ice_Int i = 0;
    for (part = 0; part < 2; ++part, ++i) {
        U32 number = 0;
        Ice_Int begin;
        i += i < text.size && text.data[i] == '+';
        begin = i;
        for (; i < text.size && text.data[i] >= '0' && text.data[i] <= '9' && number < 256; ++i)
            number = number * 10 + (U32)(text.data[i] - '0');
        if (i == begin || number > 255 || (part == 0 && (i == text.size || text.data[i] != '.')))
            return 0;
        version[part] = (Ice_Byte)number;
    }
    return i == text.size + 1 && version[0] != 0;
}

/* Returns how often an option with this letter occurs. */
static int countOptions(const char* options, char letter) {
    int count = 0;
    for (; *options && *options != ':'; ++options)
        count += options[0] == '-' && options[1] == letter && strchr(ICEC_SPACES, options[2]) != 0;
    return count;
}

/* Parses an endpoint of an unknown transport, which is passed on unchanged: "opaque -t type -e
 * encoding -v bytes in base 64". */
static Ice_Status parseOpaque(const char* options, Ice_ObjectPrxPtr prx) {
    Ice_Int type = -1;
    Ice_String value, version;
    Ice_Byte encoding[2] = {1, 0};
    Ice_OutputStream os;
    Ice_Int begin;
    value.data = Ice_findOption(options, 'v', &value.size);
    version.data = Ice_findOption(options, 'e', &version.size);
    if (!Ice_areOptions(options, "tev") || !value.data || countOptions(options, 't') != 1 ||
        countOptions(options, 'v') != 1 || !Ice_integerOption(options, 't', 0x7FFF, &type) ||
        (version.data && !parseVersion(version, encoding)))
        return ICE_PARSE;
    Ice_OutputStream_init(&os, prx->endpoints, ICE_ENDPOINT_MAX);
    os.size = prx->endpoints[0] ? prx->endpointsSize : 1;
    Ice_OutputStream_writeShort(&os, (Ice_Short)type);
    begin = os.size;
    Ice_OutputStream_writeInt(&os, 0);
    Ice_OutputStream_writeShort(&os, (Ice_Short)(encoding[0] | encoding[1] << 8));
    decodeBase64(value.data, value.size, &os);
    icec_endEncapsulation(&os, begin);
    if (os.failed)
        return icec_parseFailure(&os);
    prx->endpointsSize = (Ice_Byte)os.size;
    ++prx->endpoints[0];
    return ICE_OK;
}

const char* icec_nextEndpoint(const char* text) {
    const char* quote;
    for (; *text; ++text) {
        if (*text == ':')
            return text + 1 + strspn(text + 1, ICEC_SPACES);
        if (*text == '"' && (quote = strchr(text + 1, '"')) != 0)
            text = quote;
    }
    return 0;
}

/* Parses the endpoints that follow the colon at `text`. Endpoints of unknown transports are
 * omitted, provided that at least one other endpoint remains. */
static Ice_Status parseEndpoints(const char* text, Ice_ObjectPrxPtr prx) {
    Ice_Status status = ICE_OK;
    while (status == ICE_OK && (text = icec_nextEndpoint(text)) != 0) {
        int transport;
        const char* options = icec_optionsOf(prx->communicator, text, &transport);
        if (*text == 0 || *text == ':')
            status = ICE_PARSE;
        else if (options)
            status = icec_addEndpoint(prx, transport, options);
        else if (strncmp(text, "opaque", 6) == 0 && strchr(ICEC_SPACES ":", text[6]))
            status = parseOpaque(text + 6, prx);
        else if (!Ice_areOptions(text, 0))
            status = ICE_PARSE;
    }
    return status == ICE_OK && prx->endpoints[0] == 0 ? ICE_NO_ENDPOINT : status;
}

static Ice_Status parseAdapter(const char* text, Ice_ObjectPrxPtr prx) {
    Ice_OutputStream os;
    Ice_String id;
    text = word(text + strspn(text, ICEC_SPACES), ICEC_SPACES, &id);
    if (!text || text[strspn(text, ICEC_SPACES)] != 0)
        return ICE_PARSE;
    Ice_OutputStream_init(&os, prx->endpoints, ICE_ENDPOINT_MAX);
    /* the number of endpoints, 0, and the length of the adapter id, which is set below */
    os.size = 2;
    icec_unescape(id, 0, &os);
    if (os.failed)
        return icec_parseFailure(&os);
    prx->endpointsSize = (Ice_Byte)os.size;
    prx->endpoints[1] = (Ice_Byte)(os.size - 2);
    return os.size == 2 ? ICE_PARSE : ICE_OK;
}

/* Parses an option that precedes the endpoints. An option without a value has a `value` of
 * size 0. */
static Ice_Status parseOption(char letter, Ice_String value, Ice_String* facet,
                              Ice_ObjectPrxPtr prx) {
    /* letters for the modes, in the order of their numbers, starting with ICE_TWOWAY */
    static const char modes[] = "toOdD";
    const char* mode = letter ? strchr(modes, letter) : 0;
    int isRight = value.size != 0;
    if (mode) {
        prx->mode = (Ice_Byte)(mode - modes);
        isRight = !isRight;
    } else if (letter == 's') {
        prx->secure = 1;
        isRight = !isRight;
    } else if (letter == 'f') {
        *facet = value;
    } else if (letter == 'p') {
        isRight = parseVersion(value, prx->versions);
    } else {
        isRight = letter == 'e' && parseVersion(value, prx->versions + 2);
        prx->minor = prx->versions[3] != 0;
    }
    return isRight ? ICE_OK : ICE_PARSE;
}

static Ice_Status parse(const char* text, Ice_ObjectPrxPtr prx) {
    Ice_String identity, facet = {0, ""}, option, value;
    const char* begin;
    Ice_Status status;
    text += strspn(text, ICEC_SPACES);
    begin = text;
    text = word(text, ICEC_SPACES ":@", &identity);
    if (!text)
        return ICE_PARSE;
    /* an empty text and "/" are the null proxy */
    if (identity.size == 0 || (identity.size == 1 && *identity.data == '/'))
        return text != begin && text[strspn(text, ICEC_SPACES)] == 0 ? ICE_OK : ICE_PARSE;
    for (;;) {
        text += strspn(text, ICEC_SPACES);
        if (strchr(":@", *text)) /* strchr also finds the zero at the end of the text */
            break;
        text += strcspn(option.data = text, ICEC_SPACES ":@");
        option.size = (Ice_Int)(text - option.data);
        value.size = 0;
        text += strspn(text, ICEC_SPACES);
        if (!strchr(":@-", *text))
            text = word(text, ICEC_SPACES ":@", &value);
        if (!text || option.size != 2 || option.data[0] != '-' ||
            parseOption(option.data[1], value, &facet, prx) != ICE_OK)
            return ICE_PARSE;
    }
    status = parseIdentity(identity, facet, prx);
    if (status != ICE_OK || *text == 0)
        return status;
    return *text == ':' ? parseEndpoints(text, prx) : parseAdapter(text + 1, prx);
}

Ice_Status Ice_Communicator_stringToProxy(Ice_CommunicatorPtr ic, const char* proxy,
                                          Ice_ObjectPrxPtr prx) {
    Ice_Status status;
    icec_initProxy(prx, ic);
    if (proxy[0] == 0)
        return ICE_OK; /* the null proxy */
    status = parse(proxy, prx);
    if (status != ICE_OK)
        icec_initProxy(prx, ic);
    return status;
}
