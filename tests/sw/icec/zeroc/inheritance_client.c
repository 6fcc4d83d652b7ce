/* SPDX-License-Identifier: MIT
 *
 * inheritance_client: calls the server of ZeroC's suite "inheritance".
 */
#include "Test.h"
#include "client.h"

#define GET(operation, prx) CHECK(Test_InitialPrx_##operation(&initial, prx) == ICE_OK)
/* The operation returns the proxy that it is given. */
#define PASSES(operation, self, prx)                                                    \
    do {                                                                                \
        Ice_ObjectPrx out;                                                              \
        CHECK(operation(self, prx, &out) == ICE_OK && Ice_ObjectPrx_equals(&out, prx)); \
    } while (0)

void Suite_call(Ice_CommunicatorPtr ic) {
    Ice_ObjectPrx base = Suite_proxy(ic, "initial");
    Test_InitialPrx initial;
    Ice_ObjectPrx ca, cb, cc, cd, ia, ib1, ib2, i;
    CAST(Test_Initial, &initial, &base);
    GET(caop, &ca);
    GET(cbop, &cb);
    GET(ccop, &cc);
    GET(cdop, &cd);
    GET(iaop, &ia);
    GET(ib1op, &ib1);
    GET(ib2op, &ib2);
    GET(icop, &i);
    CAST(Test_MA_IA, &i, &i);
    PASSES(Test_MA_CAPrx_caop, &ca, &ca);
    PASSES(Test_MA_CAPrx_caop, &cb, &cc);
    PASSES(Test_MB_CBPrx_caop, &cb, &ca);
    PASSES(Test_MB_CBPrx_cbop, &cc, &cb);
    PASSES(Test_MA_CCPrx_caop, &cc, &cc);
    PASSES(Test_MA_CCPrx_cbop, &cc, &cc);
    PASSES(Test_MA_CCPrx_ccop, &cd, &cc);
    PASSES(Test_MA_CDPrx_cdop, &cd, &cd);
    PASSES(Test_MA_CDPrx_ib2op, &cd, &cd);
    PASSES(Test_MA_IAPrx_iaop, &ia, &i);
    PASSES(Test_MB_IB1Prx_iaop, &ib1, &ib2);
    PASSES(Test_MB_IB1Prx_ib1op, &i, &ib1);
    PASSES(Test_MB_IB2Prx_ib2op, &ib2, &i);
    PASSES(Test_MA_ICPrx_iaop, &i, &ia);
    PASSES(Test_MA_ICPrx_ib1op, &i, &i);
    PASSES(Test_MA_ICPrx_icop, &i, &i);
    CHECK(Test_MB_IB2Prx_checkedCast(&ib1, &ib1) == ICE_OK && Ice_ObjectPrx_isNull(&ib1));
    CHECK(Test_InitialPrx_shutdown(&initial) == ICE_OK);
}
