/* SPDX-License-Identifier: MIT
 *
 * uav: the application on the UAV, in the shape of the paper's Figure 5.
 */
#pragma once

#include "fsmc.h"

/* The memory map of DDR3 (byte addresses). */
#define UAV_TRANSMIT_RING 0x00000000U
#define UAV_RECEIVE_RING 0x00001000U
#define UAV_FRAME 0x00100000U /* the camera's picture */
#define UAV_FRAME_HEADER \
    0x000FFF80U /* width and height of the frame, two 32-bit words, written by the camera */

/* The modem's AES key, 16 bytes that stay valid; 0, the initial value: no encryption. Read when the
 * tasks start. The board gives the link's keys (uav_keys.h). */
extern const U8* uav_modemKey;

/* The modem's present guard time in ms; 0, the initial value: the factory's 1000. */
extern U16 uav_guardMs;

/* 1: a cable to the ground's serial port replaces the modems; 0, the initial value: a modem. Read
 * when the tasks start. */
extern U8 uav_wire;

/* 1: transparent mode of the modem; 0, the initial value: API mode, with a report for each packet
 * whether the ground's modem has received it. Read when the tasks start. */
extern U8 uav_transparent;

typedef enum UAV_Status {
    UAV_OK,
    UAV_NO_FPGA, /* the FPGA does not respond */
    UAV_NO_KEY   /* the vehicle was neither given a key nor opened */
} UAV_Status;

/* Creates the tasks. Call it between OSInit and OSStart, after UAV_useBoard. Only with UAV_OK there
 * are tasks. */
UAV_Status UAV_start(const FSMC_Port* port, void* context);

/* Handles the FPGA's interrupt, which is level-sensitive. */
void UAV_irqHandler(void);
int UAV_irqEnabled(void);
