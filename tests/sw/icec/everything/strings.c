/* SPDX-License-Identifier: MIT
 *
 * strings: reads a proxy a line, prints what IceC makes of it, or "refused".
 */
#include "tcp_endpoint.h"

#include <stdio.h>
#include <string.h>

int main(void) {
    static Ice_Communicator ic;
    static TcpEndpoint tcp;
    char line[500], text[800];
    Ice_initialize(&ic);
    if (TcpEndpoint_init(&ic, &tcp) != ICE_OK)
        return 1;
    while (fgets(line, sizeof line, stdin)) {
        Ice_ObjectPrx prx;
        line[strcspn(line, "\n")] = 0;
        if (Ice_Communicator_stringToProxy(&ic, line, &prx) == ICE_OK &&
            Ice_Communicator_proxyToString(&prx, text, sizeof text) == ICE_OK)
            puts(text);
        else
            puts("refused");
    }
    return 0;
}
