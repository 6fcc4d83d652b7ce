/* SPDX-License-Identifier: MIT
 *
 * client: IceC's client of Everything.ice against a server on the port given. Exit status 0: all as
 * expected. `client slow PORT`: fewer calls; `client lost PORT`: a relay cuts connections.
 */
#include "../check.h"
#include "Everything.h"
#include "tcp_endpoint.h"

#include <stdio.h>
#include <string.h>

static Ice_Communicator ic;
static TcpEndpoint tcp;
static Everything_TesterPrx tester;
static U32 room[4096]; /* for replies */

static int equal(const Everything_Numbers* a, const Everything_Numbers* b) {
    return a->b == b->b && a->y == b->y && a->s == b->s && a->i == b->i && a->l.low == b->l.low &&
           a->l.high == b->l.high && a->f == b->f && a->d == b->d;
}

/* Compares proxies by their strings: a peer may encode endpoints anew. */
static int alike(const Ice_ObjectPrx* a, const Ice_ObjectPrx* b) {
    char x[400], y[400];
    return Ice_Communicator_proxyToString(a, x, sizeof x) == ICE_OK &&
           Ice_Communicator_proxyToString(b, y, sizeof y) == ICE_OK && strcmp(x, y) == 0;
}

static void fill(Everything_Numbers* n) {
    n->b = 1, n->y = 200, n->s = -3, n->i = 1 << 30;
    n->l.low = 0xFFFFFFF0U, n->l.high = -5;
    n->f = 0.5F, n->d = -1e300;
}

/* Dictionaries by number, and sequences of proxies. Sequences of all types are slice.roundtrip's.
 */
static int dictionaries(void) {
    Ice_String text = Ice_String_from("\344\270\255");
    Everything_Strings one, none;
    Everything_Lists_Entry entries[2];
    Everything_Lists lists, listsBack;
    Ice_ObjectPrx prxs[2];
    Everything_Proxies proxies, proxiesBack;
    one.size = 1, one.data = &text, none.size = 0, none.data = 0;
    entries[0].key = 1, entries[0].value = one, entries[1].key = -2, entries[1].value = none;
    lists.size = 2, lists.data = entries;
    CHECK(Everything_TesterPrx_echoLists(&tester, &lists, &listsBack) == ICE_OK);
    CHECK(listsBack.size == 2 && Everything_Lists_find(&listsBack, 1)->size == 1);
    CHECK(Everything_Lists_find(&listsBack, -2)->size == 0 && !Everything_Lists_find(&lists, 0));
    CHECK(Ice_Communicator_stringToProxy(&ic, "x @ adapter", &prxs[0]) == ICE_OK);
    CHECK(Ice_Communicator_stringToProxy(&ic, "", &prxs[1]) == ICE_OK);
    prxs[0].minor = tester.minor; /* 1.0 does not carry it */
    proxies.size = 2, proxies.data = prxs;
    CHECK(Everything_TesterPrx_echoProxies(&tester, &proxies, &proxiesBack) == ICE_OK);
    CHECK(proxiesBack.size == 2 && alike(&proxiesBack.data[0], &prxs[0]));
    CHECK(Ice_ObjectPrx_isNull(&proxiesBack.data[1]));
    return 0;
}

