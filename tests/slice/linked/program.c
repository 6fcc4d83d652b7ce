/* SPDX-License-Identifier: MIT
 *
 * program: a client that uses one operation of an interface; with -DSERVER, a servant of one
 * interface. The file declares more operations and interfaces.
 */
#include "Linked.h"

static Ice_Communicator ic;

#ifdef SERVER
static Ice_ObjectAdapter adapter;
static Linked_Lamp lamp;
static Ice_Bool isOn;

Ice_Status Linked_Lamp_light(Linked_LampPtr self, Ice_Bool on, const Ice_Current* current) {
    (void)self, (void)current;
    isOn = on;
    return ICE_OK;
}

int main(void) {
    Ice_initialize(&ic);
    (void)Ice_Communicator_createObjectAdapterWithEndpoints(&ic, "Adapter", "tcp -p 1", &adapter);
    Linked_Lamp_init(&lamp);
    (void)Ice_ObjectAdapter_add(&adapter, (Ice_ObjectPtr)&lamp, "lamp");
    Ice_Communicator_waitForShutdown(&ic);
    return (int)isOn;
}
#else
int main(void) {
    Linked_CounterPrx counter;
    Ice_Int sum = 0;
    Ice_initialize(&ic);
    (void)Ice_Communicator_stringToProxy(&ic, "counter:tcp -p 1", &counter);
    (void)Linked_CounterPrx_add(&counter, 1, 2, &sum);
    return (int)sum;
}
#endif
