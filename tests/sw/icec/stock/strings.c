/* SPDX-License-Identifier: MIT
 *
 * strings: parses proxy strings for strings.py. Each input line is one string in hexadecimal
 * digits. Prints each proxy in IceC's format; for an invalid string, prints "error" and the status.
 */
#include "icec.h"
#include "tcp_endpoint.h"

#include <stdio.h>
#include <string.h>

int main(void) {
    static Ice_Communicator ic;
    static TcpEndpoint tcp;
    char line[4096], text[2048], printed[2048];
    Ice_initialize(&ic);
    if (TcpEndpoint_init(&ic, &tcp) != ICE_OK)
        return 1;
    while (fgets(line, sizeof line, stdin)) {
        Ice_ObjectPrx prx;
        Ice_Status status;
        size_t i, size = strcspn(line, "\n") / 2;
        for (i = 0; i < size; ++i) {
            unsigned byte = 0;
            (void)sscanf(line + 2 * i, "%2x", &byte);
            text[i] = (char)byte;
        }
        text[size] = 0;
        status = Ice_Communicator_stringToProxy(&ic, text, &prx);
        if (status != ICE_OK)
            printf("error %d", (int)status);
        else if (Ice_Communicator_proxyToString(&prx, printed, (Ice_Int)sizeof printed) == ICE_OK)
            printf("=%s", printed);
        printf("\n");
    }
    return 0;
}
