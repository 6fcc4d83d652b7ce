/* SPDX-License-Identifier: MIT
 *
 * minimal_stack: a vehicle with one loop, as in sw/apps/minimal.
 */
#include "minimal_stack.h"
#include "xbee_endpoint.h"

static const Stack_World* world;
static void* worldContext;
static Ice_Communicator ic;
static Ice_ObjectAdapter adapter;
static XBeeATEndpoint endpoint;
static Link radioLink;
static Ice_Object vehicle;
static int served, lastNotified;

static U32 nowUs(void* context) {
    (void)context;
    return world->nowUs(worldContext);
}

static U32 nowMs(void* context) {
    return nowUs(context) / 1000U;
}

static int work(void* context, Ice_Int timeoutMs) {
    U32 begin = nowUs(context);
    for (;;) {
        U8 bytes[LINK_MAX_FRAME];
        U32 size;
        while ((size = world->receive(worldContext, bytes)) != 0)
            Link_receive(&radioLink, bytes, size, nowUs(context));
        Link_poll(&radioLink, nowUs(context));
        if (endpoint.events || (Ice_Int)((nowUs(context) - begin) / 1000U) >= timeoutMs)
            return 0;
        world->step(worldContext);
    }
}

static const XBeeATEndpoint_Port endpointPort = {0, 0, 0, work, 0, nowMs};

static int transmit(void* context, const U8* frame, U32 size) {
    (void)context;
    return world->transmit(worldContext, frame, size);
}

static U32 randomWord(void* context) {
    static U32 state = 1;
    return state = state * 1664525U + nowUs(context);
}

static Ice_Status dispatch(Ice_ObjectPtr self, const Ice_Current* current, Ice_InputStreamPtr is,
                           Ice_OutputStreamPtr os) {
    Ice_Int value = Ice_InputStream_readInt(is);
    (void)self;
    if (Ice_String_is(&current->operation, "notify"))
        lastNotified = value;
    else if (Ice_String_is(&current->operation, "twice"))
        Ice_OutputStream_writeInt(os, 2 * value);
    else
        return ICE_OPERATION_NOT_EXIST;
    ++served;
    return ICE_OK;
}

void Stack_init(const Stack_World* w, void* context) {
    static const Link_Port linkPort = {transmit,
                                       randomWord,
                                       XBeeATEndpoint_onMessage,
                                       XBeeATEndpoint_onChannel,
                                       XBeeATEndpoint_onState,
                                       0,
                                       0};
    static const char* const ids[] = {"::Ice::Object", 0};
    world = w;
    worldContext = context;
    served = lastNotified = 0;
    Link_init(&radioLink, &linkPort, &endpoint, 1440);
    Link_start(&radioLink, nowUs(0));
    Ice_initialize(&ic);
    XBeeATEndpoint_init(&ic, "xbee-at", &endpoint, &radioLink, 1, &endpointPort, 0);
    (void)Ice_Communicator_createObjectAdapterWithEndpoints(&ic, "A", "xbee-at", &adapter);
    vehicle.dispatch = dispatch;
    vehicle.ids = ids;
    (void)Ice_ObjectAdapter_add(&adapter, &vehicle, "vehicle");
    Ice_ObjectAdapter_activate(&adapter);
}

void Stack_poll(void) {
    (void)Ice_Communicator_poll(&ic, 0);
}

/* `mode`: of Ice_ObjectPrx_begin. */
static int callStation(const char* where, const char* operation, Ice_Byte mode, int value) {
    static Ice_ObjectPrx prx;
    Ice_InputStreamPtr is = 0;
    Ice_OutputStreamPtr os;
    Ice_Status status;
    int result = 0;
    if (Ice_Communicator_stringToProxy(&ic, where, &prx) != ICE_OK)
        return -1;
    prx.timeoutMs = 60000;
    os = Ice_ObjectPrx_begin(&prx, operation, mode);
    if (!os)
        return -1000 - prx.status;
    Ice_OutputStream_writeInt(os, value);
    status = Ice_ObjectPrx_invoke(&prx, &is);
    if (status == ICE_OK && (mode & ICE_RESULTS))
        result = Ice_InputStream_readInt(is);
    status = Ice_ObjectPrx_end(&prx, status);
    return status == ICE_OK ? result : -1000 - (int)status;
}

int Stack_twice(int value) {
    return callStation("station:xbee-at -a 0x0000", "twice", ICE_RESULTS, value);
}

int Stack_notify(int value) {
    return callStation("station -o:xbee-at -a 0x0000", "notify", 0, value);
}

int Stack_served(void) {
    return served;
}

int Stack_lastNotified(void) {
    return lastNotified;
}
