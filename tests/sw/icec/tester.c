/* SPDX-License-Identifier: MIT
 *
 * tester: IceC's servants of Interop.ice that need the full run time.
 */
#include "Interop.h"
#include "serve.h"

#include <stdio.h>
#include <string.h>

#define WAITING_MAX 32

static Interop_Tester tester;
static Interop_SquareDisp square;
static struct {
    Ice_Reply reply;
    Ice_Int id, textSize; /* -1: no text */
    char text[16];
} waiting[WAITING_MAX];
static int waitingCount;

Ice_Status Interop_Tester_context(Interop_TesterPtr self, Ice_String key, Ice_String* result,
                                  const Ice_Current* current) {
    static char text[64];
    (void)self;
    if (key.size >= (Ice_Int)sizeof text)
        return ICE_LIMIT;
    sprintf(text, "%.*s", (int)key.size, key.data);
    if (!Ice_Current_context(current, text, result))
        *result = Ice_String_from("-");
    return ICE_OK;
}

Ice_Status Interop_Tester_whoAmI(Interop_TesterPtr self, Ice_String* result,
                                 const Ice_Current* current) {
    static char text[200];
    (void)self;
    sprintf(text, "%.*s/%.*s -f %.*s mode %d", (int)current->category.size, current->category.data,
            (int)current->name.size, current->name.data, (int)current->facet.size,
            current->facet.data, current->mode);
    *result = Ice_String_from(text);
    return ICE_OK;
}

Ice_Status Interop_Tester_callBack(Interop_TesterPtr self, const Interop_CallbackPrx* callback,
                                   Ice_Int times, Ice_Int* result, const Ice_Current* current) {
    Interop_CallbackPrx prx = *callback;
    Ice_Status status = ICE_OK;
    Ice_Int i, answer = 0;
    (void)self, (void)current;
    *result = 0;
    for (i = 0; i < times && status == ICE_OK; ++i) {
        status = Interop_CallbackPrx_ask(&prx, i, &answer);
        *result += answer;
    }
    return status;
}

Ice_Status Interop_Tester_later(Interop_TesterPtr self, Interop_Node* v, const Ice_String* text,
                                const Ice_Current* current) {
    (void)self;
    if (waitingCount == WAITING_MAX || !v || (text && text->size > 16))
        return ICE_LIMIT;
    waiting[waitingCount].id = v->id;
    waiting[waitingCount].textSize = text ? text->size : -1;
    if (text)
        memcpy(waiting[waitingCount].text, text->data, (size_t)text->size);
    Ice_Current_later(current, &waiting[waitingCount++].reply);
    return ICE_LATER;
}

Ice_Status Interop_Tester_release(Interop_TesterPtr self, Ice_Int* result,
                                  const Ice_Current* current) {
    Interop_Tester_later_Exception ex;
    Interop_Node node;
    Ice_String text;
    (void)self, (void)current;
    Interop_Node_init(&node);
    node.next = &node;
    ex.type = Interop_Tester_later_Worse;
    ex.u.Worse.base.reason = Ice_String_from("negative");
    ex.u.Worse.how = 7;
    *result = waitingCount;
    while (waitingCount > 0) {
        Ice_Reply* reply = &waiting[--waitingCount].reply;
        node.id = waiting[waitingCount].id;
        text.size = waiting[waitingCount].textSize;
        text.data = waiting[waitingCount].text;
        if (node.id < 0)
            (void)Interop_Tester_later_exception(reply, &ex);
        else
            (void)Interop_Tester_later_response(reply, text.size < 0 ? 0 : &text, &node);
    }
    return ICE_OK;
}

Ice_Status Interop_Tester_same(Interop_TesterPtr self, Ice_String text, const Ice_ObjectPrx* proxy,
                               Ice_String printed, Ice_ObjectPrx* back, Ice_Bool* result,
                               const Ice_Current* current) {
    char own[400];
    (void)self, (void)text, (void)current;
    *back = *proxy;
    *result = Ice_Communicator_proxyToString(proxy, own, sizeof own) == ICE_OK &&
              Ice_String_equals(printed, own);
    return ICE_OK;
}

Ice_Status Interop_SquareDisp_label(Interop_LabelledPtr self, Ice_String* result,
                                    const Ice_Current* current) {
    (void)self, (void)current;
    *result = Ice_String_from("square");
    return ICE_OK;
}

Ice_Status Interop_SquareDisp_area(Interop_SquareDispPtr self, Ice_Int side, Ice_Int* result,
                                   Interop_SquareDisp_area_Exception* ex,
                                   const Ice_Current* current) {
    (void)self, (void)current;
    *result = side * side;
    ex->type = Interop_SquareDisp_area_Failure;
    ex->u.Failure.reason = Ice_String_from("negative");
    return side < 0 ? ICE_USER_EXCEPTION : ICE_OK;
}

Ice_Status Tester_serve(Ice_ObjectAdapterPtr adapter) {
    Ice_ObjectPtr object = (Ice_ObjectPtr)&tester;
    Interop_Tester_init(&tester);
    Interop_SquareDisp_init(&square);
    if (Ice_ObjectAdapter_add(adapter, object, "tester") != ICE_OK ||
        Ice_ObjectAdapter_addFacet(adapter, object, "tester", "side") != ICE_OK ||
        Ice_ObjectAdapter_addDefaultServant(adapter, object, "any") != ICE_OK)
        return ICE_LIMIT;
    return Ice_ObjectAdapter_add(adapter, (Ice_ObjectPtr)&square, "square");
}
