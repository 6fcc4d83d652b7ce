/* SPDX-License-Identifier: MIT
 *
 * ice_proxy_parse: makes a proxy from its string, by the manual's "Proxy and Endpoint Syntax".
 */
#include "ice_private.h"

#include <stdlib.h>
#include <string.h>

#define SPACES " \t\n\r"

U32 Ice_numberOption(const char* options, char letter, U32 otherwise) {
    Ice_Int size;
    const char* at = Ice_findOption(options, letter, &size);
    if (!at)
        return otherwise;
    return (U32)strtoul(at, 0, at[0] == '0' && at[1] == 'x' ? 16 : 10);
}

/* Takes the next word, without its quotes; it ends at a space, a colon or an at sign. Escapes
 * stay. */
static const char* word(const char* text, Ice_String* found) {
    char quote = 0;
    text += strspn(text, SPACES);
    if (*text == '"' || *text == '\'')
        quote = *text++;
    found->data = text;
    while (*text && (quote ? *text != quote : strchr(SPACES ":@", *text) == 0))
        text += text[0] == '\\' && text[1] ? 2 : 1;
    found->size = (Ice_Int)(text - found->data);
    if (quote && *text++ != quote)
        return 0; /* no closing quote */
    return text;
}

/* Resolves escapes. */
static void unescape(Ice_String text, Ice_OutputStreamPtr os) {
    static const char from[] = "abfnrtv", to[] = "\a\b\f\n\r\t\v";
    Ice_Int i = 0;
    while (i < text.size) {
        char c = text.data[i++];
        if (c == '\\' && i < text.size) {
            const char* known;
            c = text.data[i++];
            known = strchr(from, c);
            if (c >= '0' && c <= '7') {
                int digits = 2, value = c - '0';
                for (; digits > 0 && i < text.size && text.data[i] >= '0' && text.data[i] <= '7';
                     --digits)
                    value = value * 8 + (text.data[i++] - '0');
                c = (char)value;
            } else if (known) {
                c = to[known - from];
            }
        }
        Ice_OutputStream_writeByte(os, (Ice_Byte)c);
    }
}

/* Parses "name" or "category/name", where a slash may be escaped. */
static Ice_Status parseIdentity(Ice_String text, Ice_String facet, Ice_ObjectPrxPtr prx) {
    Ice_Byte bytes[ICE_IDENTITY_MAX];
    Ice_OutputStream os;
    Ice_String parts[3], raw[3];
    Ice_Int i, slash = -1;
    for (i = 0; i < text.size; ++i) {
        if (text.data[i] == '\\')
            ++i;
        else if (text.data[i] == '/' && slash >= 0)
            return ICE_PARSE;
        else if (text.data[i] == '/')
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
        unescape(raw[i], &os);
        parts[i].size = os.size - parts[i].size;
    }
    if (os.failed)
        return ICE_LIMIT;
    if (parts[0].size == 0)
        return ICE_PARSE;
    return icec_setIdentity(prx, &parts[0], &parts[1], &parts[2]);
}

/* Decodes base 64: each of 64 characters stands for six bits. */
static void decodeBase64(const char* text, Ice_Int size, Ice_OutputStreamPtr os) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    U32 bits = 0, have = 0;
    for (; size > 0 && *text != '='; --size, ++text) {
        const char* digit = *text ? strchr(digits, *text) : 0;
        if (!digit) {
            os->failed = ICE_FAILED_MALFORMED;
            return;
        }
        bits = bits << 6 | (U32)(digit - digits);
        have += 6;
        if (have >= 8) {
            have -= 8;
            Ice_OutputStream_writeByte(os, (Ice_Byte)(bits >> have));
        }
    }
}

/* Parses an endpoint that is passed on unchanged: "opaque -t type -e encoding -v bytes in base
 * 64". */
static Ice_Status parseOpaque(const char* options, Ice_ObjectPrxPtr prx) {
    Ice_Int size, versionSize, begin;
    const char* value = Ice_findOption(options, 'v', &size);
    const char* version = Ice_findOption(options, 'e', &versionSize);
    U32 type = Ice_numberOption(options, 't', 0x10000U), major = 1, minor = 1;
    Ice_OutputStream os;
    if (version) {
        major = Ice_numberOption(options, 'e', 0);
        while (versionSize > 0 && *version != '.')
            ++version, --versionSize;
        for (minor = 0; --versionSize > 0;)
            minor = minor * 10 + ((U32)(U8) * ++version - (U32)'0');
    }
    if (!value || type > 0xFFFFU || major > 255 || minor > 255)
        return ICE_PARSE;
    Ice_OutputStream_init(&os, prx->endpoints, ICE_ENDPOINT_MAX);
    os.size = prx->endpoints[0] ? prx->endpointsSize : 1;
    Ice_OutputStream_writeShort(&os, (Ice_Short)type);
    begin = os.size;
    Ice_OutputStream_writeInt(&os, 0);
    Ice_OutputStream_writeShort(&os, (Ice_Short)(major | minor << 8));
    decodeBase64(value, size, &os);
    icec_endEncapsulation(&os, begin);
    if (os.failed)
        return ICE_LIMIT;
    prx->endpointsSize = (Ice_Byte)os.size;
    ++prx->endpoints[0];
    return ICE_OK;
}

