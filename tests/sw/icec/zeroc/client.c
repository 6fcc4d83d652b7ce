/* SPDX-License-Identifier: MIT
 *
 * client: shared by IceC's clients of ZeroC's own servers.
 */
#include "client.h"
#include "tcp_endpoint.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int Suite_minor;
static char** ports;
static int passed, failed;

Ice_ObjectPrx Suite_proxyAt(Ice_CommunicatorPtr ic, const char* identity, int adapter) {
    static U32 room[16384]; /* a few suites' replies are large */
    Ice_ObjectPrx prx;
    char text[100];
    sprintf(text, "%.40s:tcp -h 127.0.0.1 -p %.9s", identity, ports[adapter]);
    memset(&prx, 0, sizeof prx);
    CHECK(Ice_Communicator_stringToProxy(ic, text, &prx) == ICE_OK);
    Ice_ObjectPrx_ice_encodingVersion(&prx, (Ice_Byte)Suite_minor);
    Ice_ObjectPrx_setReplyBuffer(&prx, room, sizeof room);
    return prx;
}

int Suite_alike(const Ice_ObjectPrx* a, const Ice_ObjectPrx* b) {
    char texts[2][300] = {"a", "b"};
    (void)Ice_Communicator_proxyToString(a, texts[0], sizeof texts[0]);
    (void)Ice_Communicator_proxyToString(b, texts[1], sizeof texts[1]);
    return strcmp(texts[0], texts[1]) == 0;
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
    if (argc != 4)
        return 2;
    Suite_minor = atoi(argv[1] + 2);
    ports = argv + 2;
    Ice_initialize(&ic);
    if (TcpEndpoint_init(&ic, &tcp) != ICE_OK)
        return 2;
    Suite_call(&ic);
    Ice_Communicator_destroy(&ic, 2000);
    TcpEndpoint_destroy(&tcp);
    printf("%d checks passed, %d failed\n", passed, failed);
    return failed || !passed;
}
