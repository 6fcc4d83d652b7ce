/* SPDX-License-Identifier: MIT
 *
 * uav: the application on the UAV, in the shape of the paper's Figure 5.
 */
#ifndef UAV_H
#define UAV_H

#include "fsmc.h"

/* Where things lie in DDR3 (byte addresses). */
#define UAV_TRANSMIT_RING 0x00000000U
#define UAV_RECEIVE_RING 0x00001000U
#define UAV_FRAME 0x00100000U  /* the camera's picture */
#define UAV_BOOTS 0x000FFF00U   /* counts boots, so that no two have the same nonces; any first value */
#define UAV_FRAME_HEADER 0x000FFF80U /* its width and height, two 32-bit words, written by the camera */
#define UAV_RESULT 0x00300000U /* the vision core's records */
#define UAV_RESULT_MAX 16384U  /* records that fit */

/* The radio's AES key, 16 bytes that stay valid; 0, as at first: in the clear. Read when the tasks start. */
extern const U8 *uav_radioKey;

/* Guard time of the radio's modem as it is, in ms; 0, as at first: the factory's 1000. */
extern U16 uav_guardMs;

/* Creates the tasks; call between OSInit and OSStart. 0: the FPGA does not answer, there are no tasks. */
int UAV_start(const Fsmc_Port *port, void *context);

/* Accesses that no register answered, or whose core hung until the bridge gave up: how many, and where the last
 * one was (slot * 16 + word, bit 16 for a write). */
U32 UAV_busErrors(void);
U32 UAV_busErrorPlace(void);

/* Where the next frame comes from: three buffers that a camera core fills, in DDR3 from `base` on, `stride` bytes from
 * one to the next; width 0, as at first: the picture at UAV_FRAME. */
typedef struct Uav_Frames {
    U32 base, stride, width, height;
} Uav_Frames;
void UAV_setFrames(U32 base, U32 stride, U32 width, U32 height);
const Uav_Frames *UAV_frames(void);

/* A frame was processed, with so many corners: it is counted, and the station is told. */
void UAV_frameDone(U32 corners);

/* Cores of ip/cores.list that are not in their slot, or in another version, or not served for want of room. */
U32 UAV_missingCores(void);

/* The FPGA's interrupt, a level; and whether it is unmasked. */
void UAV_irqHandler(void);
int UAV_irqEnabled(void);

#endif
