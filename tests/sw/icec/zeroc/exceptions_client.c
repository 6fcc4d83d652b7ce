/* SPDX-License-Identifier: MIT
 *
 * exceptions_client: calls the server of ZeroC's suite "exceptions".
 */
#include "Test.h"
#include "client.h"

#define THROWS(operation, arguments, Type)                              \
    CHECK(Test_ThrowerPrx_##operation arguments == ICE_USER_EXCEPTION); \
    CHECK(ex.operation.type == Test_Thrower_##operation##_##Type)

static void checkC(const Test_C* v) {
    CHECK(v->base.base.aMem == 1 && v->base.bMem == 2 && v->cMem == 3);
}

void Suite_call(Ice_CommunicatorPtr ic) {
    Ice_ObjectPrx base = Suite_proxy(ic, "thrower"), stranger = Suite_proxy(ic, "nobody");
    Test_ThrowerPrx prx;
    Test_WrongOperationPrx wrong;
    union {
        Test_Thrower_throwAasA_Exception throwAasA;
        Test_Thrower_throwAorDasAorD_Exception throwAorDasAorD;
        Test_Thrower_throwBasA_Exception throwBasA;
        Test_Thrower_throwCasA_Exception throwCasA;
        Test_Thrower_throwBasB_Exception throwBasB;
        Test_Thrower_throwCasB_Exception throwCasB;
        Test_Thrower_throwCasC_Exception throwCasC;
        Test_Thrower_throwModA_Exception throwModA;
    } ex;
    CHECK(Test_ThrowerPrx_checkedCast(&prx, &base) == ICE_OK && !Ice_ObjectPrx_isNull(&prx));
    THROWS(throwAasA, (&prx, 1, &ex.throwAasA), A);
    CHECK(ex.throwAasA.u.A.aMem == 1);
    THROWS(throwAorDasAorD, (&prx, 1, &ex.throwAorDasAorD), A);
    CHECK(ex.throwAorDasAorD.u.A.aMem == 1);
    THROWS(throwAorDasAorD, (&prx, -1, &ex.throwAorDasAorD), D);
    CHECK(ex.throwAorDasAorD.u.D.dMem == -1);
    THROWS(throwBasA, (&prx, 1, 2, &ex.throwBasA), B);
    CHECK(ex.throwBasA.u.B.base.aMem == 1 && ex.throwBasA.u.B.bMem == 2);
    THROWS(throwBasB, (&prx, 1, 2, &ex.throwBasB), B);
    CHECK(ex.throwBasB.u.B.base.aMem == 1 && ex.throwBasB.u.B.bMem == 2);
    THROWS(throwCasA, (&prx, 1, 2, 3, &ex.throwCasA), C);
    checkC(&ex.throwCasA.u.C);
    THROWS(throwCasB, (&prx, 1, 2, 3, &ex.throwCasB), C);
    checkC(&ex.throwCasB.u.C);
    THROWS(throwCasC, (&prx, 1, 2, 3, &ex.throwCasC), C);
    checkC(&ex.throwCasC.u.C);
    THROWS(throwModA, (&prx, 1, 2, &ex.throwModA), A);
    CHECK(ex.throwModA.u.A.base.aMem == 1 && ex.throwModA.u.A.a2Mem == 2);
    CHECK(Test_ThrowerPrx_throwUndeclaredA(&prx, 1) == ICE_UNKNOWN_USER_EXCEPTION);
    CHECK(Test_ThrowerPrx_throwUndeclaredB(&prx, 1, 2) == ICE_UNKNOWN_USER_EXCEPTION);
    CHECK(Test_ThrowerPrx_throwUndeclaredC(&prx, 1, 2, 3) == ICE_UNKNOWN_USER_EXCEPTION);
    CHECK(Test_ThrowerPrx_throwLocalException(&prx) == ICE_UNKNOWN_LOCAL_EXCEPTION);
    CHECK(Test_ThrowerPrx_throwLocalExceptionIdempotent(&prx) == ICE_UNKNOWN_LOCAL_EXCEPTION);
    CHECK(Test_ThrowerPrx_throwNonIceException(&prx) == ICE_UNKNOWN_EXCEPTION);
    CHECK(Test_ThrowerPrx_throwAfterResponse(&prx) == ICE_OK);
    CHECK(Test_ThrowerPrx_throwAfterException(&prx, 0) == ICE_USER_EXCEPTION);
    CHECK(Ice_ObjectPrx_ice_ping(&stranger) == ICE_OBJECT_NOT_EXIST);
    Test_WrongOperationPrx_uncheckedCast(&wrong, &base);
    CHECK(Test_WrongOperationPrx_noSuchOperation(&wrong) == ICE_OPERATION_NOT_EXIST);
    CHECK(Test_ThrowerPrx_shutdown(&prx) == ICE_OK);
}
