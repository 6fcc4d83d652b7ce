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

/* The modem's AES key: 16 bytes, which must stay valid. 0, the initial value, disables
 * encryption. It is read when the tasks start. The keys of the link are set by the board
 * (uav_keys.h). */
extern const U8* uav_modemKey;

/* Current guard time of the modem, ms. 0, the initial value, means the factory setting, 1000 ms. */
extern U16 uav_guardMs;

/* 1 if a cable to the ground's serial port replaces the modems; 0, the initial value, with a
 * modem. It is read when the tasks start. */
extern U8 uav_wire;

/* 1 selects transparent mode of the modem. 0, the initial value, selects API mode, in which the
 * modem reports for each packet whether the ground's modem has received it. It is read when the
 * tasks start. */
extern U8 uav_transparent;

typedef enum UAV_Status {
    UAV_OK,
    UAV_NO_FPGA, /* the FPGA does not respond */
    UAV_NO_KEY   /* the vehicle was neither given a key nor opened */
} UAV_Status;

/* Creates the tasks. Call it between OSInit and OSStart, after UAV_useBoard. The tasks exist only
 * if the result is UAV_OK. */
UAV_Status UAV_start(const FSMC_Port* port, void* context);

/* Handles the FPGA's interrupt, which is level-sensitive. */
void UAV_irqHandler(void);
int UAV_irqEnabled(void);
