/* SPDX-License-Identifier: MIT
 *
 * uav_peers: the roles of a vehicle's peers, and their addresses.
 *
 * Each role has a place in the backup memory (backup.h): its keys, and an address for all roles but
 * the first ground. All roles but the group have a link.
 */
#pragma once

#include "uav_backup.h"

typedef enum UAV_Role {
    UAV_GROUND,           /* the first ground station; always exists */
    UAV_OBSERVER,         /* a second ground station */
    UAV_VEHICLE,          /* another vehicle, which this vehicle calls */
    UAV_PEERS,            /* number of roles with a link */
    UAV_GROUP = UAV_PEERS /* the group: senders of calls to all vehicles */
} UAV_Role;

#define UAV_GROUND_ADDRESS 0x0000U
#define UAV_EVERYBODY 0xFFFFU   /* the group's address */
#define UAV_NO_PEER 0xFFFFFFFFU /* address of a peer that is absent */

/* Gives the vehicle a peer: the address of an observer's or another vehicle's modem and the key
 * shared with it, or the key of its group. Without a key (0) the vehicle must be open. The address
 * UAV_NO_PEER removes the peer. Returns 0 if the firmware has no such peers. */
int UAV_providePeer(int role, U32 address, const U8* key);

/* Returns 1 if the vehicle accepts calls to all vehicles: it has the group's key, or it is open. */
int UAV_isOfGroup(void);

/* Sets the number that calls to all vehicles must exceed: the current one (link_broadcast.h) when
 * the vehicle receives its group's key. Recorded calls have lower numbers. */
void UAV_setCallNumber(U32 number);

/* Largest distance of a call's number from the previous one: 400 days in quarters of a second.
 * Without this limit, one call with the highest number would make the vehicle refuse all later
 * calls. */
#define UAV_MOST_AHEAD (400U * 24U * 3600U * 4U)
#define UAV_FIRST_CALL 0x7FFFFFFFU /* highest number of the first call if no number was set */

/* Decrypts a call to all vehicles and stores its number. Returns the message's size, or 0 if the
 * call must not be executed: it is not of the group, this vehicle has seen it
 * (Link_openBroadcast), or its number is too far ahead. */
U32 UAV_openBroadcast(U8* packet, U32 size);
