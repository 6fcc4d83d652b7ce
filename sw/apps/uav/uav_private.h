/* SPDX-License-Identifier: MIT
 *
 * uav_private: what the application's files share.
 */
#ifndef UAV_PRIVATE_H
#define UAV_PRIVATE_H

#include "Autopilot.h"
#include "link.h"
#include "ucos_ii.h"
#include "xbee_endpoint.h"

#define UAV_BEST 64 /* features in a result, as Autopilot.ice says */

/* Priorities. */
#define PRIO_MUTEX 3U
#define PRIO_RADIO 5U
#define PRIO_SERVER 10U
#define PRIO_CLIENT 12U

extern Ice_Communicator uav_ic;
extern Link uav_link;
extern OS_EVENT *uav_radioWork; /* the radio task has something to do */
extern OS_EVENT *uav_report;    /* a frame is done: tell the station */

/* Microseconds since the start, from the OS's ticks. */
U32 UAV_nowUs(void);

/* Radio task: sets the modem up, runs the link, and sets it up again if the link stays down. */
void UAV_initRadio(void);
void UAV_radioTask(void *argument);
void UAV_useRadio(Ice_CommunicatorPtr ic);
extern const Ice_Os uav_iceOs;
void UAV_initIceOs(void);

/* Accesses that no register answered, or whose core hung until the bridge gave up: how many, and where the last
 * one was (slot * 16 + word, bit 16 for a write). */
U32 UAV_busErrors(void);
U32 UAV_busErrorPlace(void);

/* Vision core. */
void UAV_initVision(void);
void UAV_visionInterrupt(void);
U32 UAV_framesProcessed(void);
U32 UAV_cornersFound(void);

#endif
