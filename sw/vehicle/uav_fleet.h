/* SPDX-License-Identifier: MIT
 *
 * uav_fleet: the peers other than the first ground station (observer, another vehicle), and calls
 * to all vehicles. In firmware for a single ground station, without/without_fleet.c replaces
 * uav_fleet.c and uav_peers.c.
 */
#pragma once

#include "radio.h"
#include "uav_radio_state.h"

/* Starts the links to the peers other than the first ground station. Returns 1 if there is at least
 * one such peer. */
int UAV_addPeers(void);

/* Registers these peers at the endpoint. */
void UAV_usePeers(void);

/* Starts or stops connecting to the other vehicle, depending on whether a call waits for it. */
void UAV_dialVehicle(void);

/* If a call to all vehicles was received, passes it to IceC. Returns 1 if IceC cannot accept the
 * call yet. */
int UAV_offerCall(void);

/* Returns the function that is called with each packet received in API mode. */
Radio_OnPacket UAV_receiver(void);

/* Creates a proxy to the other vehicle, which this vehicle calls. Returns 0 if no other vehicle is
 * configured. */
int UAV_makeVehicleProxy(Ice_ObjectAdapterPtr adapter, Ice_ObjectPrxPtr other);
