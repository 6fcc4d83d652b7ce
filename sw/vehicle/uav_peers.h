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
#define UAV_NO_PEER 0xFFFFFFFFU /* in place of an address */

/* Provides the vehicle with an observer, by its modem's address, and with that one's key; or with
 * another vehicle, which has the same key and this one's address; or with the key of its group.
 * 0: no key, for an open vehicle. UAV_NO_PEER: it has none, as after UAV_provide. Returns 0 in
 * firmware without peers. */
int UAV_providePeer(int role, U32 address, const U8* key);

/* Returns 1 if the vehicle takes calls to all vehicles: it has the group's key, or is open. */
int UAV_isOfGroup(void);

/* Decrypts such a call, unless this vehicle has seen it (Link_openBroadcast), and keeps its
 * number. Returns the message's size; 0: it is not to be carried out. */
U32 UAV_openBroadcast(U8* packet, U32 size);
