/* SPDX-License-Identifier: MIT
 *
 * server: serves an object "thing" over TCP; part of a project that uses the installed IceC and
 * slice2c. Usage: server PORT
 */
#include "Thing.h"
#include "tcp_endpoint.h"

#include <stdio.h>

Ice_Status M_Thing_add(M_ThingPtr self, Ice_Int a, Ice_Int b, Ice_Int* result,
                       M_Thing_add_Exception* ex, const Ice_Current* current) {
    (void)self;
    (void)current;
    if (b < 0) {
        ex->type = M_Thing_add_Busy;
        ex->u.Busy.why = Ice_String_from("b is negative");
        return ICE_USER_EXCEPTION;
    }
    *result = a + b;
    return ICE_OK;
}

int main(int argc, char** argv) {
    static Ice_Communicator ic;
    static TcpEndpoint tcp;
    static Ice_ObjectAdapter adapter;
    static M_Thing thing;
    char endpoint[64];
    if (argc != 2)
        return 2;
    sprintf(endpoint, "tcp -h 127.0.0.1 -p %.8s", argv[1]);
    Ice_initialize(&ic);
    TcpEndpoint_init(&ic, &tcp);
    if (Ice_Communicator_createObjectAdapterWithEndpoints(&ic, "A", endpoint, &adapter) != ICE_OK)
        return 1;
    M_Thing_init(&thing);
    Ice_ObjectAdapter_add(&adapter, (Ice_ObjectPtr)&thing, "thing");
    Ice_ObjectAdapter_activate(&adapter);
    puts("ready");
    fflush(stdout);
    Ice_Communicator_waitForShutdown(&ic);
    return 0;
}
