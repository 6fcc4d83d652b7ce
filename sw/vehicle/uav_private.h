/* SPDX-License-Identifier: MIT
 *
 * uav_private: declarations shared by the files of the application.
 */
#pragma once

#include "Autopilot.h"
#include "link.h"
#include "ucos_ii.h"
#include "xbee_endpoint.h"

/* Priorities. */
#define PRIO_MUTEX 3U
#define PRIO_RADIO 5U
#define PRIO_SERVER 10U
#define PRIO_CORES 11U
#define PRIO_CLIENT 12U
#define PRIO_UPDATE 40U

/* Number of servants besides the cores': chip, uav, update, fpga, keys. cmake/cores.cmake reads
 * it. */
#define UAV_SERVANTS 5

extern Link uav_link;           /* the first ground's */
extern OS_EVENT* uav_radioWork; /* the radio task has something to do */

/* Microseconds since the start, from the OS's ticks. */
U32 UAV_nowUs(void);

/* Radio task: sets up the modem, runs the link, and repeats the set-up if the link stays down. */
int UAV_initRadio(void); /* 0: the vehicle has no key, and was not opened */
int UAV_peerOf(const Ice_Current* current);
int UAV_nextKey(int ground, const U8* key); /* UAV_setNextKey for a servant */
void UAV_radioTask(void* argument);
void UAV_useRadio(Ice_CommunicatorPtr ic);
extern const Ice_Os uav_iceOs;
void UAV_initIceOs(void);

/* Serves new firmware (uav_update.c), if there are slots for it. */
void UAV_startUpdate(Ice_ObjectAdapterPtr adapter);

/* Serves changes of keys (uav_keyring.c). */
void UAV_startKeyRing(Ice_ObjectAdapterPtr adapter);

/* Makes a proxy to the vehicle that this one calls; returns 0 if there is none. */
int UAV_makeVehicleProxy(Ice_CommunicatorPtr ic, Ice_ObjectPrxPtr other);

/* Cores (uav_cores.c): their servants, their task; `lines`: interrupt lines of slots 0..31
 * and 32..63. UAV_waitFrame waits for a processed frame, and returns how many there were, with the
 * sum of their corners. */
void UAV_initCores(void);
void UAV_startCores(Ice_ObjectAdapterPtr adapter);
void UAV_coresTask(void* argument);
void UAV_coresInterrupt(const U32 lines[2]);
U32 UAV_waitFrame(U32* corners);
