/* SPDX-License-Identifier: MIT
 *
 * server: an IceC server for Echo.ice over tcp, for messages.py. It prints its port, then one line
 * for each operation that it executes.
 */
#include "Echo.h"
#include "tcp_endpoint.h"

#include <stdio.h>

static void note(void) {
    (void)puts("executed");
    (void)fflush(stdout);
}

Ice_Status Stock_Echo_say(Stock_EchoPtr self, const Ice_String* text, Ice_Int n,
                          Ice_Bool* has_result, Ice_String* result, const Ice_Current* current) {
    (void)self, (void)n, (void)current;
    note();
    *has_result = text != 0;
    if (text)
        *result = *text;
    return ICE_OK;
}

Ice_Status Stock_Echo_count(Stock_EchoPtr self, Ice_String s, Ice_Int* result,
                            const Ice_Current* current) {
    (void)self, (void)current;
    note();
    *result = s.size;
    return ICE_OK;
}

Ice_Status Stock_Echo_hit(Stock_EchoPtr self, const Ice_Current* current) {
    (void)self, (void)current;
    note();
    return ICE_OK;
}

Ice_Status Stock_Echo_sum(Stock_EchoPtr self, const Stock_Ints* values, Ice_Int* result,
                          const Ice_Current* current) {
    (void)self, (void)current;
    note();
    *result = values->size;
    return ICE_OK;
}

Ice_Status Stock_Echo_pairs(Stock_EchoPtr self, const Stock_Pair* one, const Stock_Names* names,
                            Ice_Int* result, const Ice_Current* current) {
    (void)self, (void)one, (void)current;
    note();
    *result = names->size;
    return ICE_OK;
}

Ice_Status Stock_Echo_colour(Stock_EchoPtr self, Stock_Colour c, Ice_Bool b, Ice_Int* result,
                             const Ice_Current* current) {
    (void)self, (void)b, (void)current;
    note();
    *result = (Ice_Int)c;
    return ICE_OK;
}

Ice_Status Stock_Echo_walk(Stock_EchoPtr self, const Stock_Node* first, Ice_Int* result,
                           const Ice_Current* current) {
    (void)self, (void)current;
    note();
    *result = first ? first->value : 0;
    return ICE_OK;
}

Ice_Status Stock_Echo_same(Stock_EchoPtr self, Ice_Byte b, Ice_Int* result,
                           const Ice_Current* current) {
    (void)self, (void)current;
    note();
    *result = b;
    return ICE_OK;
}

int main(void) {
    static Ice_Communicator ic;
    static TcpEndpoint tcp;
    static Ice_ObjectAdapter adapter;
    static Stock_Echo echo;
    Ice_initialize(&ic);
    if (TcpEndpoint_init(&ic, &tcp) != ICE_OK ||
        Ice_Communicator_createObjectAdapterWithEndpoints(&ic, "A", "tcp", &adapter) != ICE_OK)
        return 1;
    Stock_Echo_init(&echo);
    (void)Ice_ObjectAdapter_add(&adapter, (Ice_ObjectPtr)&echo, "echo");
    Ice_ObjectAdapter_activate(&adapter);
    (void)printf("%d\n", tcp.port);
    (void)fflush(stdout);
    Ice_Communicator_waitForShutdown(&ic);
    return 0;
}
