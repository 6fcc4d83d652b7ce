/* SPDX-License-Identifier: MIT
 *
 * server: serves the generated servants over tcp, prints its port.
 */
#include "echo.h"
#include "tcp_endpoint.h"

#include <stdio.h>

static Ice_Communicator ic;
static TcpEndpoint tcp;
static Ice_ObjectAdapter adapter;
static T_Echo echo;

int main(void) {
    Ice_initialize(&ic);
    if (TcpEndpoint_init(&ic, &tcp) != ICE_OK || Ice_Communicator_createObjectAdapterWithEndpoints(
                                                     &ic, "Adapter", "tcp", &adapter) != ICE_OK)
        return 1;
    T_Echo_init(&echo);
    if (Ice_ObjectAdapter_add(&adapter, (Ice_ObjectPtr)&echo, "echo") != ICE_OK)
        return 1;
    Ice_ObjectAdapter_activate(&adapter);
    printf("%d\n", tcp.port);
    fflush(stdout);
    Ice_Communicator_waitForShutdown(&ic);
    TcpEndpoint_destroy(&tcp);
    return 0;
}
