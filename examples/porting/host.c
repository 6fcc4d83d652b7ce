/* SPDX-License-Identifier: MIT
 *
 * host: serves the meter over TCP on a POSIX system, and prints the number of the TCP port.
 */
#include "icec_tcp.h"
#include "meter.h"

#include <stdio.h>

static Ice_Communicator ic; /* large: not on a stack */
static TcpEndpoint tcp;

int main(void) {
    Ice_initialize(&ic);
    if (TcpEndpoint_init(&ic, &tcp) != ICE_OK ||
        Meter_serve(&ic, "tcp -h 127.0.0.1", "host") != ICE_OK)
        return 1;
    printf("%d\n", tcp.port);
    fflush(stdout);
    Ice_Communicator_waitForShutdown(&ic);
    return 0;
}
