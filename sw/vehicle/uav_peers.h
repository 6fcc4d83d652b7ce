/* SPDX-License-Identifier: MIT
 *
 * uav_peers: the roles of a vehicle's peers, and the addresses at which they were provided.
 *
 * Each role has its place in the backup memory (backup.h): the keys, and for all but the first
 * ground an address. All but the group have a link.
 */
#pragma once

#include "uav_memory.h"

typedef enum UAV_Role {
    UAV_GROUND,           /* the first ground, always there */
    UAV_OBSERVER,         /* a second ground */
    UAV_VEHICLE,          /* another vehicle, which this one calls */
    UAV_PEERS,            /* number of roles with a link */
    UAV_GROUP = UAV_PEERS /* senders of calls to all vehicles */
} UAV_Role;

#define UAV_GROUND_ADDRESS 0x0000U
#define UAV_EVERYBODY 0xFFFFU   /* the group's address */
#define UAV_NO_PEER 0xFFFFFFFFU /* instead of an address */

/* Stores an observer's modem address and key in the vehicle; or another vehicle, with the common
 * key and its address; or the key of the group. 0: no key, for an open vehicle. UAV_NO_PEER: the
 * vehicle has none, as after UAV_provide. Returns 0 in firmware without peers. */
int UAV_providePeer(int role, U32 address, const U8* key);

/* Returns 1 if the vehicle takes calls to all vehicles: it has the group's key, or is open. */
int UAV_isOfGroup(void);

/* Decrypts such a call, unless this vehicle has seen it (Link_openBroadcast), and stores its
 * number. Returns the message's size; 0 if it must not be executed. */
U32 UAV_openBroadcast(U8* packet, U32 size);
