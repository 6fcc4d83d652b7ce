// SPDX-License-Identifier: MIT
//
// fuzz_stream: libFuzzer on the stream decoder and the parsers of proxy strings.
//
// Two bytes of each step choose the next read. A proxy that is read or parsed must come back the
// same from its own string and its own encoding.

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

extern "C" {
#include "icec.h"
#include "loop_endpoint.h"
}

namespace {

Ice_Communicator ic;
LoopEndpoint loop;

// `minor`: of the encoding in which it was read, since a proxy takes the encoding over in which it
// is sent.
void checkProxy(const Ice_ObjectPrx& prx, Ice_Byte minor) {
    static char text[8192];
    Ice_ObjectPrx again;
    auto prints = [&](const char* what) { return strstr(text, what) != nullptr; };
    if (Ice_Communicator_proxyToString(&prx, text, sizeof text) != ICE_OK)
        abort();
    if (Ice_Communicator_stringToProxy(&ic, text, &again) != ICE_OK ||
        (!Ice_ObjectPrx_isNull(&prx) && !Ice_ObjectPrx_equals(&prx, &again))) {
        // An endpoint of this transport prints in its own words, strange bytes in it are not kept;
        // an empty opaque one has no string that Ice reads; octal escapes may be longer than the
        // limit.
        size_t n = strlen(text);
        if (!prints(":loop") && !prints("\\") && !prints("-v :") &&
            (n < 3 || strcmp(text + n - 3, "-v ") != 0)) {
            fprintf(stderr, "this proxy does not come back from its string: %s\n", text);
            abort();
        }
    }
    Ice_Byte bytes[512];
    Ice_OutputStream os;
    Ice_InputStream is;
    Ice_OutputStream_init(&os, bytes, sizeof bytes);
    os.minor = minor;
    Ice_OutputStream_writePrx(&os, &prx);
    if (os.failed)
        abort();
    Ice_InputStream_init(&is, bytes, os.size);
    is.minor = minor;
    Ice_InputStream_readPrx(&is, &ic, &again);
    if (is.failed || is.position != is.size || !Ice_ObjectPrx_equals(&prx, &again))
        abort();
}

void step(Ice_InputStreamPtr is, unsigned what, Ice_Int argument) {
    Ice_ObjectPrx prx;
    switch (what % 14) {
    case 0:
        (void)Ice_InputStream_readBool(is);
        break;
    case 1:
        (void)Ice_InputStream_readShort(is);
        break;
    case 2:
        (void)Ice_InputStream_readLong(is);
        break;
    case 3:
        (void)Ice_InputStream_readDouble(is);
        break;
    case 4:
        (void)Ice_InputStream_readFloat(is);
        break;
    case 5:
        (void)Ice_InputStream_readString(is);
        break;
    case 6:
        (void)Ice_InputStream_readEnum(is, argument * 1000);
        break;
    case 7:
        (void)Ice_InputStream_allocate(is, Ice_InputStream_readSequence(is, 1 + argument % 9),
                                       1 + argument);
        break;
    case 8:
        Ice_InputStream_readPrx(is, &ic, &prx);
        if (!is->failed && !Ice_ObjectPrx_isNull(&prx))
            checkProxy(prx, is->minor);
        break;
    case 9:
        (void)Ice_InputStream_readOptional(is, argument, argument & 7);
        break;
    case 10:
        Ice_InputStream_skipOptionals(is);
        break;
    case 11:
        Ice_InputStream_startException(is);
        break;
    case 12:
        (void)Ice_InputStream_startSlice(is);
        (void)Ice_InputStream_skipSlice(is);
        break;
    default:
        Ice_InputStream_endSlice(is);
        break;
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    static U32 arena[64];
    Ice_InputStream is;
    if (size < 1 || size > 4000)
        return 0;
    Ice_initialize(&ic);
    LoopEndpoint_init(&ic, &loop);
    Ice_ObjectPrx prx;
    std::string text(reinterpret_cast<const char*>(data), size);
    if (Ice_Communicator_stringToProxy(&ic, text.c_str(), &prx) == ICE_OK &&
        !Ice_ObjectPrx_isNull(&prx))
        checkProxy(prx, 1);
    size_t steps = 1 + data[0] % 16;
    if (size < 2 * steps + 1)
        return 0;
    Ice_InputStream_init(&is, data + 1 + 2 * steps, static_cast<Ice_Int>(size - 1 - 2 * steps));
    is.minor = data[0] >> 7;
    is.arena = arena;
    is.arenaSize = 64;
    is.communicator = &ic;
    for (size_t i = 0; i < steps; ++i)
        step(&is, data[1 + 2 * i], data[2 + 2 * i]);
    if (is.position > is.size || is.arenaUsed > is.arenaSize)
        abort();
    return 0;
}
