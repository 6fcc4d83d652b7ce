/* SPDX-License-Identifier: MIT
 *
 * client: an IceC client against a stock server on the given port. Exit status 0: all as expected.
 */
#include "Interop.h"
#include "check.h"
#include "tcp_endpoint.h"

#include <stdio.h>

static Ice_Communicator ic;
static TcpEndpoint tcp;

int main(int argc, char** argv) {
    static Interop_ServicePrx service, oneway, nobody, dead;
    Interop_Item data[3];
    Interop_Items items, back;
    Ice_String joined;
    Ice_Int sum, i;
    char text[128];
    if (argc != 2)
        return 2;
    Ice_initialize(&ic);
    CHECK(TcpEndpoint_init(&ic, &tcp) == ICE_OK);
    sprintf(text, "service:tcp -h 127.0.0.1 -p %.8s", argv[1]);
    CHECK(Ice_Communicator_stringToProxy(&ic, text, &service) == ICE_OK);
    sprintf(text, "service -o:tcp -h 127.0.0.1 -p %.8s", argv[1]);
    CHECK(Ice_Communicator_stringToProxy(&ic, text, &oneway) == ICE_OK);
    sprintf(text, "nobody:tcp -h 127.0.0.1 -p %.8s", argv[1]);
    CHECK(Ice_Communicator_stringToProxy(&ic, text, &nobody) == ICE_OK);
    CHECK(Ice_Communicator_stringToProxy(&ic, "x:tcp -h 127.0.0.1 -p 1", &dead) == ICE_OK);
    CHECK(Ice_Communicator_stringToProxy(&ic, "x:ssl -p 1", &dead) == ICE_NO_ENDPOINT);
    CHECK(Ice_Communicator_stringToProxy(&ic, "x:tcp -h 127.0.0.1 -p 1", &dead) == ICE_OK);

    CHECK(Ice_ObjectPrx_ice_ping(&service) == ICE_OK);
    CHECK(Ice_ObjectPrx_ice_ping(&nobody) == ICE_OBJECT_NOT_EXIST);
    CHECK(Ice_ObjectPrx_ice_ping(&dead) == ICE_CONNECTION_LOST);
    for (i = 0; i < 1000; ++i) {
        CHECK(Interop_ServicePrx_add(&service, i, 2 * i, &sum) == ICE_OK);
        CHECK(sum == 3 * i);
    }
    for (i = 0; i < 3; ++i) {
        static const char* const names[] = {"one", "two", "three"};
        data[i].name = Ice_String_from(names[i]);
        data[i].amount = -i;
        data[i].colour = (Interop_Colour)i;
        data[i].price = 1.5 * i;
    }
    items.size = 3;
    items.data = data;
    CHECK(Interop_ServicePrx_reverse(&service, &items, &joined, &back) == ICE_OK);
    CHECK(Ice_String_equals(joined, "onetwothree") && back.size == 3);
    CHECK(Ice_String_equals(back.data[0].name, "three") && back.data[0].amount == -2);
    CHECK(back.data[0].colour == Interop_blue && back.data[0].price == 3.0);
    for (i = 0; i < 5; ++i)
        CHECK(Interop_ServicePrx_notify(&oneway, Ice_String_from("hello")) == ICE_OK);
    CHECK(Interop_ServicePrx_notifications(&service, &sum) == ICE_OK && sum == 5);
    CHECK(Interop_ServicePrx_fail(&service) == ICE_UNKNOWN_EXCEPTION);
#ifndef ICEC_MINIMAL
    {
        static const char* const indirect[] = {"service@Adapter", "service"};
        static Ice_ObjectPrx locator;
        sprintf(text, "locator:tcp -h 127.0.0.1 -p %.8s", argv[1]);
        CHECK(Ice_Communicator_stringToProxy(&ic, text, &locator) == ICE_OK);
        for (i = 0; i < 2; ++i) {
            CHECK(Ice_Communicator_stringToProxy(&ic, indirect[i], &nobody) == ICE_OK);
            CHECK(Ice_ObjectPrx_resolve(&nobody, &locator) == ICE_OK);
            CHECK(Interop_ServicePrx_add(&nobody, 1, 2, &sum) == ICE_OK && sum == 3);
        }
        CHECK(Ice_Communicator_stringToProxy(&ic, "service@Other", &nobody) == ICE_OK);
        CHECK(Ice_ObjectPrx_resolve(&nobody, &locator) == ICE_NO_ENDPOINT);
    }
#endif
    CHECK(Interop_ServicePrx_shutdown(&service) == ICE_OK);
    TcpEndpoint_destroy(&tcp);
    printf("client: all calls as expected\n");
    return 0;
}
