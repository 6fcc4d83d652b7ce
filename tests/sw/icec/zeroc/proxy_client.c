/* SPDX-License-Identifier: MIT
 *
 * proxy_client: calls the server of ZeroC's suite "proxy".
 */
#include "Test.h"
#include "client.h"

void Suite_call(Ice_CommunicatorPtr ic) {
    static const Ice_ContextEntry context[] = {{"one", "hello"}, {"two", "world"}, {0, 0}};
    static const char* const strings[] = {"test", "cat/\\xc3\\xa9 -f facet", "x -t:tcp -h h -p 1",
                                          "x @ adapter", "x:opaque -t 99 -v QUI="};
    Ice_ObjectPrx base = Suite_proxy(ic, "test"), prx, again;
    Test_MyDerivedClassPrx derived;
    Test_MyClassPrx my;
    Ice_Context heard;
    size_t i;
    CAST(Test_MyClass, &my, &base);
    CAST(Test_MyDerivedClass, &derived, &my);
    CHECK(Suite_alike(&base, &derived));
    for (i = 0; i < sizeof strings / sizeof *strings; ++i) {
        CHECK(Ice_Communicator_stringToProxy(ic, strings[i], &prx) == ICE_OK);
        prx.minor = (Ice_Byte)Suite_minor;
        CHECK(Test_MyDerivedClassPrx_echo(&derived, &prx, &again) == ICE_OK);
        again.minor = prx.minor; /* 1.0 does not carry it */
        CHECK(Suite_alike(&prx, &again));
    }
    CHECK(Test_MyClassPrx_getContext(&my, &heard) == ICE_OK && heard.size == 0);
    Ice_ObjectPrx_ice_context(&base, context);
    CAST(Test_MyClass, &my, &base); /* the server notes the context of ice_isA */
    CHECK(Test_MyClassPrx_getContext(&my, &heard) == ICE_OK && heard.size == 2);
    SAME(*Ice_Context_find(&heard, Ice_String_from("two")), "world");
    CHECK(Test_MyClassPrx_shutdown(&my) == ICE_OK);
}
