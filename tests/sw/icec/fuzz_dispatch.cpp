// SPDX-License-Identifier: MIT
//
// fuzz_dispatch: libFuzzer on all messages of a peer: bytes behind a valid head.
//
// The first byte chooses the message's type. Afterwards the communicator must still answer a ping.
// With ICEC_MINIMAL the same of the minimal run time.

#include <cstdint>
#include <cstdlib>
#include <vector>

extern "C" {
#include "icec.h"
#include "loop_endpoint.h"
}

namespace {

Ice_Communicator ic;
LoopEndpoint loop;
Ice_ObjectAdapter adapter;
int replies;

Ice_Status serve(Ice_ObjectPtr, const Ice_Current* current, Ice_InputStreamPtr is,
                 Ice_OutputStreamPtr os) {
    Ice_ObjectPrx prx;
    Ice_String value;
    if (ICEC_FULL)
        (void)Ice_Current_context(current, "key", &value);
    Ice_InputStream_readPrx(is, nullptr, &prx);
    Ice_Int n = Ice_InputStream_readSequence(is, 1);
    auto* room = static_cast<Ice_String*>(Ice_InputStream_allocate(is, n, sizeof(Ice_String)));
    for (Ice_Int i = 0; room && i < n; ++i)
        room[i] = Ice_InputStream_readString(is);
    (void)Ice_InputStream_readEnum(is, 300);
    for (Ice_Int tag = 1; tag < 8; ++tag)
        if (Ice_InputStream_readOptional(is, tag, ICE_OPTIONAL_VSIZE))
            (void)Ice_InputStream_readString(is);
    Ice_InputStream_skipOptionals(is);
    if (ICEC_FULL && current->mode == 3) {
        static Ice_Reply later;
        Ice_Current_later(current, &later);
        (void)Ice_Reply_begin(&later);
        (void)Ice_Reply_end(&later, ICE_LIMIT);
        return ICE_LATER;
    }
    Ice_OutputStream_writePrx(os, is->failed ? nullptr : &prx);
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

void inject(Ice_Byte type, const uint8_t* body, size_t size) {
    std::vector<Ice_Byte> m = {'I', 'c', 'e', 'P', 1, 0, 1, 0, type, 0};
    for (int i = 0; i < 4; ++i)
        m.push_back(static_cast<Ice_Byte>((14 + size) >> (8 * i)));
    m.insert(m.end(), body, body + size);
    (void)LoopEndpoint_inject(&loop, ICE_EVENT_MESSAGE, 0, m.data(),
                              static_cast<Ice_Int>(m.size()));
}

// Delivers a message while a call of this side waits, so that replies are about something.
// `answers`: with that call's id.
void messageDuringCall(Ice_Byte type, bool answers, std::vector<uint8_t> body) {
    static Ice_ObjectPrx prx;
    Ice_InputStreamPtr is;
    (void)Ice_Communicator_stringToProxy(&ic, "far:loop", &prx);
    prx.timeoutMs = 5;
    Ice_OutputStreamPtr os = Ice_ObjectPrx_begin(&prx, "op", ICE_RESULTS);
    if (!os)
        abort();
    if (answers)
        body.insert(body.begin(), os->data + 14, os->data + 18);
    inject(type, body.data(), body.size());
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
    LoopEndpoint_init(&ic, &loop);
    loop.silent = 1;
    loop.tap = [](void*, int, const Ice_Byte* m, Ice_Int) { replies += m[8] == 2; };
    if (Ice_Communicator_createObjectAdapterWithEndpoints(&ic, "A", "loop", &adapter) != ICE_OK)
        abort();
    Ice_ObjectAdapter_activate(&adapter);
    if (Ice_ObjectAdapter_add(&adapter, &servant, "thing") != ICE_OK ||
        (ICEC_FULL && Ice_ObjectAdapter_addDefaultServant(&adapter, &servant, "cat") != ICE_OK))
        abort();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    static const uint8_t ping[] = {1,   0, 0, 0,   5,   't', 'h', 'i', 'n', 'g',
                                   0,   0, 8, 'i', 'c', 'e', '_', 'p', 'i', 'n',
                                   'g', 0, 0, 6,   0,   0,   0,   1,   1};
    if (size < 2 || size > 2000)
        return 0;
    start();
    if (LoopEndpoint_inject(&loop, ICE_EVENT_OPENED, 0, nullptr, 0) != ICE_OK)
        abort();
    (void)Ice_Communicator_poll(&ic, 0);
    static const Ice_Byte types[] = {0, 0, 1, 2, 2, 3, 4, 9};
    messageDuringCall(types[data[0] & 7], (data[0] & 7) == 4, {data + 1, data + size});
    // The connection works again after any message: a new one, a ping, one reply.
    if (!loop.open[0] || data[0] & 8) {
        (void)LoopEndpoint_inject(&loop, ICE_EVENT_OPENED, 0, nullptr, 0);
        (void)Ice_Communicator_poll(&ic, 0);
    }
    replies = 0;
    inject(0, ping, sizeof ping);
    (void)Ice_Communicator_poll(&ic, 0);
    if (replies != 1)
        abort();
    return 0;
}
