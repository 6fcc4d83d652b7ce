/* SPDX-License-Identifier: MIT
 *
 * ice_proxy_print: prints a proxy as stock Ice does.
 */
#include "ice_message.h"

#include <string.h>

void icec_put(Ice_OutputStreamPtr os, const char* text) {
    Ice_OutputStream_writeBlob(os, (const Ice_Byte*)text, (Ice_Int)strlen(text));
}

void icec_putNumber(Ice_OutputStreamPtr os, U32 value) {
    if (value > 9)
        icec_putNumber(os, value / 10);
    Ice_OutputStream_writeByte(os, (Ice_Byte)('0' + value % 10));
}

/* Escapes special characters; bytes of UTF-8 characters remain unchanged. `special` is an
 * additional character to escape, or 0. */
static void escape(Ice_OutputStreamPtr os, Ice_String text, char special) {
    static const char from[] = "\a\b\f\n\r\t\v\\'\"", to[] = "abfnrtv\\'\"";
    Ice_Int i;
    for (i = 0; i < text.size; ++i) {
        char c = text.data[i];
        const char* known = c ? strchr(from, c) : 0;
        if (known) {
            c = to[known - from];
        } else if ((U8)c < 32 || c == 127) {
            static const char digits[] = "0123456789abcdef";
            icec_put(os, "\\u00");
            Ice_OutputStream_writeByte(os, (Ice_Byte)digits[(U8)c >> 4]);
            Ice_OutputStream_writeByte(os, (Ice_Byte)digits[(U8)c & 15]);
            continue;
        }
        if (known || (special && c == special))
            Ice_OutputStream_writeByte(os, '\\');
        Ice_OutputStream_writeByte(os, (Ice_Byte)c);
    }
}

/* Puts the text from `begin` to the end of the stream in quotes if necessary. */
static void quote(Ice_OutputStreamPtr os, Ice_Int begin) {
    Ice_Int i;
    for (i = begin; i < os->size; ++i)
        if (strchr(" :@", os->data[i])) {
            icec_put(os, "\"\"");
            if (os->failed)
                return;
            memmove(os->data + begin + 1, os->data + begin, (size_t)(os->size - 2 - begin));
            os->data[begin] = '"';
            return;
        }
}

static void putVersion(Ice_OutputStreamPtr os, const char* option, const Ice_Byte* version) {
    icec_put(os, option);
    icec_putNumber(os, version[0]);
    icec_put(os, ".");
    icec_putNumber(os, version[1]);
}

static void putOpaque(Ice_OutputStreamPtr os, const Ice_Byte* encoded, Ice_Int size) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    Ice_Int i;
    icec_put(os, "opaque -t ");
    icec_putNumber(os, encoded[0] | (U32)encoded[1] << 8);
    putVersion(os, " -e ", encoded + 6);
    icec_put(os, " -v ");
    for (i = 8; i < size; i += 3) {
        U32 bits = (U32)encoded[i] << 16 | (i + 1 < size ? (U32)encoded[i + 1] << 8 : 0) |
                   (i + 2 < size ? (U32)encoded[i + 2] : 0);
        Ice_OutputStream_writeByte(os, (Ice_Byte)digits[bits >> 18]);
        Ice_OutputStream_writeByte(os, (Ice_Byte)digits[bits >> 12 & 63]);
        Ice_OutputStream_writeByte(os, (Ice_Byte)(i + 1 < size ? digits[bits >> 6 & 63] : '='));
        Ice_OutputStream_writeByte(os, (Ice_Byte)(i + 2 < size ? digits[bits & 63] : '='));
    }
}

static void putEndpoints(const Ice_ObjectPrx* prx, Ice_OutputStreamPtr os) {
    Ice_CommunicatorPtr ic = prx->communicator;
    Ice_InputStream is;
    int n;
    Ice_InputStream_init(&is, prx->endpoints + 1, prx->endpointsSize - 1);
    for (n = prx->endpoints[0]; n > 0; --n) {
        const Ice_Byte* at = is.data + is.position;
        Ice_Int size;
        (void)Ice_InputStream_readShort(&is);
        (void)Ice_InputStream_readBlob(&is, Ice_InputStream_readInt(&is) - 4);
        size = (Ice_Int)(is.data + is.position - at);
        icec_put(os, ":");
        if (!icec_printEndpoint(ic, at, size, os))
            putOpaque(os, at, size);
    }
}

Ice_Status Ice_Communicator_proxyToString(const Ice_ObjectPrx* prx, char* text, Ice_Int size) {
    static const char* const modes[] = {" -t", " -o", " -O", " -d", " -D"};
    Ice_Identity id = Ice_ObjectPrx_getIdentity(prx);
    Ice_String facet = Ice_ObjectPrx_getFacet(prx);
    Ice_OutputStream os;
    Ice_Int begin;
    Ice_OutputStream_init(&os, (Ice_Byte*)text, size);
    if (!Ice_ObjectPrx_isNull(prx)) {
        if (id.category.size) {
            escape(&os, id.category, '/');
            icec_put(&os, "/");
        }
        escape(&os, id.name, '/');
        quote(&os, 0);
        if (facet.size) {
            icec_put(&os, " -f ");
            begin = os.size;
            escape(&os, facet, 0);
            quote(&os, begin);
        }
        icec_put(&os, modes[prx->mode]);
        icec_put(&os, prx->secure ? " -s" : "");
        if (prx->versions[0] != 1 || prx->versions[1] != 0)
            putVersion(&os, " -p ", prx->versions);
        putVersion(&os, " -e ", prx->versions + 2);
        if (prx->endpoints[0]) {
            putEndpoints(prx, &os);
        } else if (prx->endpointsSize > 2) {
            Ice_String adapter;
            adapter.data = (const char*)prx->endpoints + 2;
            adapter.size = prx->endpointsSize - 2;
            icec_put(&os, " @ ");
            begin = os.size;
            escape(&os, adapter, 0);
            quote(&os, begin);
        }
    }
    Ice_OutputStream_writeByte(&os, 0);
    if (os.failed && size > 0)
        text[0] = 0;
    return os.failed ? ICE_LIMIT : ICE_OK;
}
