/* SPDX-License-Identifier: MIT
 *
 * tester: IceC's servant of Everything.ice.
 */
#include "tester.h"

#include <stdio.h>
#include <string.h>

#define WAITING_MAX 32

static Everything_Tester tester;
static struct {
    Ice_Reply reply;
    Ice_Int value;
} waiting[WAITING_MAX];
static int waitingCount;
static Ice_Int total;

Ice_Status Everything_Tester_echoNumbers(Everything_TesterPtr self, const Everything_Numbers* v,
                                         Everything_Numbers* same, Everything_Numbers* result,
                                         const Ice_Current* current) {
    (void)self, (void)current;
    *same = *result = *v;
    return ICE_OK;
}

Ice_Status Everything_Tester_echoMixed(Everything_TesterPtr self, const Everything_Mixed* v,
                                       Everything_Mixed* result, const Ice_Current* current) {
    (void)self, (void)current;
    *result = *v;
    return ICE_OK;
}

Ice_Status Everything_Tester_echoMixeds(Everything_TesterPtr self, const Everything_Mixeds* v,
                                        Ice_Int* count, Everything_Mixeds* result,
                                        const Ice_Current* current) {
    (void)self, (void)current;
    *result = *v;
    *count = v->size;
    return ICE_OK;
}

Ice_Status Everything_Tester_echoBytes(Everything_TesterPtr self, const Everything_Bytes* v,
                                       Everything_Bytes* result, const Ice_Current* current) {
    (void)self, (void)current;
    *result = *v;
    return ICE_OK;
}

Ice_Status Everything_Tester_echoCounts(Everything_TesterPtr self, const Everything_Counts* v,
                                        Everything_Counts* result, const Ice_Current* current) {
    (void)self, (void)current;
    *result = *v;
    return ICE_OK;
}

Ice_Status Everything_Tester_echoLists(Everything_TesterPtr self, const Everything_Lists* v,
                                       Everything_Lists* result, const Ice_Current* current) {
    (void)self, (void)current;
    *result = *v;
    return ICE_OK;
}

Ice_Status Everything_Tester_echoProxy(Everything_TesterPtr self, const Ice_ObjectPrx* v,
                                       Ice_ObjectPrx* result, const Ice_Current* current) {
    (void)self, (void)current;
    *result = *v;
    return ICE_OK;
}

Ice_Status Everything_Tester_echoProxies(Everything_TesterPtr self, const Everything_Proxies* v,
                                         Everything_Proxies* result, const Ice_Current* current) {
    (void)self, (void)current;
    *result = *v;
    return ICE_OK;
}

Ice_Status Everything_Tester_echoOptionals(Everything_TesterPtr self, Ice_Int required,
                                           const Ice_String* a, const Everything_Numbers* b,
                                           const Everything_Ints* c, Ice_Bool* has_aa,
                                           Ice_String* aa, Ice_Bool* has_bb, Everything_Numbers* bb,
                                           Ice_Bool* has_cc, Everything_Ints* cc,
                                           Ice_Bool* has_result, Ice_Int* result,
                                           const Ice_Current* current) {
    (void)self, (void)current;
    *has_aa = a != 0, *has_bb = b != 0, *has_cc = c != 0;
    if (a)
        *aa = *a;
    if (b)
        *bb = *b;
    if (c)
        *cc = *c;
    *has_result = required != 0;
    *result = required;
    return ICE_OK;
}

Ice_Status Everything_Tester_echoNode(Everything_TesterPtr self, Everything_Node* v,
                                      Everything_Node** result, const Ice_Current* current) {
    (void)self, (void)current;
    *result = v;
    return ICE_OK;
}

/* The failures by `how` - 11, as the peers count. */
static const Ice_Status failures[] = {ICE_OBJECT_NOT_EXIST,
                                      ICE_FACET_NOT_EXIST,
                                      ICE_OPERATION_NOT_EXIST,
                                      ICE_USER_EXCEPTION,
                                      ICE_UNKNOWN_EXCEPTION,
                                      ICE_MARSHAL,
                                      ICE_TIMEOUT,
                                      ICE_CONNECTION_LOST,
                                      ICE_NO_ENDPOINT,
                                      ICE_LIMIT,
                                      ICE_PROTOCOL,
                                      ICE_UNKNOWN_LOCAL_EXCEPTION,
                                      ICE_UNKNOWN_USER_EXCEPTION};

Ice_Status Everything_Tester_fail(Everything_TesterPtr self, Ice_Int how,
                                  Everything_Tester_fail_Exception* ex,
                                  const Ice_Current* current) {
    static Everything_Counts_Entry entry;
    (void)self, (void)current;
    switch (how) {
    case 0:
        return ICE_OK;
    case 1:
        ex->type = Everything_Tester_fail_Failure;
        ex->u.Failure.reason = Ice_String_from("as asked");
        return ICE_USER_EXCEPTION;
    case 2:
        ex->type = Everything_Tester_fail_Worse;
        ex->u.Worse.base.reason = Ice_String_from("worse");
        ex->u.Worse.how = 7;
        return ICE_USER_EXCEPTION;
    case 3:
    case 4:
        ex->type = Everything_Tester_fail_Unrelated;
        entry.key = Ice_String_from("key");
        entry.value = -1;
        ex->u.Unrelated.counts.size = 1;
        ex->u.Unrelated.counts.data = &entry;
        ex->u.Unrelated.has_hint = how == 4;
        ex->u.Unrelated.hint = Ice_String_from("hint");
        return ICE_USER_EXCEPTION;
    default:
        return how > 10 && how < 24 ? failures[how - 11] : ICE_UNKNOWN_EXCEPTION;
    }
}

