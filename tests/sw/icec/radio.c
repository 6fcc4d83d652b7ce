/* SPDX-License-Identifier: MIT
 *
 * radio: lets the simulated UAV run a test's servants as its firmware.
 */
#include "paper.h"
#include "serve.h"
#include "ucos_ii.h"

void appMainTask(void* argument) {
    static Ice_Communicator ic;
    static Ice_ObjectAdapter adapter;
    (void)argument;
    Ice_initialize(&ic);
    PAPER_useRadio(&ic);
    if (Ice_Communicator_createObjectAdapterWithEndpoints(&ic, "A", "xbee-at", &adapter) ==
            ICE_OK &&
        Suite_serve(&adapter) == ICE_OK) {
        Ice_ObjectAdapter_activate(&adapter);
        Ice_Communicator_waitForShutdown(&ic);
    }
    for (;;)
        OSTimeDly(OS_TICKS_PER_SEC);
}
