/* SPDX-License-Identifier: MIT
 *
 * facets_client: calls the server of ZeroC's suite "facets".
 */
#include "Test.h"
#include "client.h"

#define SAYS(Type, operation, prx, text)                             \
    do {                                                             \
        Ice_String result;                                           \
        CHECK(Test_##Type##Prx_##operation(prx, &result) == ICE_OK); \
        SAME(result, text);                                          \
    } while (0)

static Ice_ObjectPrx facet(Ice_ObjectPrx prx, const char* name) {
    CHECK(Ice_ObjectPrx_ice_facet(&prx, name) == ICE_OK);
    return prx;
}

void Suite_call(Ice_CommunicatorPtr ic) {
    Ice_ObjectPrx base = Suite_proxy(ic, "d"), abcd = facet(base, "facetABCD"),
                  ef = facet(base, "facetEF"), gh = facet(base, "facetGH"),
                  none = facet(base, "bogusfacet");
    Test_DPrx d;
    Test_FPrx f;
    Test_HPrx h;
    CHECK(Test_DPrx_checkedCast(&d, &base) == ICE_OK && !Ice_ObjectPrx_isNull(&d));
    SAYS(D, callA, &d, "A");
    SAYS(D, callB, &d, "B");
    SAYS(D, callC, &d, "C");
    SAYS(D, callD, &d, "D");
    CHECK(Test_DPrx_checkedCast(&d, &abcd) == ICE_OK && !Ice_ObjectPrx_isNull(&d));
    SAYS(D, callA, &d, "A");
    SAYS(D, callD, &d, "D");
    CHECK(Test_FPrx_checkedCast(&f, &ef) == ICE_OK && !Ice_ObjectPrx_isNull(&f));
    SAYS(F, callE, &f, "E");
    SAYS(F, callF, &f, "F");
    CHECK(Test_DPrx_checkedCast(&d, &ef) == ICE_OK && Ice_ObjectPrx_isNull(&d));
    CHECK(Ice_ObjectPrx_ice_ping(&none) == ICE_FACET_NOT_EXIST);
    CHECK(Test_HPrx_checkedCast(&h, &gh) == ICE_OK && !Ice_ObjectPrx_isNull(&h));
    SAYS(H, callG, &h, "G");
    SAYS(H, callH, &h, "H");
    CHECK(Test_HPrx_shutdown(&h) == ICE_OK);
}
