/* SPDX-License-Identifier: MIT
 *
 * uav_fleet: the peers besides the first ground station (observer, another vehicle), and calls to
 * all vehicles. In firmware for one ground station, without/without_fleet.c replaces uav_fleet.c
 * and uav_peers.c.
 */
#pragma once

#include "radio.h"
#include "uav_radio_state.h"

/* Starts the links to the peers besides the first ground station. Returns 1 if there are any. */
int UAV_addPeers(void);

/* Registers these peers at the endpoint. */
void UAV_usePeers(void);

/* Starts or stops connecting to the other vehicle. */
void UAV_dialVehicle(void);

/* Passes a received call to all vehicles on to IceC. Returns 1 if the call must wait. */
int UAV_offerCall(void);

/* Returns the function that receives packets in API mode. */
Radio_OnPacket UAV_receiver(void);

/* Creates a proxy to the vehicle that this one calls. Returns 0 if there is no such vehicle. */
int UAV_makeVehicleProxy(Ice_ObjectAdapterPtr adapter, Ice_ObjectPrxPtr other);
