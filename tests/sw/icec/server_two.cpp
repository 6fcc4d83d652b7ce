// SPDX-License-Identifier: MIT
//
// server_two: the servants of service.c over tcp and over the loop at once. Prints its port; serves
// until `shutdown`, while a communicator of its own calls them by the loop. Ends with 1 where one
// of these calls fails, or there are few.

#include "loop.h"

#include <cstdio>

extern "C" {
#include "Interop.h"
#include "serve.h"
#include "tcp_endpoint.h"
}

int main() {
    static Ice_Communicator ic, other;
    static TcpEndpoint tcp;
    static Ice_ObjectAdapter adapter;
    Ice_initialize(&ic);
    Ice_initialize(&other);
    if (TcpEndpoint_init(&ic, &tcp) != ICE_OK)
        return 1;
    Loop here(ic), there(other);
    there.join(here);
    Interop_ServicePrx prx;
    if (Ice_Communicator_createObjectAdapterWithEndpoints(&ic, "A", "tcp -h 127.0.0.1:loop",
                                                          &adapter) != ICE_OK ||
        Suite_serve(&adapter) != ICE_OK ||
        Ice_Communicator_stringToProxy(&other, "service:loop", &prx) != ICE_OK)
        return 1;
    Ice_ObjectAdapter_activate(&adapter);
    std::printf("%d\n", tcp.port);
    std::fflush(stdout);
    Ice_Int calls = 0, failed = 0, sum = 0;
    while (!ic.stopping) {
        Ice_Status status = Interop_ServicePrx_add(&prx, calls, 1, &sum);
        if (status == ICE_OK && sum == calls + 1)
            ++calls;
        else if (!ic.stopping)
            ++failed;
        (void)Ice_Communicator_poll(&ic, 10);
        Suite_work();
    }
    Ice_Communicator_destroy(&ic, 2000);
    TcpEndpoint_destroy(&tcp);
    std::fprintf(stderr, "server_two: %d calls by the loop, %d failed\n", calls, failed);
    return failed == 0 && calls > 20 ? 0 : 1;
}