/* Tells whether the text is a sequence of "-x value"; -z of tcp has no value. */
static int areOptions(const char* text) {
    Ice_String option, value;
    for (;;) {
        text += strspn(text, SPACES);
        if (*text == 0 || *text == ':')
            return 1;
        text = word(text, &option);
        if (!text || option.size != 2 || option.data[0] != '-')
            return 0;
        if (option.data[1] == 'z')
            continue;
        text = word(text, &value);
        if (!text || text == value.data)
            return 0;
    }
}

const char* icec_nextEndpoint(const char* text) {
    char quote = 0;
    for (; *text; ++text)
        if (*text == quote)
            quote = 0;
        else if (!quote && *text == ':')
            return text + 1 + strspn(text + 1, " ");
        else if (!quote && (*text == '"' || *text == '\''))
            quote = *text;
    return 0;
}

/* Parses the endpoints behind the colon at `text`. */
static Ice_Status parseEndpoints(const char* text, Ice_ObjectPrxPtr prx) {
    Ice_Status status = ICE_OK;
    while (status == ICE_OK) {
        int transport;
        const char* options;
        text = icec_nextEndpoint(text);
        if (!text)
            break;
        options = icec_optionsOf(prx->communicator, text, &transport);
        if (!areOptions(text + strcspn(text, SPACES ":")))
            status = ICE_PARSE;
        else if (options)
            status = icec_addEndpoint(prx, transport, options);
        else if (strncmp(text, "opaque ", 7) == 0)
            status = parseOpaque(text + 7, prx);
        else
            status = ICE_NO_ENDPOINT;
    }
    return status;
}

static Ice_Status parseAdapter(const char* text, Ice_ObjectPrxPtr prx) {
    Ice_OutputStream os;
    Ice_String id;
    text = word(text, &id);
    if (!text || id.size == 0 || *text != 0)
        return ICE_PARSE;
    Ice_OutputStream_init(&os, prx->endpoints, ICE_ENDPOINT_MAX);
    os.size = 2; /* no endpoints, the id's size */
    unescape(id, &os);
    prx->endpointsSize = (Ice_Byte)os.size;
    prx->endpoints[1] = (Ice_Byte)(os.size - 2);
    return os.failed ? ICE_LIMIT : ICE_OK;
}

static Ice_Status parse(const char* text, Ice_ObjectPrxPtr prx) {
    static const char modes[] = "toOdD"; /* in the order of ICE_TWOWAY and its like */
    Ice_String identity, facet = {0, ""}, option, value;
    Ice_Status status;
    text = word(text, &identity);
    if (!text)
        return ICE_PARSE;
    for (;;) {
        const char* mode;
        text += strspn(text, SPACES);
        if (*text != '-')
            break;
        text = word(text, &option);
        if (option.size != 2)
            return ICE_PARSE;
        mode = strchr(modes, option.data[1]);
        if (mode) {
            prx->mode = (Ice_Byte)(mode - modes);
        } else if (option.data[1] == 's') {
            prx->secure = 1;
        } else {
            text = word(text, &value);
            if (!text || text == value.data)
                return ICE_PARSE; /* no closing quote, or no value */
            if (option.data[1] == 'f')
                facet = value;
            else if (option.data[1] == 'e' && value.size == 3 && memcmp(value.data, "1.", 2) == 0)
                prx->minor = value.data[2] != '0';
            else if (option.data[1] != 'p' || !Ice_String_equals(value, "1.0"))
                return ICE_PARSE;
        }
    }
    status = parseIdentity(identity, facet, prx);
    if (status != ICE_OK || *text == 0)
        return status;
    if (*text == ':')
        return parseEndpoints(text, prx);
    return *text == '@' ? parseAdapter(text + 1, prx) : ICE_PARSE;
}

Ice_Status Ice_Communicator_stringToProxy(Ice_CommunicatorPtr ic, const char* proxy,
                                          Ice_ObjectPrxPtr prx) {
    Ice_Status status;
    icec_initProxy(prx, ic);
    if (proxy[strspn(proxy, SPACES)] == 0)
        return ICE_OK; /* the null proxy */
    status = parse(proxy, prx);
    if (status != ICE_OK)
        icec_initProxy(prx, ic);
    return status;
}
