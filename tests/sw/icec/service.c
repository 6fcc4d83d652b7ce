/* SPDX-License-Identifier: MIT
 *
 * service: IceC's servant of Interop.ice, for both run times.
 */
#include "Interop.h"
#include "serve.h"

#include <string.h>

static Interop_Service service;
static Ice_Int notifications;
static Interop_CallbackPrx callback;
static int hasCallback;

Ice_Status Interop_Service_add(Interop_ServicePtr self, Ice_Int a, Ice_Int b, Ice_Int* result,
                               const Ice_Current* current) {
    (void)self, (void)current;
    *result = a + b;
    return ICE_OK;
}

Ice_Status Interop_Service_reverse(Interop_ServicePtr self, const Interop_Items* items,
                                   Ice_String* joined, Interop_Items* result,
                                   const Ice_Current* current) {
    static Interop_Item reversed[64];
    static char text[1024];
    Ice_Int i, at = 0;
    (void)self, (void)current;
    if (items->size > 64)
        return ICE_LIMIT;
    for (i = 0; i < items->size; ++i) {
        const Interop_Item* item = &items->data[i];
        reversed[items->size - 1 - i] = *item;
        if (at + item->name.size > (Ice_Int)sizeof text)
            return ICE_LIMIT;
        memcpy(text + at, item->name.data, (size_t)item->name.size);
        at += item->name.size;
    }
    joined->data = text;
    joined->size = at;
    result->size = items->size;
    result->data = reversed;
    return ICE_OK;
}

Ice_Status Interop_Service_echo(Interop_ServicePtr self, const Interop_Bytes* data,
                                Interop_Bytes* result, const Ice_Current* current) {
    (void)self, (void)current;
    *result = *data;
    return ICE_OK;
}

Ice_Status Interop_Service_notify(Interop_ServicePtr self, Ice_String text,
                                  const Ice_Current* current) {
    (void)self, (void)current;
    notifications += Ice_String_equals(text, "hello");
    return ICE_OK;
}

Ice_Status Interop_Service_notifications(Interop_ServicePtr self, Ice_Int* result,
                                         const Ice_Current* current) {
    (void)self, (void)current;
    *result = notifications;
    return ICE_OK;
}

Ice_Status Interop_Service_fail(Interop_ServicePtr self, Ice_Int status,
                                Interop_Service_fail_Exception* ex, const Ice_Current* current) {
    (void)self, (void)current;
    ex->type = Interop_Service_fail_Failure;
    ex->u.Failure.reason = Ice_String_from("as asked");
    return (Ice_Status)status;
}

Ice_Status Interop_Service_work(Interop_ServicePtr self, const Interop_CallbackPrx* prx,
                                const Ice_Current* current) {
    (void)self, (void)current;
    callback = *prx;
    hasCallback = 1;
    return ICE_OK;
}

Ice_Status Interop_Service_shutdown(Interop_ServicePtr self, const Ice_Current* current) {
    (void)self;
    Ice_Communicator_shutdown(current->communicator);
    return ICE_OK;
}

void Suite_work(void) {
    if (hasCallback && Interop_CallbackPrx_progress(&callback, 100) != ICE_OK)
        Ice_Communicator_shutdown(callback.communicator);
    hasCallback = 0;
}

Ice_Status Suite_serve(Ice_ObjectAdapterPtr adapter) {
    Interop_Service_init(&service);
    return Ice_ObjectAdapter_add(adapter, (Ice_ObjectPtr)&service, "service");
}