static int types(void) {
    static Ice_Int many[255];
    Everything_Numbers n, same, back;
    Everything_Mixed m[2], mBack;
    Everything_Mixeds list, listBack;
    Everything_Counts_Entry entries[2];
    Everything_Counts counts, countsBack;
    Everything_Leaf leaf;
    Everything_Node node, *nodeBack;
    Ice_ObjectPrx prx, prxBack, older = tester;
    Ice_String text = Ice_String_from("text"), textBack;
    Ice_Bool hasText, hasNumbers, hasInts, hasResult;
    Everything_Ints ints, intsBack;
    Ice_Int count, result;
    fill(&n);
    CHECK(Everything_TesterPrx_echoNumbers(&tester, &n, &same, &back) == ICE_OK);
    CHECK(equal(&n, &same) && equal(&n, &back));
    CHECK(Ice_Communicator_stringToProxy(
              &ic, "cat/x -f f -o:tcp -h h -p 9:opaque -t 99 -v QUI=", &prx) == ICE_OK);
    Everything_Mixed_init(&m[0]);
    m[0].text = text, m[0].small = Everything_two, m[0].wide = Everything_far;
    m[0].numbers = n, m[0].proxy = prx;
    m[1] = m[0];
    m[1].small = Everything_three;
    CHECK(Everything_TesterPrx_echoMixed(&tester, &m[0], &mBack) == ICE_OK);
    CHECK(Ice_String_equals(mBack.text, "text") && mBack.small == Everything_two);
    CHECK(mBack.wide == Everything_far && equal(&mBack.numbers, &n));
    prx.minor = tester.minor; /* 1.0 does not carry it */
    CHECK(alike(&mBack.proxy, &prx));
    list.size = 2, list.data = m;
    CHECK(Everything_TesterPrx_echoMixeds(&tester, &list, &count, &listBack) == ICE_OK);
    CHECK(count == 2 && listBack.size == 2 && listBack.data[1].small == Everything_three);
    entries[0].key = Ice_String_from("a"), entries[0].value = 1;
    entries[1].key = Ice_String_from("b"), entries[1].value = -2;
    counts.size = 2, counts.data = entries;
    CHECK(Everything_TesterPrx_echoCounts(&tester, &counts, &countsBack) == ICE_OK);
    CHECK(countsBack.size == 2 && *Everything_Counts_find(&countsBack, Ice_String_from("b")) == -2);
    CHECK(Everything_Counts_find(&countsBack, Ice_String_from("c")) == 0);
    CHECK(Everything_TesterPrx_echoProxy(&tester, &prx, &prxBack) == ICE_OK);
    CHECK(alike(&prxBack, &prx));
    CHECK(Everything_TesterPrx_echoOptionals(&tester, 4, &text, 0, 0, &hasText, &textBack,
                                             &hasNumbers, &back, &hasInts, &intsBack, &hasResult,
                                             &result) == ICE_OK);
    CHECK(hasText == tester.minor && hasResult == tester.minor && !hasNumbers && !hasInts);
    CHECK(!tester.minor || (Ice_String_equals(textBack, "text") && result == 4));
    CHECK(Ice_ObjectPrx_ice_identity(&older, "older") == ICE_OK);
    ints.data = many; /* with a size of one byte, and of five */
    for (ints.size = 254; ints.size <= 255; ++ints.size) {
        CHECK(Everything_TesterPrx_echoOptionals(&older, 4, &text, 0, &ints, &hasText, &textBack,
                                                 &hasNumbers, &back, &hasInts, &intsBack,
                                                 &hasResult, &result) == ICE_OK);
        CHECK(hasResult == tester.minor && !hasInts);
    }
    Everything_Node_init(&node);
    Everything_Leaf_init(&leaf);
    node.id = 1, node.next = &leaf.base;
    leaf.base.id = 2, leaf.base.next = &node, leaf.name = Ice_String_from("leaf");
    CHECK(Everything_TesterPrx_echoNode(&tester, &node, &nodeBack) == ICE_OK);
    CHECK(nodeBack->id == 1 && nodeBack->next->id == 2 && nodeBack->next->next == nodeBack);
    CHECK(!Everything_Leaf_cast(nodeBack) && !Everything_Leaf_cast(nodeBack->next->next));
    CHECK(Ice_String_equals(Everything_Leaf_cast(nodeBack->next)->name, "leaf"));
    return 0;
}

