/* SPDX-License-Identifier: MIT
 *
 * slicing_exceptions_client: calls the server of ZeroC's suite "slicing/exceptions", which throws
 * exceptions unknown to this side.
 */
#include "Test.h"
#include "client.h"

/* The exception that arrives is `Type`, with this text in its member. */
#define THROWS(operation, Type, member, text)                                 \
    do {                                                                      \
        Test_TestIntf_##operation##_Exception ex;                             \
        ex.type = Test_TestIntf_##operation##_none;                           \
        CHECK(Test_TestIntfPrx_##operation(&prx, &ex) == ICE_USER_EXCEPTION); \
        CHECK(ex.type == Test_TestIntf_##operation##_##Type);                 \
        if (ex.type == Test_TestIntf_##operation##_##Type)                    \
            SAME(ex.u.Type.member, text);                                     \
    } while (0)

void Suite_call(Ice_CommunicatorPtr ic) {
    Ice_ObjectPrx base = Suite_proxy(ic, "Test");
    Test_TestIntfPrx prx;
    Test_TestIntf_unknownMostDerived2AsBaseCompact_Exception compact;
    CHECK(Test_TestIntfPrx_checkedCast(&prx, &base) == ICE_OK && !Ice_ObjectPrx_isNull(&prx));
    THROWS(baseAsBase, Base, b, "Base.b");
    THROWS(unknownDerivedAsBase, Base, b, "UnknownDerived.b");
    THROWS(knownDerivedAsBase, KnownDerived, kd, "KnownDerived.kd");
    THROWS(knownDerivedAsKnownDerived, KnownDerived, base.b, "KnownDerived.b");
    THROWS(unknownIntermediateAsBase, Base, b, "UnknownIntermediate.b");
    THROWS(knownIntermediateAsBase, KnownIntermediate, ki, "KnownIntermediate.ki");
    THROWS(knownMostDerivedAsBase, KnownMostDerived, kmd, "KnownMostDerived.kmd");
    THROWS(knownIntermediateAsKnownIntermediate, KnownIntermediate, ki, "KnownIntermediate.ki");
    THROWS(knownMostDerivedAsKnownIntermediate, KnownMostDerived, kmd, "KnownMostDerived.kmd");
    THROWS(knownMostDerivedAsKnownMostDerived, KnownMostDerived, kmd, "KnownMostDerived.kmd");
    THROWS(unknownMostDerived1AsBase, KnownIntermediate, ki, "UnknownMostDerived1.ki");
    THROWS(unknownMostDerived1AsKnownIntermediate, KnownIntermediate, ki, "UnknownMostDerived1.ki");
    THROWS(unknownMostDerived2AsBase, Base, b, "UnknownMostDerived2.b");
    CHECK(Test_TestIntfPrx_unknownMostDerived2AsBaseCompact(&prx, &compact) ==
          (Suite_minor == 0 ? ICE_USER_EXCEPTION : ICE_UNKNOWN_USER_EXCEPTION));
    THROWS(knownPreservedAsBase, KnownPreservedDerived, kpd, "derived");
    THROWS(knownPreservedAsKnownPreserved, KnownPreservedDerived, base.kp, "preserved");
    THROWS(unknownPreservedAsBase, KnownPreservedDerived, kpd, "derived");
    THROWS(unknownPreservedAsKnownPreserved, KnownPreservedDerived, kpd, "derived");
    CHECK(Test_TestIntfPrx_shutdown(&prx) == ICE_OK);
}
