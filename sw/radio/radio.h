/* SPDX-License-Identifier: MIT
 *
 * radio: driver of the modem controller (hdl/modem).
 *
 *     static const XBeeInitTypeDef conf = {XBEE_BD_115200, 0x0001, 0x0000, 0, 0, 0, 0, 0};
 *     static const Radio_Memory rings = {0x0000, 0x1000};
 *     if (xbeeInit(&conf, &rings) != RADIO_OK)
 *         ...                                     (see Radio_failedStep)
 *     for (;;) {
 *         Radio_receive(onPacket, 0);             (calls onPacket for each packet)
 *         Radio_transmit(0, frame, size);         (returns 0 if the frame was accepted)
 *         OSSemPend(work, ...);                   (the interrupt routine posts it)
 *     }
 *
 * The driver copies each outgoing frame into a buffer of the output ring in DDR3, from which the
 * controller sends it. It copies incoming packets from the receive ring. All functions except
 * Radio_interrupt must be called by the same task.
 */
#pragma once

#include "base.h"

#ifndef RADIO_API /* 1: API mode can be selected; 0: the code for API mode is left out */
#define RADIO_API 1
#endif

/* Baud rates, with the codes of the modem's command BD. The names XBEE_BD_..., XBeeInitTypeDef and
 * xbeeInit come from the paper (Figure 5). */
typedef enum Radio_Baud {
    XBEE_BD_1200,
    XBEE_BD_2400,
    XBEE_BD_4800,
    XBEE_BD_9600,
    XBEE_BD_19200,
    XBEE_BD_38400,
    XBEE_BD_57600,
    XBEE_BD_115200,
    /* baud rate for API mode; without API mode, the rate is 111,111 */
    RADIO_250000 = 0x3D090,
    RADIO_WIRE_115200 = 0x80007 /* a cable to a serial port replaces the modem, at 111,111 baud */
} Radio_Baud;

/* Called with the modem's result for each sent packet: delivered to the target's modem, or lost. */
typedef void (*Radio_OnAnswer)(int isDelivered);

/* Settings of the modem. The first three are in the paper. For each of the others, 0 selects
 * its default. */
typedef struct XBeeInitTypeDef {
    Radio_Baud baud;
    U16 source;  /* MY: address of this modem */
    U16 target;  /* DL: address of the ground station's modem */
    U8 channel;  /* CH: radio channel; default 0x0C */
    U16 pan;     /* ID: network; default 0x3332 */
    U16 guardMs; /* guard time around +++ that the modem has now, ms; default 1000 */
    /* KY: AES key of the network, 16 bytes. 0: the modem does not encrypt (EE is 0). An encrypted
     * packet carries 95 bytes instead of 100 (Link_limitFrame). */
    const U8* key;
    /* function that Radio_receive calls for each sent packet, oldest first; 0 selects transparent
     * mode. With a function, API mode is used, provided that controller and modem support it
     * (Radio_answers). In API mode, each received packet has a source address (Radio_source). */
    Radio_OnAnswer onAnswer;
} XBeeInitTypeDef;

typedef enum Radio_Status {
    RADIO_OK = 0,
    RADIO_NO_DEVICE, /* the slot does not contain a modem controller */
    RADIO_NO_MODEM,  /* the modem did not answer at any baud rate */
    RADIO_REFUSED    /* the modem rejected a command; see Radio_failedStep */
} Radio_Status;

/* Counters since the start. */
typedef struct Radio_Counters {
    U32 framesSent, framesReceived;
    /* number of bytes copied over the FSMC to DDR3 and from DDR3 */
    U32 bytesCopiedOut, bytesCopiedIn;
    /* number of frames that were not copied because no buffer was free */
    U32 ringFull;
    U32 interrupts;                      /* number of calls of Radio_interrupt */
    U32 hardwareOverruns, framingErrors; /* counters of the controller (docs/modem.md) */
    /* API mode: number of packets that were delivered and lost, as reported by the modem */
    U32 delivered, lost;
    U8 signal; /* API mode: signal strength of the last packet (RSSI), in -dBm */
} Radio_Counters;

/* DDR3 byte addresses of the rings. Each ring has 2 KiB; its address is a multiple of 2048. */
typedef struct Radio_Memory {
    U32 transmitRing, receiveRing;
} Radio_Memory;

/* Resets the modem, and sets up the controller and the modem. Blocks the calling task: about 4 s
 * with a guard time of 1 s, up to 40 s if no modem answers, and half a second with a cable instead
 * of a modem. `memory` is copied.
 */
Radio_Status xbeeInit(const XBeeInitTypeDef* conf, const Radio_Memory* memory);

/* Returns whether API mode is in use: xbeeInit has selected it, and controller and modem support
 * it. */
int Radio_answers(void);

/* Returns the step of the set-up that failed; valid after RADIO_NO_MODEM or RADIO_REFUSED. Steps
 * are numbered as in the controller's STATUS.STEP (docs/modem.md). */
U32 Radio_failedStep(void);

/* Copies a frame of 1..100 bytes into the output ring. Returns 0; returns 1 if no buffer is free.
 * `context` is not used; it gives the function the type of Link_Port.transmit. */
int Radio_transmit(void* context, const U8* frame, U32 size);

/* API mode: sets the modem's RN, the exponent of its random wait, for packets that are queued
 * later. Set-up sets RN to RADIO_WAIT. */
#define RADIO_WAIT 2U
void Radio_setWait(U32 exponent);

/* API mode: sets the target address of the following packets. */
void Radio_setTarget(U16 target);

/* API mode: returns the source address of the current packet. Only onPacket may call this
 * function. */
U16 Radio_source(void);

/* Returns the number of packets in the output ring that have not been sent yet. */
U32 Radio_waiting(void);

/* Called with a received packet; `bytes` are valid only during the call. */
typedef void (*Radio_OnPacket)(void* context, const U8* bytes, U32 size);

/* Removes all packets from the receive ring, oldest first, and calls onPacket(context, ...) for
 * each. Returns the number of packets. */
U32 Radio_receive(Radio_OnPacket onPacket, void* context);

/* Acknowledges the controller's interrupt: reads, clears and returns the controller's events
 * (MODEM_EVENT_...). Interrupt routines call this function. If the result is not 0, the task must
 * then call Radio_receive. */
U32 Radio_interrupt(void);

/* Returns the counters, which are never reset. */
const Radio_Counters* Radio_counters(void);
