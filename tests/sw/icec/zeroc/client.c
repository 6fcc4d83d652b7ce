/* SPDX-License-Identifier: MIT
 *
 * client: what IceC's clients of ZeroC's own servers share.
 */
#include "client.h"
#include "tcp_endpoint.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int Suite_minor;
static const char* port;
static int passed, failed;

Ice_ObjectPrx Suite_proxy(Ice_CommunicatorPtr ic, const char* identity) {
    Ice_ObjectPrx prx;
    char text[100];
    sprintf(text, "%.40s:tcp -h 127.0.0.1 -p %.9s", identity, port);
    memset(&prx, 0, sizeof prx);
    CHECK(Ice_Communicator_stringToProxy(ic, text, &prx) == ICE_OK);
    Ice_ObjectPrx_ice_encodingVersion(&prx, (Ice_Byte)Suite_minor);
    return prx;
}

void Suite_check(int is, const char* what, int line) {
    passed += is != 0;
    failed += !is;
    if (!is)
        printf("line %d: %s\n", line, what);
}

int main(int argc, char** argv) {
    static Ice_Communicator ic;
    static TcpEndpoint tcp;
    if (argc != 3)
        return 2;
    Suite_minor = atoi(argv[1] + 2);
    port = argv[2];
    Ice_initialize(&ic);
    if (TcpEndpoint_init(&ic, &tcp) != ICE_OK)
        return 2;
    Suite_call(&ic);
    Ice_Communicator_destroy(&ic, 2000);
    TcpEndpoint_destroy(&tcp);
    printf("%d checks passed, %d failed\n", passed, failed);
    return failed || !passed;
}
