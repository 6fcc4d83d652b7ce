/* SPDX-License-Identifier: MIT
 *
 * slicing_objects_client: calls the server of ZeroC's suite "slicing/objects".
 */
#include "Test.h"
#include "client.h"

#define CALL(operation, arguments) CHECK(Test_TestIntfPrx_##operation arguments == ICE_OK)

static Test_TestIntfPrx prx;

/* D1, and D2, which is unknown here and comes as a B, refer to each other. */
static void isPair(const Test_B* b1, const Test_B* b2) {
    const Test_D1* d1 = Test_D1_cast(b1);
    CHECK(d1 && d1->pd1 == b2 && b1->pb == b2 && b2->pb == b1 && !Test_D1_cast(b2));
    SAME(b1->sb, "D1.sb");
    SAME(b2->sb, "D2.sb");
}

static void known(void) {
    Ice_Value* any;
    Test_SBase* s;
    Test_SBSKnownDerived* d;
    Test_B *b, *p1, *p2;
    Test_D1* d1;
    Test_Forward* forward;
    CALL(SBaseAsObject, (&prx, &any));
    SAME(Test_SBase_cast(any)->sb, "SBase.sb");
    CALL(SBaseAsSBase, (&prx, &s));
    SAME(s->sb, "SBase.sb");
    CALL(SBSKnownDerivedAsSBase, (&prx, &s));
    SAME(Test_SBSKnownDerived_cast(s)->sbskd, "SBSKnownDerived.sbskd");
    CALL(SBSKnownDerivedAsSBSKnownDerived, (&prx, &d));
    SAME(d->base.sb, "SBSKnownDerived.sb");
    CALL(SBSUnknownDerivedAsSBase, (&prx, &s));
    SAME(s->sb, "SBSUnknownDerived.sb");
    CHECK(Test_TestIntfPrx_SBSUnknownDerivedAsSBaseCompact(&prx, &s) ==
          (Suite_minor ? ICE_MARSHAL : ICE_OK));
    CALL(oneElementCycle, (&prx, &b));
    CHECK(b->pb == b);
    CALL(twoElementCycle, (&prx, &b));
    CHECK(b->pb != b && b->pb->pb == b);
    CALL(D1AsB, (&prx, &b));
    isPair(b, b->pb);
    CALL(D1AsD1, (&prx, &d1));
    isPair(&d1->base, d1->pd1);
    CALL(D2AsB, (&prx, &b));
    isPair(b->pb, b);
    CALL(paramTest1, (&prx, &p1, &p2));
    isPair(p1, p2);
    CALL(paramTest2, (&prx, &p2, &p1));
    isPair(p1, p2);
    CALL(paramTest3, (&prx, &p1, &p2, &b));
    SAME(p1->sb, "D2.sb (p1 1)");
    SAME(Test_D1_cast(b)->sd1, "D1.sd2 (p2 2)");
    CALL(paramTest4, (&prx, &p1, &b));
    SAME(p1->sb, "D4.sb (1)");
    SAME(b->sb, "B.sb (2)");
    CALL(returnTest1, (&prx, &p1, &p2, &b));
    isPair(b, p2);
    CALL(useForward, (&prx, &forward));
    CHECK(forward->h->f == forward);
}

