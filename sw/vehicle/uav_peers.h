/* SPDX-License-Identifier: MIT
 *
 * uav_peers: the roles of a vehicle's peers, and their addresses. The backup memory (backup.h) has
 * a place for each role, with its keys; all roles except the first ground station also have an
 * address there. All roles except the group have a link.
 */
#pragma once

#include "uav_backup.h"

typedef enum UAV_Role {
    UAV_GROUND,           /* the first ground station, which always exists */
    UAV_OBSERVER,         /* a second ground station */
    UAV_VEHICLE,          /* another vehicle, which this vehicle calls */
    UAV_PEERS,            /* number of roles with a link */
    UAV_GROUP = UAV_PEERS /* the group: senders of calls to all vehicles */
} UAV_Role;

#define UAV_GROUND_ADDRESS 0x0000U
#define UAV_EVERYBODY 0xFFFFU   /* the group's address */
#define UAV_NO_PEER 0xFFFFFFFFU /* address that stands for an absent peer */

/* Configures a peer of the vehicle: the address of the modem of an observer or another vehicle, and
 * the key that both share; or the group's key. `key` may only be 0 if the vehicle is open. The
 * address UAV_NO_PEER removes the peer. Returns 0 if the firmware does not support such peers. */
int UAV_providePeer(int role, U32 address, const U8* key);

/* Returns 1 if the vehicle accepts calls to all vehicles: if it has the group's key, or if it is
 * open. */
int UAV_isOfGroup(void);

/* Sets the number that calls to all vehicles must exceed. To be called with the current number
 * (link_broadcast.h) when the vehicle gets the group's key, so that recorded calls, which have
 * lower numbers, are refused. */
void UAV_setCallNumber(U32 number);

/* Largest difference between the numbers of successive calls: 400 days in quarters of a second.
 * Without this limit, after one call with the highest number the vehicle would refuse all later
 * calls. */
#define UAV_MOST_AHEAD (400U * 24U * 3600U * 4U)
/* limit for the number of the first call if no number was set before */
#define UAV_FIRST_CALL 0x7FFFFFFFU

/* Decrypts a call to all vehicles and stores its number. Returns the message's size. Returns 0 if
 * the call must not be executed: it does not come from the group, this vehicle has already executed
 * it (Link_openBroadcast), or its number is too far ahead. */
U32 UAV_openBroadcast(U8* packet, U32 size);