static int exceptions(void) {
    Everything_Tester_fail_Exception ex;
    Everything_Tester_failSliced_Exception sliced;
    Ice_Failure failure;
    Ice_ObjectPrx nobody = tester;
    CHECK(Everything_TesterPrx_fail(&tester, 0, &ex) == ICE_OK);
    CHECK(Everything_TesterPrx_fail(&tester, 1, &ex) == ICE_USER_EXCEPTION);
    CHECK(ex.type == Everything_Tester_fail_Failure);
    CHECK(Ice_String_equals(ex.u.Failure.reason, "as asked"));
    CHECK(Everything_TesterPrx_fail(&tester, 2, &ex) == ICE_USER_EXCEPTION);
    CHECK(ex.type == Everything_Tester_fail_Worse && ex.u.Worse.how == 7);
    CHECK(Ice_String_equals(ex.u.Worse.base.reason, "worse"));
    CHECK(Everything_TesterPrx_failSliced(&tester, 2, &sliced) == ICE_USER_EXCEPTION);
    ex = sliced; /* they throw the same: one type */
    CHECK(ex.type == Everything_Tester_failSliced_Worse && ex.u.Worse.how == 7);
    CHECK(Everything_TesterPrx_fail(&tester, 3, &ex) == ICE_USER_EXCEPTION);
    CHECK(ex.type == Everything_Tester_fail_Unrelated && !ex.u.Unrelated.has_hint);
    CHECK(ex.u.Unrelated.counts.size == 1 && ex.u.Unrelated.counts.data[0].value == -1);
    CHECK(Everything_TesterPrx_fail(&tester, 4, &ex) == ICE_USER_EXCEPTION);
    CHECK(ex.u.Unrelated.has_hint == tester.minor);
    CHECK(Everything_TesterPrx_fail(&tester, 1, 0) == ICE_USER_EXCEPTION);
    CHECK(Everything_TesterPrx_fail(&tester, 11, &ex) == ICE_OBJECT_NOT_EXIST);
    CHECK(Everything_TesterPrx_fail(&tester, 12, &ex) == ICE_FACET_NOT_EXIST);
    CHECK(Everything_TesterPrx_fail(&tester, 13, &ex) == ICE_OPERATION_NOT_EXIST);
    Ice_ObjectPrx_failure(&tester, &failure);
    CHECK(failure.identity.name.size != 0 && failure.operation.size != 0);
    CHECK(Everything_TesterPrx_fail(&tester, 15, &ex) == ICE_UNKNOWN_EXCEPTION);
    Ice_ObjectPrx_failure(&tester, &failure);
    CHECK(failure.unknown.size != 0);
    CHECK(Everything_TesterPrx_fail(&tester, 16, &ex) == ICE_UNKNOWN_LOCAL_EXCEPTION);
    CHECK(Ice_ObjectPrx_ice_identity(&nobody, "nobody") == ICE_OK);
    CHECK(Ice_ObjectPrx_ice_ping(&nobody) == ICE_OBJECT_NOT_EXIST);
    return 0;
}

static Ice_Status ask(Everything_WatcherPtr self, Ice_Int question, Ice_Int* result,
                      const Ice_Current* current) {
    (void)self, (void)current;
    *result = 10 * question;
    return ICE_OK;
}

static int finished;

static void completed(Everything_Tester_later_Async* self) {
    finished += self->done;
}

static int modes(void) {
    static const Ice_ContextEntry context[] = {{"a", "b"}, {"who", "me"}, {0, 0}};
    static const Everything_Watcher_Operations operations = {0, ask};
    static Ice_ObjectAdapter adapter;
    static Everything_Watcher watcher;
    Everything_Tester_later_Async calls[3];
    Ice_ObjectPrx other = tester, watcherPrx;
    Ice_Batch batch;
    Ice_Byte batchData[500];
    Ice_String text;
    Ice_Int before, after, released, i;
    CHECK(Everything_TesterPrx_sum(&tester, &before) == ICE_OK);
    Ice_ObjectPrx_ice_oneway(&other);
    for (i = 0; i < 20; ++i)
        CHECK(Everything_TesterPrx_note(&other, i) == ICE_OK);
    CHECK(Everything_TesterPrx_sum(&other, &after) == ICE_TWOWAY_ONLY);
    Ice_ObjectPrx_ice_batchOneway(&other, &batch, batchData, sizeof batchData);
    for (i = 0; i < 20; ++i)
        CHECK(Everything_TesterPrx_note(&other, 1000) == ICE_OK);
    CHECK(Ice_ObjectPrx_ice_flushBatchRequests(&other) == ICE_OK);
    do /* the server's threads may overtake each other: then one is missing for a while */
        CHECK(Everything_TesterPrx_sum(&tester, &after) == ICE_OK);
    while (after - before < 20190);
    CHECK(after - before == 20190);

    other = tester;
    Ice_ObjectPrx_ice_context(&other, context);
    CHECK(Everything_TesterPrx_context(&other, Ice_String_from("who"), &text) == ICE_OK);
    CHECK(Ice_String_equals(text, "me"));
    CHECK(Ice_ObjectPrx_ice_facet(&other, "side") == ICE_OK);
    CHECK(Everything_TesterPrx_whoAmI(&other, &text) == ICE_OK);
    CHECK(Ice_String_equals(text, "/tester -f side mode 0"));
    CHECK(Ice_ObjectPrx_ice_identity(&other, "any/whoever") == ICE_OK);
    CHECK(Everything_TesterPrx_whoAmI(&other, &text) == ICE_OK);
    CHECK(Ice_String_equals(text, "any/whoever -f  mode 0"));

    for (i = 0; i < 3; ++i) {
        calls[i].completed = completed;
        CHECK(Everything_TesterPrx_later_async(&tester, i - 1, &calls[i]) == ICE_OK);
    }
    for (released = 0; released < 3; released += i) /* likewise */
        CHECK(Everything_TesterPrx_release(&tester, &i) == ICE_OK);
    while (finished < 3)
        CHECK(Ice_Communicator_poll(&ic, 10000) == ICE_OK);
    CHECK(calls[0].status == ICE_USER_EXCEPTION && calls[1].result == 0 && calls[2].result == 2);

    /* The server calls back before it answers, on this side's connection: nobody listens here. */
    CHECK(Ice_Communicator_createObjectAdapter(&ic, "Watcher", &adapter) == ICE_OK);
    Everything_Watcher_initWith(&watcher, &operations);
    CHECK(Ice_ObjectAdapter_add(&adapter, (Ice_ObjectPtr)&watcher, "watcher") == ICE_OK);
    Ice_ObjectAdapter_activate(&adapter);
    CHECK(Ice_ObjectAdapter_createProxy(&adapter, "watcher", &watcherPrx) == ICE_OK);
    CHECK(Everything_TesterPrx_callBack(&tester, &watcherPrx, 5, &i) == ICE_OK && i == 100);
    return 0;
}

