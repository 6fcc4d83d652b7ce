/* SPDX-License-Identifier: MIT
 *
 * server: Everything.ice over tcp. Prints its port, serves until `shutdown`.
 */
#include "tcp_endpoint.h"
#include "tester.h"

#include <stdio.h>

int main(void) {
    static const char* const properties[] = {"Adapter.Endpoints=tcp -h 127.0.0.1", 0};
    static Ice_Communicator ic;
    static TcpEndpoint tcp;
    static Ice_ObjectAdapter adapter;
    Ice_initialize(&ic);
    Ice_Communicator_setProperties(&ic, properties);
    if (TcpEndpoint_init(&ic, &tcp) != ICE_OK ||
        Ice_Communicator_createObjectAdapter(&ic, "Adapter", &adapter) != ICE_OK ||
        Tester_serve(&adapter) != ICE_OK)
        return 1;
    printf("%d\n", tcp.port);
    fflush(stdout);
    Ice_Communicator_waitForShutdown(&ic);
    Ice_Communicator_destroy(&ic, 2000);
    TcpEndpoint_destroy(&tcp);
    return 0;
}
