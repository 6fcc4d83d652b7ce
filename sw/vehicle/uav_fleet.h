/* SPDX-License-Identifier: MIT
 *
 * uav_fleet: the peers besides the first ground: observer, another vehicle, calls to all vehicles.
 * Firmware for one ground has without/without_fleet.c in place of uav_fleet.c and uav_peers.c.
 */
#pragma once

#include "radio.h"
#include "uav_radio_state.h"

/* Starts the links of the peers besides the first ground. Returns 1 if there are any. */
int UAV_addPeers(void);

/* Makes these peers known to the endpoint. */
void UAV_usePeers(void);

/* Starts or stops connecting to the other vehicle. */
void UAV_dialVehicle(void);

/* Offers a call to all vehicles to IceC. Returns 1 if it waits. */
int UAV_offerCall(void);

/* Returns the receiver of packets in API mode. */
Radio_OnPacket UAV_receiver(void);

/* Makes a proxy to the vehicle that this one calls. Returns 0 if none. */
int UAV_makeVehicleProxy(Ice_ObjectAdapterPtr adapter, Ice_ObjectPrxPtr other);
