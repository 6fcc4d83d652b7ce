/* SPDX-License-Identifier: MIT
 *
 * radio: driver of the modem controller (hdl/modem), and the task that runs the link layer on it.
 *
 * Outgoing frames go into the circular output buffer in DDR3 (one buffer a frame, a fixed control
 * vector says which are in use); the controller reads them from there. Incoming packets are read
 * from the receive ring. The interrupt routine only notes the cause and wakes the task.
 */
#ifndef RADIO_H
#define RADIO_H

#include "base.h"
#include "link.h"

/* BD codes of the modem. */
typedef enum XBee_Baud {
    XBEE_BD_1200,
    XBEE_BD_2400,
    XBEE_BD_4800,
    XBEE_BD_9600,
    XBEE_BD_19200,
    XBEE_BD_38400,
    XBEE_BD_57600,
    XBEE_BD_115200
} XBee_Baud;

/* As in the paper's Figure 5: {XBEE_BD_115200, source, target}. A zero after that means the
 * default. */
typedef struct XBeeInitTypeDef {
    XBee_Baud baud;
    U16 source;  /* MY */
    U16 target;  /* DL */
    U8 channel;  /* CH, default 0x0C */
    U16 pan;     /* ID, default 0x3332 */
    U16 guardMs; /* guard time of the modem as it is now, default 1000 */
    /* EE, KY: 16 bytes that every modem of the network has; 0: in the clear. A frame may then have
     * LINK_MAX_ENCRYPTED bytes (Link_limitFrame); without the option LINK_LIMIT it is not heeded.
     */
    const U8* key;
} XBeeInitTypeDef;

typedef enum Radio_Status {
    RADIO_OK = 0,
    RADIO_NO_DEVICE, /* the slot is not a modem controller */
    RADIO_NO_MODEM,  /* no answer at any baud rate */
    RADIO_REFUSED    /* the modem refused a command: Radio_failedStep says which */
} Radio_Status;

typedef struct Radio_Counters {
    U32 framesSent, framesReceived;
    U32 bytesCopiedOut, bytesCopiedIn; /* over the FSMC */
    U32 ringFull;                      /* frames that had to wait for a buffer */
    U32 interrupts;
    U32 hardwareOverruns, framingErrors;
} Radio_Counters;

/* DDR3 addresses of the rings, each 2 KiB and a multiple of 128. */
typedef struct Radio_Memory {
    U32 transmitRing, receiveRing;
} Radio_Memory;

/* Sets the controller and the modem up; blocks the calling task (about 4 s with default guard
 * times). */
Radio_Status xbeeInit(const XBeeInitTypeDef* conf, const Radio_Memory* memory);

/* The AT step that failed, as in the modem's STATUS.STEP. */
U32 Radio_failedStep(void);

/* Link_Port.transmit: copies a frame to the ring. 0 taken, 1 no buffer free. */
int Radio_transmit(void* context, const U8* frame, U32 size);

/* Takes every packet out of the receive ring and feeds it to `link`. Returns the number of packets.
 */
U32 Radio_receive(Link* link, U32 nowUs);

/* Interrupt routine part: reads and clears the modem's events; non-zero when there is work for the
 * task. */
U32 Radio_interrupt(void);

const Radio_Counters* Radio_counters(void);

#endif
