/* SPDX-License-Identifier: MIT
 *
 * objects_client: calls the server of ZeroC's suite "objects".
 */
#include "Forward.h"
#include "Test.h"
#include "client.h"

#include <string.h>

#define GET(operation, v) CHECK(Test_InitialPrx_##operation(&prx, v) == ICE_OK)
#define ECHO(operation, in, out, result) \
    CHECK(Test_InitialPrx_##operation(&prx, in, out, result) == ICE_OK)

static Test_InitialPrx prx;

static void isB1(const Test_B* b) {
    const Test_B* b2 = Test_B_cast(b->theA);
    CHECK(b->base.theB == b && !b->base.theC);
    CHECK(b2 && b2->theA == &b2->base && b2->base.theB == b && b2->base.theC->theB == b2);
    CHECK(b->base.preMarshalInvoked || b2->base.preMarshalInvoked);
}

static void graphs(void) {
    Test_B *b1, *b2;
    Test_C* c;
    Test_D* d;
    Test_E* e;
    Test_F* f;
    Test_Inner_A* inner;
    Test_Inner_Sub_A* sub;
    GET(getB1, &b1);
    isB1(b1);
    GET(getB2, &b2);
    isB1(b2->base.theB);
    GET(getC, &c);
    isB1(c->theB->base.theB);
    GET(getD, &d);
    isB1(Test_B_cast(d->theA));
    CHECK(d->theA == &d->theB->base.theB->base && !d->theC);
    GET(getE, &e);
    CHECK(e->i == 1);
    SAME(e->s, "hello");
    GET(getF, &f);
    CHECK(f->e1 == f->e2 && f->e2->i == 1);
    CHECK(Test_InitialPrx_getAll(&prx, &b1, &b2, &c, &d) == ICE_OK);
    isB1(b1);
    CHECK(b1->theA == &b2->base && c->theB == b2 && d->theB == b2 && d->theA == &b1->base);
    GET(getMB, &b1);
    isB1(b1);
    GET(getAMDMB, &b1);
    isB1(b1);
    GET(getInnerA, &inner);
    isB1(Test_B_cast(inner->theA));
    GET(getInnerSubA, &sub);
    isB1(Test_B_cast(sub->theA->theA));
}

static void values(void) {
    static Test_L l;
    static Test_Base base;
    static Test_D1 d1;
    static Test_A1 a[2];
    Ice_Value *v, *w, *list[2];
    Test_ValueSeq seq, seqOut, seqBack;
    Test_ValueMap_Entry entry;
    Test_ValueMap map, mapOut, mapBack;
    Test_Base* bases[2];
    Test_BaseSeq bs, bsOut, bsBack;
    Test_K* k;
    Test_D1* d1Back;
    Test_Compact* compact;
    GET(getI, &v);
    CHECK(v && strcmp(v->type->id, "::Test::I") == 0);
    GET(getJ, &v);
    CHECK(v && strcmp(v->type->id, "::Test::J") == 0);
    GET(getH, &v);
    CHECK(Test_H_cast(v) != 0);
    GET(getK, &k);
    SAME(Test_L_cast(k->value)->data, "l");
    Test_L_init(&l), Test_Base_init(&base), Test_D1_init(&d1);
    Test_A1_init(&a[0]), Test_A1_init(&a[1]);
    l.data = Ice_String_from("L"), base.str = Ice_String_from("base");
    ECHO(opValue, &l.ice_value, &v, &w);
    SAME(Test_L_cast(v)->data, "L");
    CHECK(v == w);
    list[0] = &l.ice_value, list[1] = 0, seq.size = 2, seq.data = list;
    ECHO(opValueSeq, &seq, &seqOut, &seqBack);
    CHECK(seqOut.size == 2 && seqBack.data[0] == seqOut.data[0] && !seqBack.data[1]);
    entry.key = Ice_String_from("l"), entry.value = &l.ice_value, map.size = 1, map.data = &entry;
    ECHO(opValueMap, &map, &mapOut, &mapBack);
    SAME(Test_L_cast(*Test_ValueMap_find(&mapBack, entry.key))->data, "L");
    bases[0] = bases[1] = &base, bs.size = 2, bs.data = bases;
    ECHO(opBaseSeq, &bs, &bsOut, &bsBack);
    SAME(bsBack.data[1]->str, "base");
    d1.base.a1 = d1.a3 = &a[0], d1.base.a2 = d1.a4 = &a[1], a[0].name = Ice_String_from("a1");
    CHECK(Test_InitialPrx_getD1(&prx, &d1, &d1Back) == ICE_OK && d1Back->a3 == d1Back->base.a1);
    SAME(d1Back->a3->name, "a1");
    GET(getCompact, &compact);
    CHECK(Test_CompactExt_cast(compact) != 0);
}

void Suite_call(Ice_CommunicatorPtr ic) {
    Ice_ObjectPrx object = Suite_proxy(ic, "initial");
    Test_Initial_throwEDerived_Exception ex;
    Test_Initial_throwInnerEx_Exception inner;
    Test_Initial_throwInnerSubEx_Exception sub;
    static Test_F1 f1;
    static Test_F3 f3;
    Test_F1 *f1Out, *f1Back;
    Test_F3 *f3Out, *f3Back;
    CAST(Test_Initial, &prx, &object);
    graphs();
    values();
    CHECK(Test_InitialPrx_throwEDerived(&prx, &ex) == ICE_USER_EXCEPTION);
    SAME(ex.u.EDerived.base.a2->name, "a2");
    SAME(ex.u.EDerived.a4->name, "a4");
    CHECK(Test_InitialPrx_throwInnerEx(&prx, &inner) == ICE_USER_EXCEPTION);
    SAME(inner.u.Ex.reason, "Inner::Ex");
    CHECK(Test_InitialPrx_throwInnerSubEx(&prx, &sub) == ICE_USER_EXCEPTION);
    SAME(sub.u.Ex.reason, "Inner::Sub::Ex");
    Test_F1_init(&f1), Test_F3_init(&f3);
    f1.name = Ice_String_from("F11"), f3.f1 = &f1, f3.f2 = prx;
    ECHO(opF1, &f1, &f1Out, &f1Back);
    SAME(f1Back->name, "F11");
    SAME(f1Out->name, "F12");
    ECHO(opF3, &f3, &f3Out, &f3Back);
    CHECK(Suite_alike(&f3Back->f2, &prx));
    SAME(f3Out->f1->name, "F12");
    CHECK(Test_InitialPrx_shutdown(&prx) == ICE_OK);
}
