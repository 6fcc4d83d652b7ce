/* SPDX-License-Identifier: MIT
 *
 * client: IceC's client of Interop.ice against a stock server: client [lost] PORT. Exit status 0:
 * all as expected. It does what the bridge does not: names of two addresses, batches, asynchronous
 * calls, a locator, proxies' strings. lost: a relay cuts connections.
 */
#include "Interop.h"
#include "tcp_endpoint.h"

#include <netdb.h>
#include <stdio.h>
#include <string.h>

#define COUNT(array) ((int)(sizeof(array) / sizeof *(array)))
#define CHECK(condition)                                                 \
    do {                                                                 \
        if (!(condition)) {                                              \
            printf("client.c:%d: not true: %s\n", __LINE__, #condition); \
            return 1;                                                    \
        }                                                                \
    } while (0)

static Ice_Communicator ic;
static TcpEndpoint tcp;
static Interop_ServicePrx service;
static const char* port;

static Ice_Status object(const char* proxy, Ice_ObjectPrxPtr prx) {
    char text[128];
    Ice_Status status;
    /* localhost has two addresses, of which the server listens at one. An empty machine does not
     * know that name. */
    sprintf(text, "%.40s:tcp -h %s -p %.8s", proxy,
            gethostbyname("localhost") ? "localhost" : "127.0.0.1", port);
    status = Ice_Communicator_stringToProxy(&ic, text, prx);
    prx->timeoutMs = 120000;
#ifndef ICEC_MINIMAL
    {
        static U32 room[4096];
        Ice_ObjectPrx_setReplyBuffer(prx, room, sizeof room);
    }
#endif
    return status;
}

static int calls(void) {
    Interop_Item data[3];
    Interop_Items items, back;
    Interop_Service_fail_Exception ex;
    Ice_ObjectPrx oneway, nobody, dead;
    Ice_String joined;
    Ice_Int sum, i;
    CHECK(object("service -o", &oneway) == ICE_OK && object("nobody", &nobody) == ICE_OK);
    CHECK(Ice_Communicator_stringToProxy(&ic, "x:ssl -p 1", &dead) == ICE_NO_ENDPOINT);
    CHECK(Ice_Communicator_stringToProxy(&ic, "x:tcp -h 127.0.0.1 -p 1", &dead) == ICE_OK);
    CHECK(Ice_ObjectPrx_ice_ping(&service) == ICE_OK);
    CHECK(Ice_ObjectPrx_ice_ping(&nobody) == ICE_OBJECT_NOT_EXIST);
    CHECK(Ice_ObjectPrx_ice_ping(&dead) == ICE_CONNECTION_LOST);
    for (i = 0; i < 1000; ++i)
        CHECK(Interop_ServicePrx_add(&service, i, 2 * i, &sum) == ICE_OK && sum == 3 * i);
    for (i = 0; i < 3; ++i) {
        static const char* const names[] = {"one", "two", "three"};
        data[i].name = Ice_String_from(names[i]);
        data[i].amount = -i;
        data[i].colour = (Interop_Colour)i;
        data[i].price = 1.5 * i;
    }
    items.size = 3;
    items.data = data;
    CHECK(Interop_ServicePrx_reverse(&service, &items, &joined, &back) == ICE_OK);
    CHECK(Ice_String_equals(joined, "onetwothree") && back.size == 3);
    CHECK(Ice_String_equals(back.data[0].name, "three") && back.data[0].amount == -2);
    CHECK(back.data[0].colour == Interop_blue && back.data[0].price == 3.0);
    for (i = 0; i < 5; ++i)
        CHECK(Interop_ServicePrx_notify(&oneway, Ice_String_from("hello")) == ICE_OK);
    CHECK(Interop_ServicePrx_notifications(&oneway, &sum) == ICE_TWOWAY_ONLY);
    do /* the server's threads may overtake each other: then one is missing for a while */
        CHECK(Interop_ServicePrx_notifications(&service, &sum) == ICE_OK);
    while (sum < 5);
    CHECK(sum == 5);
    CHECK(Interop_ServicePrx_fail(&service, ICE_OK, &ex) == ICE_OK);
    CHECK(Interop_ServicePrx_fail(&service, ICE_UNKNOWN_EXCEPTION, &ex) == ICE_UNKNOWN_EXCEPTION);
    CHECK(Interop_ServicePrx_fail(&service, ICE_USER_EXCEPTION, &ex) == ICE_USER_EXCEPTION);
    CHECK(ex.type == Interop_Service_fail_Failure);
    CHECK(Ice_String_equals(ex.u.Failure.reason, "as asked"));
    return 0;
}

#ifndef ICEC_MINIMAL
static Interop_TesterPrx tester;

static int batch(void) {
    Ice_ObjectPrx other = service;
    Ice_Batch batched;
    Ice_Byte data[200]; /* some are sent on the way */
    Ice_Int before, after, i;
    CHECK(Interop_ServicePrx_notifications(&service, &before) == ICE_OK);
    Ice_ObjectPrx_ice_batchOneway(&other, &batched, data, sizeof data);
    for (i = 0; i < 20; ++i)
        CHECK(Interop_ServicePrx_notify(&other, Ice_String_from("hello")) == ICE_OK);
    CHECK(Ice_ObjectPrx_ice_flushBatchRequests(&other) == ICE_OK);
    do
        CHECK(Interop_ServicePrx_notifications(&service, &after) == ICE_OK);
    while (after - before < 20);
    CHECK(after - before == 20);
    return 0;
}

static int locator(void) {
    static const char* const indirect[] = {"service@Adapter", "service"};
    Ice_ObjectPrx at, prx;
    Ice_Int i, sum;
    CHECK(object("locator", &at) == ICE_OK);
    for (i = 0; i < COUNT(indirect); ++i) {
        CHECK(Ice_Communicator_stringToProxy(&ic, indirect[i], &prx) == ICE_OK);
        CHECK(Ice_ObjectPrx_resolve(&prx, &at) == ICE_OK);
        CHECK(Interop_ServicePrx_add(&prx, 1, 2, &sum) == ICE_OK && sum == 3);
    }
    CHECK(Ice_Communicator_stringToProxy(&ic, "service@Other", &prx) == ICE_OK);
    CHECK(Ice_ObjectPrx_resolve(&prx, &at) == ICE_NO_ENDPOINT);
    return 0;
}

/* Results of asynchronous calls are checked while they are valid. */
static int right;

static void completed(Interop_Tester_later_Async* self) {
    if (self->context)
        right += self->status == ICE_USER_EXCEPTION &&
                 self->exception.type == Interop_Tester_later_Worse &&
                 self->exception.u.Worse.how == 7 &&
                 Ice_String_equals(self->exception.u.Worse.base.reason, "negative");
    else
        right += self->status == ICE_OK && self->result->id == 7 &&
                 self->result->next == self->result && self->has_same == tester.minor &&
                 (!tester.minor || Ice_String_equals(self->same, "text"));
}

static int asynchronous(void) {
    static Interop_Node nodes[3];
    static Interop_Tester_later_Async async[3];
    Ice_String text = Ice_String_from("text"), same;
    Interop_Node* back;
    Ice_ObjectPrx brief = tester;
    Ice_Bool hasSame;
    Ice_Int released, i;
    right = 0;
    for (i = 0; i < 3; ++i) {
        Interop_Node_init(&nodes[i]);
        nodes[i].id = i == 1 ? -1 : 7;
        async[i].completed = completed;
        async[i].context = i == 1 ? &text : 0;
        CHECK(Interop_TesterPrx_later_async(&tester, &nodes[i], &text, &async[i]) == ICE_OK);
    }
    for (released = 0; released < 3; released += i) /* they may overtake each other */
        CHECK(Interop_TesterPrx_release(&tester, &i) == ICE_OK);
    while (!async[0].done || !async[1].done || !async[2].done)
        (void)Ice_Communicator_poll(&ic, 10000); /* sending has woken the first one */
    CHECK(right == 3);
    /* Nobody answers in time; the late reply is passed over. */
    Ice_ObjectPrx_ice_invocationTimeout(&brief, 100);
    CHECK(Interop_TesterPrx_later(&brief, nodes, &text, &hasSame, &same, &back, 0) == ICE_TIMEOUT);
    do
        CHECK(Interop_TesterPrx_release(&tester, &i) == ICE_OK);
    while (i == 0);
    return 0;
}

/* Proxies of every form, and strings that are none: the peer makes the same of them. */
static int proxies(void) {
    static const char* const strings[] = {"plain",
                                          "plain -t",
                                          "cat/name -o",
                                          "a\\/b/c -O",
                                          "name -f facet",
                                          "name -e 1.0",
                                          "\"with space\":tcp -h 127.0.0.1 -p 10000",
                                          "'single quoted' -d",
                                          "name -f \"a facet\" -s",
                                          "name -e 1.1 -o -s:tcp -h host -p 1 -t 500",
                                          "name -p 1.0 -t",
                                          "name:tcp -h \"::1\" -p 65535 -t infinite",
                                          "name:tcp -h a -p 1:tcp -h b -p 2",
                                          "name:opaque -t 99 -e 1.0 -v QUJD",
                                          "name:opaque -e 1.1 -t 99 -v QUI=:tcp -h x -p 2",
                                          "name @ adapter",
                                          "cat/name -o @ \"an adapter\"",
                                          "tab\\tand\\nnewline",
                                          "octal\\101\\7",
                                          "quote\\\"s and \\'single",
                                          "back\\\\slash",
                                          " leading",
                                          "name -x",
                                          "name -t -o",
                                          "/name",
                                          "name/",
                                          "a/b/c",
                                          "name:",
                                          "name:tcp -h",
                                          "name @",
                                          "\"unclosed",
                                          "name -f",
                                          "-t"};
    Ice_ObjectPrx prx, back;
    int refused = 0, i;
    for (i = 0; i < COUNT(strings); ++i) {
        Ice_Bool same = 0;
        char text[400] = "";
        if (Ice_Communicator_stringToProxy(&ic, strings[i], &prx) == ICE_OK)
            CHECK(Ice_Communicator_proxyToString(&prx, text, sizeof text) == ICE_OK);
        refused += !*text;
        CHECK(Interop_TesterPrx_same(&tester, Ice_String_from(strings[i]), &prx,
                                     Ice_String_from(text), &back, &same) == ICE_OK);
        if (!same)
            printf("the peer makes another proxy of: %s\n", strings[i]);
        CHECK(same && Ice_ObjectPrx_isNull(&back) == Ice_ObjectPrx_isNull(&prx));
    }
    CHECK(refused == 9);
    return 0;
}

/* The peer skips an optional that it does not know by its size, of one byte, and of five. */
static int skipped(void) {
    static Ice_Int many[255];
    Ice_String text = Ice_String_from("text"), back;
    Interop_NewerPrx older;
    Interop_Ints ints;
    CHECK(object("older", &older) == ICE_OK);
    ints.data = many;
    for (ints.size = 254; ints.size <= 255; ++ints.size) {
        CHECK(Interop_NewerPrx_skip(&older, 4, &ints, &text, &back) == ICE_OK);
        CHECK(Ice_String_equals(back, "text"));
    }
    return 0;
}

/* The servant of a class names what it implements, and the classes that it derives from. */
static int classes(void) {
    static const char* const ids[] = {"::Ice::Object", "::Interop::Labelled", "::Interop::Named",
                                      "::Interop::Square"};
    static const Interop_SquareDisp_Operations none;
    Interop_SquareDisp square;
    const Ice_Object* object = (const Ice_Object*)&square;
    int i;
    Interop_SquareDisp_initWith(&square, &none);
    for (i = 0; i < COUNT(ids); ++i)
        CHECK(object->ids[i] && strcmp(object->ids[i], ids[i]) == 0);
    CHECK(!object->ids[i]);
    return 0;
}

static int full(void) {
    Ice_ObjectPrx base;
    Ice_Failure failure;
    Ice_Byte minor;
    CHECK(Interop_ServicePrx_fail(&service, ICE_UNKNOWN_LOCAL_EXCEPTION, 0) ==
          ICE_UNKNOWN_LOCAL_EXCEPTION);
    Ice_ObjectPrx_failure(&service, &failure);
    CHECK(failure.unknown.size != 0);
    CHECK(object("tester", &base) == ICE_OK);
    CHECK(Interop_TesterPrx_checkedCast(&tester, &base) == ICE_OK &&
          !Ice_ObjectPrx_isNull(&tester));
    for (minor = 0; minor < 2; ++minor) {
        Ice_ObjectPrx_ice_encodingVersion(&tester, minor);
        if (asynchronous() || proxies())
            return 1;
    }
    return batch() || locator() || skipped() || classes();
}

/* The relay cuts every connection after some bytes; a call either answers or fails as lost. */
static int lost(void) {
    static Ice_Byte many[200];
    Interop_Bytes out, in;
    int answered = 0, failed = 0, i;
    Ice_Status status;
    out.size = sizeof many, out.data = many;
    for (i = 0; i < 60; ++i) {
        status = Interop_ServicePrx_echo(&service, &out, &in);
        CHECK(status == ICE_CONNECTION_LOST || (status == ICE_OK && in.size == out.size));
        answered += status == ICE_OK;
        failed += status != ICE_OK;
    }
    printf("client: %d calls answered, %d lost with their connection\n", answered, failed);
    CHECK(answered >= 20 && failed >= 3);
    while (Interop_ServicePrx_shutdown(&service) != ICE_OK)
        if (Ice_ObjectPrx_ice_ping(&service) == ICE_CONNECTION_LOST &&
            Ice_ObjectPrx_ice_ping(&service) == ICE_CONNECTION_LOST)
            break; /* its answer was cut off, and the connection has gone */
    return 0;
}
#endif

int main(int argc, char** argv) {
    if (argc < 2) {
        fprintf(stderr, "usage: client [lost] port\n");
        return 2;
    }
    port = argv[argc - 1];
    Ice_initialize(&ic);
    CHECK(TcpEndpoint_init(&ic, &tcp) == ICE_OK);
    CHECK(object("service", &service) == ICE_OK);
#ifndef ICEC_MINIMAL
    if (strcmp(argv[1], "lost") == 0)
        return lost();
#endif
    if (calls())
        return 1;
#ifndef ICEC_MINIMAL
    if (full())
        return 1;
#endif
    CHECK(Interop_ServicePrx_shutdown(&service) == ICE_OK);
    TcpEndpoint_destroy(&tcp);
    printf("client: all calls as expected\n");
    return 0;
}
