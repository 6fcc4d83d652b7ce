/* SPDX-License-Identifier: MIT
 *
 * server: serves the servants of a test over tcp. It prints its port, and serves until `shutdown`
 * is called.
 */
#include "serve.h"
#include "tcp_endpoint.h"

#include <stdio.h>

const char* suite_argument = "";

int main(int argc, char** argv) {
    static Ice_Communicator ic;
    static TcpEndpoint tcp;
    static Ice_ObjectAdapter adapter;
    if (argc > 1)
        suite_argument = argv[1];
    Ice_initialize(&ic);
    if (TcpEndpoint_init(&ic, &tcp) != ICE_OK ||
        Ice_Communicator_createObjectAdapterWithEndpoints(&ic, "A", "tcp -h 127.0.0.1", &adapter) !=
            ICE_OK ||
        Suite_serve(&adapter) != ICE_OK)
        return 1;
    Ice_ObjectAdapter_activate(&adapter);
    printf("%d\n", tcp.port);
    fflush(stdout);
    Ice_Communicator_waitForShutdown(&ic);
    Ice_Communicator_destroy(&ic, 2000);
    TcpEndpoint_destroy(&tcp);
    return 0;
}
