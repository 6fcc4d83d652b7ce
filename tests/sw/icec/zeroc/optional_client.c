/* SPDX-License-Identifier: MIT
 *
 * optional_client: calls the server of ZeroC's suite "optional".
 */
#include "Test.h"
#include "client.h"

#include <string.h>

/* The compared part of a value. */
#define ITSELF(v) v
#define HIGH(v) v.high
#define SIZE(v) v.size
#define MEMBER(v) v.m
#define TEXT(v) v.m.size

/* A sent optional comes back twice where the encoding has optionals, else not. */
#define ECHO(operation, Type, member, value)                                                       \
    do {                                                                                           \
        Type in, out, result;                                                                      \
        Ice_Bool hasOut, hasResult;                                                                \
        memset(&in, 0, sizeof in);                                                                 \
        member(in) = value;                                                                        \
        CHECK(Test_InitialPrx_##operation(&prx, &in, &hasOut, &out, &hasResult, &result) ==        \
              ICE_OK);                                                                             \
        CHECK(hasOut == Suite_minor && hasResult == Suite_minor);                                  \
        CHECK(!Suite_minor || (member(out) == value && member(result) == value));                  \
        CHECK(Test_InitialPrx_##operation(&prx, 0, &hasOut, &out, &hasResult, &result) == ICE_OK); \
        CHECK(!hasOut && !hasResult);                                                              \
    } while (0)

static Test_InitialPrx prx;

static void exceptions(void) {
    Test_Initial_opOptionalException_Exception ex;
    static Test_OneOptional one;
    static const Test_OneOptional* const p = &one;
    const Ice_Int a = 30;
    const Ice_String b = Ice_String_from("test");
    Test_OneOptional_init(&one);
    one.has_a = 1, one.a = 53;
    CHECK(Test_InitialPrx_opOptionalException(&prx, 0, 0, 0, &ex) == ICE_USER_EXCEPTION);
    CHECK(ex.type == Test_Initial_opOptionalException_OptionalException);
    CHECK(!ex.u.OptionalException.has_a && !ex.u.OptionalException.has_b);
    CHECK(Test_InitialPrx_opDerivedException(&prx, &a, &b, &p, &ex) == ICE_USER_EXCEPTION);
    CHECK(ex.type == Test_Initial_opDerivedException_DerivedException);
    SAME(ex.u.DerivedException.d1, "d1");
    SAME(ex.u.DerivedException.d2, "d2");
    if (Suite_minor) {
        CHECK(ex.u.DerivedException.base.a == 30 && ex.u.DerivedException.has_o2);
        SAME(ex.u.DerivedException.ss, "test");
    }
    CHECK(Test_InitialPrx_opRequiredException(&prx, &a, &b, &p, &ex) == ICE_USER_EXCEPTION);
    CHECK(ex.type == Test_Initial_opRequiredException_RequiredException);
    CHECK(!Suite_minor || ex.u.RequiredException.o2->a == 53);
}

void Suite_call(Ice_CommunicatorPtr ic) {
    Ice_ObjectPrx base = Suite_proxy(ic, "initial");
    static Test_MultiOptional multi;
    static Test_G g;
    static Test_G1 g1;
    static Test_G2 g2;
    Ice_Value* any;
    Test_OneOptional* one;
    Test_G* same;
    Ice_Bool has;
    Ice_Int p2 = 2, p4, p5, p6;
    CAST(Test_Initial, &prx, &base);
    ECHO(opByte, Ice_Byte, ITSELF, 56);
    ECHO(opBool, Ice_Bool, ITSELF, 1);
    ECHO(opShort, Ice_Short, ITSELF, 56);
    ECHO(opInt, Ice_Int, ITSELF, -56);
    ECHO(opLong, Ice_Long, HIGH, -1);
    ECHO(opFloat, Ice_Float, ITSELF, 1.0F);
    ECHO(opDouble, Ice_Double, ITSELF, 1.5);
    ECHO(opString, Ice_String, SIZE, 0);
    ECHO(opMyEnum, Test_MyEnum, ITSELF, Test_MyEnumMember);
    ECHO(opSmallStruct, Test_SmallStruct, MEMBER, 56);
    ECHO(opFixedStruct, Test_FixedStruct, MEMBER, 56);
    ECHO(opVarStruct, Test_VarStruct, TEXT, 0);
    ECHO(opByteSeq, Test_ByteSeq, SIZE, 0);
    ECHO(opStringSeq, Test_StringSeq, SIZE, 0);
    ECHO(opIntIntDict, Test_IntIntDict, SIZE, 0);
    Test_MultiOptional_init(&multi);
    multi.has_d = multi.has_h = multi.has_k = 1;
    multi.d = 17, multi.h = Ice_String_from("h"), multi.k = &multi;
    CHECK(Test_InitialPrx_pingPong(&prx, &multi.ice_value, &any) == ICE_OK);
    CHECK(Test_MultiOptional_cast(any)->has_d == Suite_minor &&
          !Test_MultiOptional_cast(any)->has_e);
    if (Suite_minor) {
        CHECK(Test_MultiOptional_cast(any)->d == 17 &&
              &Test_MultiOptional_cast(any)->k->ice_value == any);
        SAME(Test_MultiOptional_cast(any)->h, "h");
    }
    Test_G_init(&g), Test_G1_init(&g1), Test_G2_init(&g2);
    g1.a = Ice_String_from("gg1"), g2.a.low = 20;
    g.has_gg1Opt = g.has_gg2Opt = 1;
    g.gg1 = g.gg1Opt = &g1, g.gg2 = g.gg2Opt = &g2;
    CHECK(Test_InitialPrx_opG(&prx, &g, &same) == ICE_OK && same->gg2->a.low == 20);
    CHECK(same->has_gg1Opt == Suite_minor && (!Suite_minor || same->gg1Opt == same->gg1));
    CHECK(Test_InitialPrx_returnOptionalClass(&prx, 1, &has, &one) == ICE_OK && has == Suite_minor);
    CHECK(!Suite_minor || one->a == 53);
    CHECK(Test_InitialPrx_opRequiredAfterOptional(&prx, 1, &p2, 3, &p4, &has, &p5, &p6) == ICE_OK);
    CHECK(p4 == 1 && has == Suite_minor && p6 == 3 && (!has || p5 == 2));
    exceptions();
    CHECK(Test_InitialPrx_shutdown(&prx) == ICE_OK);
}
