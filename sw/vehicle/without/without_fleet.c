/* SPDX-License-Identifier: MIT
 *
 * without_fleet: functions for a vehicle with only one ground station (ICESOC_FLEET=OFF): no
 * observer, no other vehicle, no calls to all vehicles.
 */
#include "uav_fleet.h"
#include "uav_links.h"
#include "uav_peers.h"

int UAV_providePeer(int role, U32 address, const U8* key) {
    (void)role;
    (void)address;
    (void)key;
    return 0;
}

void UAV_setCallNumber(U32 number) {
    (void)number;
}

int UAV_addPeers(void) {
    return 0;
}

void UAV_usePeers(void) {}

void UAV_dialVehicle(void) {}

int UAV_offerCall(void) {
    return 0;
}

Radio_OnPacket UAV_receiver(void) {
    return UAV_onPacketOf;
}

int UAV_makeVehicleProxy(Ice_ObjectAdapterPtr adapter, Ice_ObjectPrxPtr other) {
    (void)adapter;
    (void)other;
    return 0;
}
