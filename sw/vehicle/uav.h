/* SPDX-License-Identifier: MIT
 *
 * uav: the application on the UAV; its structure follows Figure 5 of the paper.
 */
#pragma once

#include "fsmc.h"

/* The memory map of DDR3, as byte addresses. */
#define UAV_TRANSMIT_RING 0x00000000U
#define UAV_RECEIVE_RING 0x00001000U
#define UAV_FRAME 0x00100000U /* picture from the camera */
#define UAV_FRAME_HEADER \
    0x000FFF80U /* width and height of the frame, two 32-bit words, written by the camera */

/* AES key of the modem: 16 bytes, which must stay valid. 0 (the initial value) disables encryption
 * by the modem. The key is read when the tasks start. The keys of the link (uav_keys.h) are
 * independent of the modem's key. */
extern const U8* uav_modemKey;

/* guard time that the modem has at the start, ms. 0 (the initial value) means the factory setting,
 * 1000 ms. */
extern U16 uav_guardMs;

/* 1 if a cable to the ground station's serial port replaces both modems; 0 (the initial value) if
 * there is a modem. Read when the tasks start. */
extern U8 uav_wire;

/* 1 selects the modem's transparent mode. 0 (the initial value) selects API mode, in which the
 * modem reports for each packet whether the ground station's modem has received it. Read when the
 * tasks start. */
extern U8 uav_transparent;

typedef enum UAV_Status {
    UAV_OK,
    UAV_NO_FPGA, /* the FPGA does not respond */
    UAV_NO_KEY   /* the vehicle was neither given a key nor opened */
} UAV_Status;

/* Creates the tasks if the result is UAV_OK. Call this function between OSInit and OSStart, after
 * UAV_useBoard. */
UAV_Status UAV_start(const FSMC_Port* port, void* context);

/* Handles the FPGA's interrupt, which is level-sensitive: the function must be called again while
 * the line is active. */
void UAV_irqHandler(void);
int UAV_irqEnabled(void);
