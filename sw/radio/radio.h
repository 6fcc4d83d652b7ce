/* SPDX-License-Identifier: MIT
 *
 * radio: driver of the modem controller (hdl/modem).
 *
 *     static const XBeeInitTypeDef conf = {XBEE_BD_115200, 0x0001, 0x0000, 0, 0, 0, 0, 0};
 *     static const Radio_Memory rings = {0x0000, 0x1000};
 *     if (xbeeInit(&conf, &rings) != RADIO_OK)
 *         ...                                     (Radio_failedStep says where)
 *     for (;;) {
 *         Radio_receive(onPacket, 0);             (calls onPacket for each packet)
 *         Radio_transmit(0, frame, size);         (0: it is on its way)
 *         OSSemPend(work, ...);                   (the interrupt routine posts it)
 *     }
 *
 * The driver copies outgoing frames into a ring of buffers in DDR3, one frame a buffer, from which
 * the controller sends them; it copies incoming packets out of the receive ring. All functions but
 * Radio_interrupt belong to one task.
 */
#pragma once

#include "base.h"

#ifndef RADIO_API /* 1: API mode can be chosen; 0: it is left out */
#define RADIO_API 1
#endif

/* Baud rates, as the modem's BD command codes them. The names XBEE_BD_..., XBeeInitTypeDef and
 * xbeeInit are the paper's (Figure 5). */
typedef enum Radio_Baud {
    XBEE_BD_1200,
    XBEE_BD_2400,
    XBEE_BD_4800,
    XBEE_BD_9600,
    XBEE_BD_19200,
    XBEE_BD_38400,
    XBEE_BD_57600,
    XBEE_BD_115200,
    RADIO_250000 = 0x3D090,     /* in API mode; where the controller has none, 111,111 is taken */
    RADIO_WIRE_115200 = 0x80007 /* no modem: a wire to a serial port, at 111,111 baud as well */
} Radio_Baud;

/* Takes the modem's answer for a packet that was sent: the target's modem has it, or it is lost. */
typedef void (*Radio_OnAnswer)(int isDelivered);

/* Settings of the modem. The paper gives the first three; a zero in the others means the default.
 */
typedef struct XBeeInitTypeDef {
    Radio_Baud baud;
    U16 source;  /* MY, the own address */
    U16 target;  /* DL, the address of the ground's modem */
    U8 channel;  /* CH, default 0x0C */
    U16 pan;     /* ID, default 0x3332 */
    U16 guardMs; /* guard time around +++ as the modem has it now, default 1000 */
    /* KY, the network's AES key of 16 bytes; 0: EE is 0, nothing is encrypted. An encrypted packet
     * carries 95 bytes instead of 100 (Link_limitFrame). */
    const U8* key;
    /* 0: transparent mode. Else API mode, if controller and modem have it (Radio_answers):
     * Radio_receive calls this for each packet that was sent, oldest first, and each packet that
     * comes has a source (Radio_source), whoever it is. */
    Radio_OnAnswer onAnswer;
} XBeeInitTypeDef;

typedef enum Radio_Status {
    RADIO_OK = 0,
    RADIO_NO_DEVICE, /* the slot is not a modem controller */
    RADIO_NO_MODEM,  /* no answer at any baud rate */
    RADIO_REFUSED    /* the modem refused a command: Radio_failedStep says which */
} Radio_Status;

/* Counts since the start. */
typedef struct Radio_Counters {
    U32 framesSent, framesReceived;
    U32 bytesCopiedOut, bytesCopiedIn;   /* over the FSMC */
    U32 ringFull;                        /* frames that found no free buffer */
    U32 interrupts;                      /* calls of Radio_interrupt */
    U32 hardwareOverruns, framingErrors; /* as the controller counts them (docs/modem.md) */
    U32 delivered, lost;                 /* API mode: packets sent, by the modem's answers */
    U8 signal;                           /* API mode: RSSI of the last packet, -dBm */
} Radio_Counters;

/* DDR3 byte addresses of the rings; each ring has 2 KiB and begins at a multiple of 128. */
typedef struct Radio_Memory {
    U32 transmitRing, receiveRing;
} Radio_Memory;

/* Resets the modem and sets controller and modem up. Blocks the calling task: about 4 s with a
 * guard time of 1 s, up to 40 s where no modem answers, half a second for a wire. `memory` is
 * copied. */
Radio_Status xbeeInit(const XBeeInitTypeDef* conf, const Radio_Memory* memory);

/* Returns whether API mode was chosen by xbeeInit, and controller and modem have it. */
int Radio_answers(void);

/* Returns the step of the set-up that failed, after RADIO_NO_MODEM or RADIO_REFUSED, as STATUS.STEP
 * of the controller counts them (docs/modem.md). */
U32 Radio_failedStep(void);

/* Copies a frame of 1..128 bytes into the output ring. Returns 0, or 1 where no buffer is free.
 * `context` is not used: the function fits Link_Port.transmit. */
int Radio_transmit(void* context, const U8* frame, U32 size);

/* Sets the modem's RN, the exponent of its random wait, in API mode: behind the packets handed over
 * so far. Set-up leaves it at RADIO_WAIT. */
#define RADIO_WAIT 2U
void Radio_setWait(U32 exponent);

/* API mode: has the next packets go to this address. */
void Radio_setTarget(U16 target);

/* API mode: returns the address that the packet is from which onPacket is called with. */
U16 Radio_source(void);

/* Returns the packets in the output ring that have not left. They wait where the modem does. */
U32 Radio_waiting(void);

/* Takes a packet; `bytes` are valid during the call only. */
typedef void (*Radio_OnPacket)(void* context, const U8* bytes, U32 size);

/* Takes the packets out of the receive ring, oldest first, and calls onPacket(context, ...) for
 * each. Returns the number of packets. */
U32 Radio_receive(Radio_OnPacket onPacket, void* context);

/* Acknowledges the controller's interrupt. Returns the events that it reads and clears
 * (MODEM_EVENT_...); non-zero: there is work for the task. For interrupt routines. */
U32 Radio_interrupt(void);

/* Returns the counters, which go on counting. */
const Radio_Counters* Radio_counters(void);
