/* SPDX-License-Identifier: MIT
 *
 * server: an IceC server over tcp. Prints its port, serves until `shutdown`.
 */
#include "Interop.h"
#include "tcp_endpoint.h"

#include <stdio.h>
#include <string.h>

static Ice_Communicator ic;
static TcpEndpoint tcp;
static Ice_ObjectAdapter adapter;
static Interop_Service service;
static Ice_Int notifications;
static Interop_CallbackPrx callback;
static int hasCallback;
static Interop_Item reversed[64];
static char joinedText[1024];

Ice_Status Interop_Service_add(Interop_ServicePtr self, Ice_Int a, Ice_Int b, Ice_Int* result,
                               const Ice_Current* current) {
    (void)self;
    (void)current;
    *result = a + b;
    return ICE_OK;
}

Ice_Status Interop_Service_reverse(Interop_ServicePtr self, const Interop_Items* items,
                                   Ice_String* joined, Interop_Items* result,
                                   const Ice_Current* current) {
    Ice_Int i, at = 0;
    (void)self;
    (void)current;
    if (items->size > 64)
        return ICE_LIMIT;
    for (i = 0; i < items->size; ++i) {
        const Interop_Item* item = &items->data[i];
        reversed[items->size - 1 - i] = *item;
        if (at + item->name.size > (Ice_Int)sizeof joinedText)
            return ICE_LIMIT;
        memcpy(joinedText + at, item->name.data, (size_t)item->name.size);
        at += item->name.size;
    }
    joined->data = joinedText;
    joined->size = at;
    result->size = items->size;
    result->data = reversed;
    return ICE_OK;
}

Ice_Status Interop_Service_echo(Interop_ServicePtr self, const Interop_Bytes* data,
                                Interop_Bytes* result, const Ice_Current* current) {
    (void)self;
    (void)current;
    *result = *data;
    return ICE_OK;
}

Ice_Status Interop_Service_notify(Interop_ServicePtr self, Ice_String text,
                                  const Ice_Current* current) {
    (void)self;
    (void)current;
    notifications += Ice_String_equals(text, "hello");
    return ICE_OK;
}

Ice_Status Interop_Service_notifications(Interop_ServicePtr self, Ice_Int* result,
                                         const Ice_Current* current) {
    (void)self;
    (void)current;
    *result = notifications;
    return ICE_OK;
}

Ice_Status Interop_Service_fail(Interop_ServicePtr self, const Ice_Current* current) {
    (void)self;
    (void)current;
    return ICE_UNKNOWN_EXCEPTION;
}

Ice_Status Interop_Service_work(Interop_ServicePtr self, const Interop_CallbackPrx* prx,
                                const Ice_Current* current) {
    (void)self;
    (void)current;
    callback = *prx;
    hasCallback = 1;
    return ICE_OK;
}

Ice_Status Interop_Service_shutdown(Interop_ServicePtr self, const Ice_Current* current) {
    (void)self;
    (void)current;
    Ice_Communicator_shutdown(&ic);
    return ICE_OK;
}

int main(void) {
    Ice_initialize(&ic);
    if (TcpEndpoint_init(&ic, &tcp) != ICE_OK || Ice_Communicator_createObjectAdapterWithEndpoints(
                                                     &ic, "Adapter", "tcp", &adapter) != ICE_OK)
        return 1;
    Interop_Service_init(&service);
    if (Ice_ObjectAdapter_add(&adapter, (Ice_ObjectPtr)&service, "service") != ICE_OK)
        return 1;
    Ice_ObjectAdapter_activate(&adapter);
    printf("%d\n", tcp.port);
    fflush(stdout);
    while (!ic.stopping) {
        (void)Ice_Communicator_poll(&ic, 100);
        if (hasCallback) {
            hasCallback = 0;
            if (Interop_CallbackPrx_progress(&callback, 100) != ICE_OK)
                return 2;
        }
    }
    TcpEndpoint_destroy(&tcp);
    return 0;
}