/* It throws what `fail` throws: one union serves both. */
Ice_Status Everything_Tester_failSliced(Everything_TesterPtr self, Ice_Int how,
                                        Everything_Tester_failSliced_Exception* ex,
                                        const Ice_Current* current) {
    return how == 2 ? Everything_Tester_fail(self, how, ex, current) : ICE_UNKNOWN_EXCEPTION;
}

Ice_Status Everything_Tester_context(Everything_TesterPtr self, Ice_String key, Ice_String* result,
                                     const Ice_Current* current) {
    static char text[64];
    (void)self;
    if (key.size >= (Ice_Int)sizeof text)
        return ICE_LIMIT;
    memcpy(text, key.data, (size_t)key.size);
    text[key.size] = 0;
    if (!Ice_Current_context(current, text, result))
        *result = Ice_String_from("-");
    return ICE_OK;
}

Ice_Status Everything_Tester_whoAmI(Everything_TesterPtr self, Ice_String* result,
                                    const Ice_Current* current) {
    static char text[200];
    (void)self;
    sprintf(text, "%.*s/%.*s -f %.*s mode %d", (int)current->category.size, current->category.data,
            (int)current->name.size, current->name.data, (int)current->facet.size,
            current->facet.data, current->mode);
    *result = Ice_String_from(text);
    return ICE_OK;
}

Ice_Status Everything_Tester_callBack(Everything_TesterPtr self,
                                      const Everything_WatcherPrx* watcher, Ice_Int times,
                                      Ice_Int* result, const Ice_Current* current) {
    Everything_WatcherPrx prx = *watcher;
    Ice_Status status = ICE_OK;
    Ice_Int sum = 0, i;
    (void)self, (void)current;
    for (i = 0; i < times && status == ICE_OK; ++i) {
        Ice_Int answer = 0;
        status = Everything_WatcherPrx_ask(&prx, i, &answer);
        sum += answer;
    }
    *result = sum;
    return status;
}

Ice_Status Everything_Tester_later(Everything_TesterPtr self, Ice_Int v,
                                   const Ice_Current* current) {
    (void)self;
    if (waitingCount == WAITING_MAX)
        return ICE_LIMIT;
    waiting[waitingCount].value = v;
    Ice_Current_later(current, &waiting[waitingCount++].reply);
    return ICE_LATER;
}

Ice_Status Everything_Tester_release(Everything_TesterPtr self, Ice_Int* result,
                                     const Ice_Current* current) {
    Everything_Tester_later_Exception ex;
    (void)self, (void)current;
    *result = waitingCount;
    while (waitingCount > 0) {
        Ice_Int value = waiting[--waitingCount].value;
        ex.type = Everything_Tester_later_Failure;
        ex.u.Failure.reason = Ice_String_from("negative");
        if (value < 0)
            (void)Everything_Tester_later_exception(&waiting[waitingCount].reply, &ex);
        else
            (void)Everything_Tester_later_response(&waiting[waitingCount].reply, 2 * value);
    }
    return ICE_OK;
}

Ice_Status Everything_Tester_note(Everything_TesterPtr self, Ice_Int v,
                                  const Ice_Current* current) {
    (void)self, (void)current;
    total += v;
    return ICE_OK;
}

Ice_Status Everything_Tester_sum(Everything_TesterPtr self, Ice_Int* result,
                                 const Ice_Current* current) {
    (void)self, (void)current;
    *result = total;
    return ICE_OK;
}

Ice_Status Everything_Tester_shutdown(Everything_TesterPtr self, const Ice_Current* current) {
    (void)self;
    Ice_Communicator_shutdown(current->communicator);
    return ICE_OK;
}

/* A class that is called. */
static Everything_SquareDisp square;
static Ice_Int side;

Ice_Status Everything_SquareDisp_label(Everything_LabelledPtr self, Ice_String* result,
                                       const Ice_Current* current) {
    (void)self, (void)current;
    *result = Ice_String_from("square");
    return ICE_OK;
}

Ice_Status Everything_SquareDisp_area(Everything_ShapeDispPtr self, Ice_Int scale, Ice_Int* result,
                                      Everything_ShapeDisp_area_Exception* ex,
                                      const Ice_Current* current) {
    (void)self, (void)current;
    *result = scale * side * side;
    ex->type = Everything_ShapeDisp_area_Failure;
    ex->u.Failure.reason = Ice_String_from("negative");
    return scale < 0 ? ICE_USER_EXCEPTION : ICE_OK;
}

Ice_Status Everything_SquareDisp_grow(Everything_SquareDispPtr self, Ice_Int by,
                                      const Ice_Current* current) {
    Ice_Reply reply;
    (void)self;
    side += by;
    Ice_Current_later(current, &reply);
    (void)Everything_SquareDisp_grow_response(&reply, side);
    return ICE_LATER;
}

Ice_Status Tester_serve(Ice_ObjectAdapterPtr adapter) {
    Ice_Status status;
    Everything_Tester_init(&tester);
    Everything_SquareDisp_init(&square);
    if (Ice_ObjectAdapter_add(adapter, (Ice_ObjectPtr)&square, "square") != ICE_OK)
        return ICE_LIMIT;
    status = Ice_ObjectAdapter_add(adapter, (Ice_ObjectPtr)&tester, "tester");
    if (status == ICE_OK)
        status = Ice_ObjectAdapter_addFacet(adapter, (Ice_ObjectPtr)&tester, "tester", "side");
    if (status == ICE_OK)
        status = Ice_ObjectAdapter_addDefaultServant(adapter, (Ice_ObjectPtr)&tester, "any");
    Ice_ObjectAdapter_activate(adapter);
    return status;
}
