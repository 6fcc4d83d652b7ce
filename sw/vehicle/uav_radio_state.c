/* SPDX-License-Identifier: MIT
 *
 * uav_radio_state: defines the state that the files of the radio share: peers, the lock of the
 * links, and the modem's settings. It does not depend on any of these files.
 */
#include "uav_radio_state.h"
#include "uav.h"
#include "uav_peers.h"
#include "uav_tasks.h"

Link uav_link;
UAV_Peer uav_peers[UAV_PEERS] = {{&uav_link, UAV_GROUND_ADDRESS}};
U8 uav_peerCount = 1;
XBeeATEndpoint uav_endpoint;
OS_EVENT* uav_radioWork;
U32 uav_now;
U8 uav_isAnswered;
U8 uav_pollsAll;
const U8* uav_modemKey;

static OS_EVENT* linkMutex;

void UAV_initState(void) {
    INT8U error;
    uav_radioWork = OSSemCreate(0);
    linkMutex = OSMutexCreate(PRIO_MUTEX, &error);
}

void UAV_lockLink(void* context) {
    INT8U error;
    (void)context;
    OSMutexPend(linkMutex, 0, &error);
}

void UAV_unlockLink(void* context) {
    (void)context;
    (void)OSMutexPost(linkMutex);
}
