/* SPDX-License-Identifier: MIT
 *
 * echo_uav: firmware that serves Echo over the radio and calls the ground's Echo. It uses IceC,
 * link, driver and kernel in the same way as the UAV's application.
 */
#pragma once

#include "fsmc.h"

/* Callbacks of the test: they decide what the firmware does, and observe it. The tasks of the
 * firmware call them. */
typedef struct EchoUav_Port {
    /* Called when an operation with an id has been executed here, with this data. */
    void (*executed)(void* context, int id, const U8* data, int size);
    /* Returns the next message to the ground: its id, its bytes written to `data`, and their
     * number; -1 if no message is due. `isOneway`: sent as note(id), without bytes. */
    int (*next)(void* context, int* id, U8* data, int* isOneway);
    /* Outcome of a call: `status` 0, and the bytes of the reply unless it was oneway; otherwise a
     * status of ice_status.c with its text. */
    void (*outcome)(void* context, int id, int status, const char* text, const U8* answer,
                    int size);
} EchoUav_Port;

#define ECHO_UAV_LONGEST 4000 /* greatest number of bytes of a message to the ground */

/* Sets the program up; to be called before the first boot. */
void EchoUav_setPort(const EchoUav_Port* port, void* context);

/* Counterparts of UAV_start and related functions (uav.h). */
void EchoUav_start(const FSMC_Port* fsmc, void* context);
int EchoUav_irqEnabled(void);
