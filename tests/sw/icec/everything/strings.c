/* SPDX-License-Identifier: MIT
 *
 * strings: reads a proxy a line, prints IceC's form of it, then its bytes on the wire in the
 * encodings 1.1 and 1.0; or "refused".
 */
#include "tcp_endpoint.h"

#include <stdio.h>
#include <string.h>

static void printBytes(const Ice_ObjectPrx* prx, Ice_Byte minor) {
    Ice_Byte bytes[400];
    Ice_OutputStream os;
    Ice_Int i;
    Ice_OutputStream_init(&os, bytes, sizeof bytes);
    os.minor = minor;
    Ice_OutputStream_writePrx(&os, prx);
    for (i = 0; i < os.size; ++i)
        printf("%02x", bytes[i]);
    puts("");
}

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
            Ice_Communicator_proxyToString(&prx, text, sizeof text) == ICE_OK) {
            puts(text);
            printBytes(&prx, 1);
            printBytes(&prx, 0);
        } else {
            puts("refused");
        }
    }
    return 0;
}