/* Results of asynchronous calls are checked while they are valid. */
static int right;

static void gotNode(Everything_Tester_echoNode_Async* self) {
    right += self->status == ICE_OK && self->result->id == 7 && self->result->next == self->result;
}

static void gotOptionals(Everything_Tester_echoOptionals_Async* self) {
    right += self->status == ICE_OK && self->has_aa == tester.minor && !self->has_bb &&
             (!tester.minor || (Ice_String_equals(self->aa, "a") && self->result == 5));
}

static void gotWorse(Everything_Tester_failSliced_Async* self) {
    right += self->status == ICE_USER_EXCEPTION &&
             self->exception.type == Everything_Tester_failSliced_Worse &&
             Ice_String_equals(self->exception.u.Worse.base.reason, "worse");
}

static int asynchronous(void) {
    static Everything_Node node;
    static Everything_Tester_echoNode_Async nodes;
    static Everything_Tester_echoOptionals_Async optionals;
    static Everything_Tester_failSliced_Async sliced;
    Ice_String a = Ice_String_from("a");
    Everything_Node_init(&node);
    node.id = 7, node.next = &node;
    right = 0;
    nodes.completed = gotNode, optionals.completed = gotOptionals, sliced.completed = gotWorse;
    CHECK(Everything_TesterPrx_echoNode_async(&tester, &node, &nodes) == ICE_OK);
    CHECK(Everything_TesterPrx_echoOptionals_async(&tester, 5, &a, 0, 0, &optionals) == ICE_OK);
    CHECK(Everything_TesterPrx_failSliced_async(&tester, 2, &sliced) == ICE_OK);
    while (!nodes.done || !optionals.done || !sliced.done)
        (void)Ice_Communicator_poll(&ic, 10000); /* sending has woken the first one */
    CHECK(right == 3);
    return 0;
}

/* Calls a class, by its own proxy and by those of its base and of its interface. */
static int classes(const char* port) {
    Everything_ShapeDisp_area_Exception ex;
    Everything_SquarePrx square;
    Everything_ShapePrx shape;
    Everything_LabelledPrx labelled;
    Everything_TesterPrx none;
    Ice_ObjectPrx base;
    Ice_String text;
    Ice_Int before, side, area;
    char line[64];
    sprintf(line, "square:tcp -h 127.0.0.1 -p %.8s", port);
    CHECK(Ice_Communicator_stringToProxy(&ic, line, &base) == ICE_OK);
    base.timeoutMs = 120000;
    CHECK(Everything_TesterPrx_checkedCast(&none, &base) == ICE_OK && Ice_ObjectPrx_isNull(&none));
    CHECK(Everything_SquarePrx_checkedCast(&square, &base) == ICE_OK);
    CHECK(Everything_ShapePrx_checkedCast(&shape, &base) == ICE_OK);
    CHECK(Everything_LabelledPrx_checkedCast(&labelled, &base) == ICE_OK);
    CHECK(!Ice_ObjectPrx_isNull(&square) && !Ice_ObjectPrx_isNull(&labelled));
    CHECK(Ice_ObjectPrx_ice_id(&square, &text) == ICE_OK);
    CHECK(Ice_String_equals(text, Everything_Square_ice_staticId));
    CHECK(Everything_SquarePrx_grow(&square, 0, &before) == ICE_OK);
    CHECK(Everything_SquarePrx_grow(&square, 3, &side) == ICE_OK && side == before + 3);
    CHECK(Everything_SquarePrx_area(&square, 2, &area, &ex) == ICE_OK && area == 2 * side * side);
    CHECK(Everything_ShapePrx_area(&shape, -1, &area, &ex) == ICE_USER_EXCEPTION);
    CHECK(ex.type == Everything_ShapeDisp_area_Failure);
    CHECK(Ice_String_equals(ex.u.Failure.reason, "negative"));
    CHECK(Everything_LabelledPrx_label(&labelled, &text) == ICE_OK);
    CHECK(Ice_String_equals(text, "square"));
    return 0;
}

