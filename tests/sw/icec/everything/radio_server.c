/* SPDX-License-Identifier: MIT
 *
 * radio_server: Everything.ice as the firmware of the simulated UAV.
 */
#include "paper.h"
#include "tester.h"
#include "ucos_ii.h"

void appMainTask(void* argument) {
    static Ice_Communicator ic;
    static Ice_ObjectAdapter adapter;
    (void)argument;
    Ice_initialize(&ic);
    PAPER_useRadio(&ic);
    if (Ice_Communicator_createObjectAdapterWithEndpoints(&ic, "Adapter", "xbee-at", &adapter) ==
            ICE_OK &&
        Tester_serve(&adapter) == ICE_OK)
        Ice_Communicator_waitForShutdown(&ic);
    for (;;)
        OSTimeDly(OS_TICKS_PER_SEC);
}
