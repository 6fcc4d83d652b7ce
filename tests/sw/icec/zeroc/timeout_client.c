/* SPDX-License-Identifier: MIT
 *
 * timeout_client: calls the server of ZeroC's suite "timeout".
 */
#include "Test.h"
#include "client.h"

void Suite_call(Ice_CommunicatorPtr ic) {
    static Ice_Byte data[8000];
    Ice_ObjectPrx base = Suite_proxy(ic, "timeout"), other = Suite_proxyAt(ic, "controller", 1);
    Test_TimeoutPrx prx, brief;
    Test_ControllerPrx controller;
    Test_ByteSeq seq;
    seq.size = (Ice_Int)sizeof data, seq.data = data;
    CAST(Test_Timeout, &prx, &base);
    CAST(Test_Controller, &controller, &other);
    brief = prx;
    Ice_ObjectPrx_ice_invocationTimeout(&brief, 100);
    CHECK(Test_TimeoutPrx_sleep(&prx, 200) == ICE_OK);
    CHECK(Test_ControllerPrx_holdAdapter(&controller, -1) == ICE_OK);
    CHECK(Test_TimeoutPrx_op(&brief) == ICE_TIMEOUT);
    CHECK(Test_TimeoutPrx_sendData(&brief, &seq) == ICE_TIMEOUT);
    CHECK(Test_ControllerPrx_resumeAdapter(&controller) == ICE_OK);
    CHECK(Test_TimeoutPrx_sendData(&prx, &seq) == ICE_OK);
    CHECK(Test_ControllerPrx_shutdown(&controller) == ICE_OK);
}