static int volume(int slow) {
    static Ice_Byte many[8100];
    Everything_Bytes out, in;
    Ice_Int size, i;
    for (size = 1; size <= (slow ? 1000 : 8000); size = size * 2 + 1) {
        out.size = size, out.data = many;
        memset(many, size & 0xFF, sizeof many);
        CHECK(Everything_TesterPrx_echoBytes(&tester, &out, &in) == ICE_OK);
        CHECK(in.size == size && memcmp(in.data, many, (size_t)size) == 0);
    }
    out.size = sizeof many;
    CHECK(slow || Everything_TesterPrx_echoBytes(&tester, &out, &in) == ICE_OK);
    for (i = 0; i < (slow ? 20 : 1000); ++i)
        CHECK(Everything_TesterPrx_sum(&tester, &size) == ICE_OK);
    return 0;
}

/* The relay cuts every connection after some bytes; a call either answers or fails as lost. */
static int lost(void) {
    static Ice_Byte many[200];
    Everything_Bytes out, in;
    int answered = 0, failed = 0, i;
    Ice_Status status;
    out.size = sizeof many, out.data = many;
    for (i = 0; i < 60; ++i) {
        status = Everything_TesterPrx_echoBytes(&tester, &out, &in);
        CHECK(status == ICE_CONNECTION_LOST || (status == ICE_OK && in.size == out.size));
        answered += status == ICE_OK;
        failed += status != ICE_OK;
    }
    printf("client: %d calls answered, %d lost with their connection\n", answered, failed);
    CHECK(answered >= 20 && failed >= 3);
    while (Everything_TesterPrx_shutdown(&tester) != ICE_OK)
        if (Ice_ObjectPrx_ice_ping(&tester) == ICE_CONNECTION_LOST &&
            Ice_ObjectPrx_ice_ping(&tester) == ICE_CONNECTION_LOST)
            break; /* its answer was cut off, and the connection has gone */
    return 0;
}

int main(int argc, char** argv) {
    Ice_ObjectPrx base;
    char text[128];
    Ice_Byte minor;
    int slow = argc > 2 && strcmp(argv[1], "slow") == 0;
    if (argc < 2) {
        fprintf(stderr, "usage: client [slow|lost] port\n");
        return 2;
    }
    Ice_initialize(&ic);
    CHECK(TcpEndpoint_init(&ic, &tcp) == ICE_OK);
    sprintf(text, "tester:tcp -h 127.0.0.1 -p %.8s", argv[argc - 1]);
    CHECK(Ice_Communicator_stringToProxy(&ic, text, &base) == ICE_OK);
    base.timeoutMs = 120000;
    Ice_ObjectPrx_setReplyBuffer(&base, room, sizeof room);
    if (argc > 2 && strcmp(argv[1], "lost") == 0) {
        tester = base;
        return lost();
    }
    CHECK(Everything_WatcherPrx_checkedCast(&tester, &base) == ICE_OK);
    CHECK(Ice_ObjectPrx_isNull(&tester));
    CHECK(Everything_TesterPrx_checkedCast(&tester, &base) == ICE_OK);
    for (minor = 0; minor < 2; ++minor) {
        Ice_ObjectPrx_ice_encodingVersion(&tester, minor);
        if (types() || dictionaries() || exceptions() || asynchronous())
            return 1;
    }
    if (modes() || classes(argv[argc - 1]) || volume(slow))
        return 1;
    CHECK(Everything_TesterPrx_shutdown(&tester) == ICE_OK);
    Ice_Communicator_destroy(&ic, 2000);
    TcpEndpoint_destroy(&tcp);
    printf("client: everything as expected\n");
    return 0;
}