static void sent(void) {
    static Test_D1 d[10];
    static Test_SS1 ss1;
    static Test_SS2 ss2;
    static Test_BDict_Entry entries[10];
    static Test_PDerived preserved;
    static Test_PNode node;
    Test_B *list[2], *b;
    Test_SS3 ss3;
    Test_BDict in, out, back;
    Test_PBase* p;
    Test_PNode* n;
    Ice_Int i;
    for (i = 0; i < 10; ++i) {
        Test_D1_init(&d[i]);
        d[i].base.sb = Ice_String_from("B1.sb"), d[i].base.pb = d[i].pd1 = &d[i].base;
        entries[i].key = i, entries[i].value = &d[i].base;
    }
    CALL(returnTest3, (&prx, &d[0].base, &d[1].base, &b));
    CHECK(Test_D1_cast(b)->pd1 == b);
    Test_SS1_init(&ss1), Test_SS2_init(&ss2);
    list[0] = &d[0].base, list[1] = &d[1].base;
    ss1.s.size = ss2.s.size = 2, ss1.s.data = ss2.s.data = list;
    CALL(sequenceTest, (&prx, &ss1, &ss2, &ss3));
    CHECK(ss3.c1->s.size == 2 && ss3.c2->s.data[1] == ss3.c1->s.data[1]);
    in.size = 10, in.data = entries;
    CALL(dictionaryTest, (&prx, &in, &out, &back));
    CHECK(out.size == 10 && back.size == 10);
    SAME((*Test_BDict_find(&back, 180))->sb, "D1.180");
    CHECK((*Test_BDict_find(&back, 180))->pb == *Test_BDict_find(&back, 160));
    Test_PDerived_init(&preserved), Test_PNode_init(&node);
    preserved.base.base.pi = 3, preserved.pb = &preserved.base.base, node.next = &node;
    CALL(exchangePBase, (&prx, preserved.pb, &p));
    CHECK(p->pi == 3 && Test_PDerived_cast(p)->pb == p);
    CALL(exchangePNode, (&prx, &node, &n));
    CHECK(n->next == n);
}

/* Unknown slices go back whole, in 1.1. */
static void unknown(void) {
    Ice_Value* any;
    Test_Preserved* p;
    CHECK(Test_TestIntfPrx_SUnknownAsObject(&prx, &any) == (Suite_minor ? ICE_OK : ICE_MARSHAL));
    if (Suite_minor)
        CALL(checkSUnknown, (&prx, any));
    CALL(PBSUnknownAsPreserved, (&prx, &p));
    CHECK(p->base.pi == 5);
    CALL(checkPBSUnknown, (&prx, p));
    CALL(PBSUnknownAsPreservedWithGraph, (&prx, &p));
    CALL(checkPBSUnknownWithGraph, (&prx, p));
    CALL(PBSUnknown2AsPreservedWithGraph, (&prx, &p));
    CALL(checkPBSUnknown2WithGraph, (&prx, p));
}

static void exceptions(void) {
    Test_TestIntf_throwBaseAsBase_Exception ex;
    Test_TestIntf_throwDerivedAsDerived_Exception derived;
    Test_TestIntf_throwPreservedException_Exception kept;
    CHECK(Test_TestIntfPrx_throwBaseAsBase(&prx, &ex) == ICE_USER_EXCEPTION);
    CHECK(ex.type == Test_TestIntf_throwBaseAsBase_BaseException);
    CHECK(ex.u.BaseException.pb->pb == ex.u.BaseException.pb);
    CHECK(Test_TestIntfPrx_throwDerivedAsBase(&prx, &ex) == ICE_USER_EXCEPTION);
    CHECK(ex.type == Test_TestIntf_throwDerivedAsBase_DerivedException);
    SAME(ex.u.DerivedException.pd1->sd1, "sd2");
    CHECK(Test_TestIntfPrx_throwDerivedAsDerived(&prx, &derived) == ICE_USER_EXCEPTION);
    SAME(derived.u.DerivedException.base.pb->sb, "sb1");
    CHECK(Test_TestIntfPrx_throwUnknownDerivedAsBase(&prx, &ex) == ICE_USER_EXCEPTION);
    CHECK(ex.type == Test_TestIntf_throwUnknownDerivedAsBase_BaseException);
    SAME(ex.u.BaseException.pb->sb, "sb d2");
    CHECK(Test_TestIntfPrx_throwPreservedException(&prx, &kept) == ICE_USER_EXCEPTION);
    CHECK(kept.type == Test_TestIntf_throwPreservedException_PreservedException);
}

void Suite_call(Ice_CommunicatorPtr ic) {
    Ice_ObjectPrx base = Suite_proxy(ic, "Test");
    CAST(Test_TestIntf, &prx, &base);
    known();
    sent();
    unknown();
    exceptions();
    CALL(shutdown, (&prx));
}
