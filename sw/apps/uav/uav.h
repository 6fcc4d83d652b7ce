/* SPDX-License-Identifier: MIT
 *
 * uav: the application on the UAV, in the shape of the paper's Figure 5.
 */
#ifndef UAV_H
#define UAV_H

#include "fsmc.h"

/* The memory map of DDR3 (byte addresses). */
#define UAV_TRANSMIT_RING 0x00000000U
#define UAV_RECEIVE_RING 0x00001000U
#define UAV_FRAME 0x00100000U /* the camera's picture */
#define UAV_FRAME_HEADER \
    0x000FFF80U /* its width and height, two 32-bit words, written by the camera */

/* The modem's AES key, 16 bytes that stay valid; 0, as at first: it does not encrypt. Read when the
 * tasks start. The keys of the link are the board's (uav_keys.h). */
extern const U8* uav_modemKey;

/* Guard time of the radio's modem as it is, in ms; 0, as at first: the factory's 1000. */
extern U16 uav_guardMs;

typedef enum UAV_Status {
    UAV_OK,
    UAV_NO_FPGA, /* it does not answer */
    UAV_NO_KEY   /* the vehicle was neither given a key nor opened */
} UAV_Status;

/* Creates the tasks; call between OSInit and OSStart, after UAV_useBoard. Unless UAV_OK, there are
 * none. */
UAV_Status UAV_start(const FSMC_Port* port, void* context);

/* Returns how many accesses no register answered, or whose core hung until the
 * bridge gave up. */
U32 UAV_busErrors(void);

/* Handles the FPGA's interrupt, a level; tells whether it is unmasked. */
void UAV_irqHandler(void);
int UAV_irqEnabled(void);

#endif
