// SPDX-License-Identifier: MIT
//
// fuzz_dispatch: fuzzes the messages from a peer (the bytes after a valid header) and the parser of
// proxy strings, with libFuzzer.
//
// The first byte of an input selects the type of the message, or a request with only the
// parameters fuzzed. The servant then decodes the parameters by a sequence of read functions;
// two bytes select each of these functions and its argument. A proxy that was read or parsed must
// be the same after conversion to a string and back, and to bytes and back. After each message the
// communicator must still answer a ping. Built with ICEC_MINIMAL, fuzz_dispatch tests the minimal
// run time, which has no proxy strings.

#include "ice_messages.h"
#include "loop.h"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string>

namespace {

Ice_Communicator ic;
std::optional<Loop> loop;
Ice_ObjectAdapter adapter;
int replies;

// Writes a proxy in encoding 1.minor, and reads it again.
void sendProxy(const Ice_ObjectPrx& prx, Ice_Byte minor, Ice_ObjectPrx& received) {
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
    Ice_InputStream_readPrx(&is, &ic, &received);
    if (is.failed || is.position != is.size)
        abort();
}

// Checks that a proxy is unchanged after conversion to a string and back, and to bytes and back.
// `minor` is the minor version of the encoding in which the proxy was read; a received proxy adopts
// the encoding of its message.
void checkProxy(const Ice_ObjectPrx& prx, Ice_Byte minor) {
    static char text[8192];
    Ice_ObjectPrx again;
    auto prints = [&](const char* what) { return strstr(text, what) != nullptr; };
    if (Ice_Communicator_proxyToString(&prx, text, sizeof text) != ICE_OK)
        abort();
    if (Ice_Communicator_stringToProxy(&ic, text, &again) != ICE_OK ||
        (!Ice_ObjectPrx_isNull(&prx) && !Ice_ObjectPrx_equals(&prx, &again))) {
        // These differences are allowed. An endpoint of this transport is printed in a canonical
        // form, without unknown bytes. As in stock Ice, some strings cannot be parsed, if an
        // opaque endpoint is empty or has a type above 32767, or a version is 0.x.
        // Octal escapes may make the string longer than the limit.
        size_t n = strlen(text);
        bool isHigh = false;
        for (const char* type = text; (type = strstr(type, " -t ")) != nullptr; type += 4)
            isHigh = isHigh || atoi(type + 4) > 32767;
        if (!prints(":loop") && !prints("\\") && !prints("-v :") && !prints(" -e 0.") &&
            !prints(" -p 0.") && !isHigh && (n < 3 || strcmp(text + n - 3, "-v ") != 0)) {
            fprintf(stderr, "this proxy does not come back from its string: %s\n", text);
            abort();
        }
    }
    // An endpoint of this transport adopts the encoding of the message in which it is first sent;
    // after that it does not change.
    Ice_ObjectPrx sent, sentAgain;
    sendProxy(prx, minor, sent);
    sendProxy(sent, minor, sentAgain);
    if ((!prints(":loop") && !Ice_ObjectPrx_equals(&prx, &sent)) ||
        !Ice_ObjectPrx_equals(&sent, &sentAgain))
        abort();
}

void readProxy(Ice_InputStreamPtr is, Ice_Int) {
    Ice_ObjectPrx prx;
    Ice_InputStream_readPrx(is, nullptr, &prx);
    if (ICEC_FULL && !is->failed && !Ice_ObjectPrx_isNull(&prx))
        checkProxy(prx, is->minor);
}

void (*const reads[])(Ice_InputStreamPtr is, Ice_Int argument) = {
    readProxy,
    [](Ice_InputStreamPtr is, Ice_Int) { (void)Ice_InputStream_readBool(is); },
    [](Ice_InputStreamPtr is, Ice_Int) { (void)Ice_InputStream_readShort(is); },
    [](Ice_InputStreamPtr is, Ice_Int) { (void)Ice_InputStream_readLong(is); },
    [](Ice_InputStreamPtr is, Ice_Int) { (void)Ice_InputStream_readDouble(is); },
    [](Ice_InputStreamPtr is, Ice_Int) { (void)Ice_InputStream_readFloat(is); },
    [](Ice_InputStreamPtr is, Ice_Int) { (void)Ice_InputStream_readString(is); },
    [](Ice_InputStreamPtr is, Ice_Int n) { (void)Ice_InputStream_readEnum(is, n * 1000); },
    [](Ice_InputStreamPtr is, Ice_Int n) {
        (void)Ice_InputStream_allocate(is, Ice_InputStream_readSequence(is, 1 + n % 9), 1 + n);
    },
    [](Ice_InputStreamPtr is, Ice_Int n) { (void)Ice_InputStream_readOptional(is, n, n & 7); },
    [](Ice_InputStreamPtr is, Ice_Int) { Ice_InputStream_skipOptionals(is); },
    [](Ice_InputStreamPtr is, Ice_Int) { Ice_InputStream_startException(is); },
    [](Ice_InputStreamPtr is, Ice_Int) {
        (void)Ice_InputStream_startSlice(is);
        (void)Ice_InputStream_skipSlice(is);
    },
    [](Ice_InputStreamPtr is, Ice_Int) { Ice_InputStream_endSlice(is); }};

Ice_Status serve(Ice_ObjectPtr, const Ice_Current* current, Ice_InputStreamPtr is,
                 Ice_OutputStreamPtr os) {
    Ice_String value;
    if (ICEC_FULL)
        (void)Ice_Current_context(current, "key", &value);
    for (int steps = 1 + Ice_InputStream_readByte(is) % 16; steps > 0; --steps) {
        unsigned what = Ice_InputStream_readByte(is);
        reads[what % (sizeof reads / sizeof *reads)](is, Ice_InputStream_readByte(is));
        if (is->position > is->size || is->arenaUsed > is->arenaSize)
            abort();
    }
    if (ICEC_FULL && current->mode == 3) {
        static Ice_Reply later;
        Ice_Current_later(current, &later);
        (void)Ice_Reply_begin(&later);
        (void)Ice_Reply_end(&later, ICE_LIMIT);
        return ICE_LATER;
    }
    Ice_OutputStream_writePrx(os, nullptr);
    return ICE_OK;
}

void take(void*, Ice_Status, Ice_InputStreamPtr is) {
    Ice_InputStream_startException(is);
    do {
        (void)Ice_InputStream_startSlice(is);
        (void)Ice_InputStream_readInt(is);
    } while (Ice_InputStream_skipSlice(is));
    Ice_InputStream_endSlice(is);
}

void inject(const Bytes& message) {
    loop->inject(ICE_EVENT_MESSAGE, 0, message);
}

// Delivers a message while a call of this side waits. If `answers` is true, the message has the id
// of this call.
void messageDuringCall(Ice_Byte type, bool answers, Bytes body) {
    static Ice_ObjectPrx prx;
    Ice_InputStreamPtr is;
    (void)Ice_Communicator_stringToProxy(&ic, "far:loop", &prx);
    prx.timeoutMs = 5;
    Ice_OutputStreamPtr os = Ice_ObjectPrx_begin(&prx, "op", ICE_RESULTS);
    if (!os)
        abort();
    if (answers)
        body.insert(body.begin(), os->data + 14, os->data + 18);
    inject(IceMessages::message(type, body));
    if (ICEC_FULL) {
        (void)Ice_ObjectPrx_invokeAsync(&prx, take, nullptr);
        (void)Ice_Communicator_poll(&ic, 0);
        return;
    }
    Ice_Status status = Ice_ObjectPrx_invoke(&prx, &is);
    if (status == ICE_OK || status == ICE_USER_EXCEPTION)
        take(nullptr, status, is);
    (void)Ice_ObjectPrx_end(&prx, status);
}

void start() {
    static const char* const ids[] = {"::Ice::Object", nullptr};
    static Ice_Object servant = {serve, ids, ids[0]};
    Ice_initialize(&ic);
    loop.emplace(ic);
    loop->silent = true;
    loop->tap = [](const Bytes& m) { replies += m[8] == 2; };
    if (Ice_Communicator_createObjectAdapterWithEndpoints(&ic, "A", "loop", &adapter) != ICE_OK)
        abort();
    Ice_ObjectAdapter_activate(&adapter);
    if (Ice_ObjectAdapter_add(&adapter, &servant, "thing") != ICE_OK ||
        (ICEC_FULL && Ice_ObjectAdapter_addDefaultServant(&adapter, &servant, "cat") != ICE_OK))
        abort();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    if (size < 2 || size > 2000)
        return 0;
    start();
    Ice_ObjectPrx prx;
    std::string text(data, data + size);
    if (ICEC_FULL && Ice_Communicator_stringToProxy(&ic, text.c_str(), &prx) == ICE_OK &&
        !Ice_ObjectPrx_isNull(&prx))
        checkProxy(prx, 1);
    loop->inject(ICE_EVENT_OPENED, 0);
    (void)Ice_Communicator_poll(&ic, 0);
    static const Ice_Byte types[] = {0, 0, 1, 2, 2, 3, 4, 9};
    unsigned choice = data[0] & 7;
    Bytes rest(data + 1, data + size);
    if (choice == 1) {
        rest = IceMessages::requestBody("thing", "op", data[0] >> 5 & 1, rest);
        rest[11] = data[0] >> 6; // mode
        rest.insert(rest.begin(), {1, 0, 0, 0});
    }
    messageDuringCall(types[choice], choice == 4, rest);
    // After any message the connection still works: it can be opened again, and a ping gets exactly
    // one reply.
    if (!loop->open[0] || data[0] & 8) {
        loop->inject(ICE_EVENT_OPENED, 0);
        (void)Ice_Communicator_poll(&ic, 0);
    }
    replies = 0;
    inject(IceMessages::request(1, IceMessages::requestBody("thing", "ice_ping")));
    (void)Ice_Communicator_poll(&ic, 0);
    if (replies != 1)
        abort();
    return 0;
}
