/* SPDX-License-Identifier: MIT
 *
 * echo_uav: firmware that serves Echo over the radio and calls the ground's Echo. It uses IceC,
 * link, driver and kernel in the same way as the UAV's application.
 */
#pragma once

#include "fsmc.h"

/* Functions of the test that the tasks of the firmware call. They decide what the firmware sends,
 * and observe the results. */
typedef struct EchoUav_Port {
    /* Called when the UAV has executed an operation with an id; `data` contains the operation's
     * bytes. */
    void (*executed)(void* context, int id, const U8* data, int size);
    /* Chooses the next message to the ground: sets its id, writes its bytes to `data` and returns
     * their number, or returns -1 if no message must be sent now. If `isOneway` is set, the message
     * is sent as note(id), without bytes. */
    int (*next)(void* context, int* id, U8* data, int* isOneway);
    /* Called with the result of a call. If `status` is 0, `data` contains the bytes of the reply
     * unless the call was one-way. Otherwise `status` is one of ice_status.c, and `text` is its
     * text. */
    void (*outcome)(void* context, int id, int status, const char* text, const U8* answer,
                    int size);
} EchoUav_Port;

#define ECHO_UAV_LONGEST 4000 /* largest number of bytes in a message to the ground */

/* Sets the functions of the test that the firmware calls. Call it before the first boot. */
void EchoUav_setPort(const EchoUav_Port* port, void* context);

/* Functions for booting the firmware, like UAV_start and related functions (uav.h). */
void EchoUav_start(const FSMC_Port* fsmc, void* context);
int EchoUav_irqEnabled(void);
