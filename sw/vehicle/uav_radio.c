/* SPDX-License-Identifier: MIT
 *
 * uav_radio: the FPGA's interrupt, the radio task, its links with a ground or two and another
 * vehicle, the fellow, and what IceC's endpoint needs from it.
 */
#include "link_broadcast.h"
#include "map_regs.h"
#include "radio.h"
#include "system_regs.h"
#include "uav.h"
#include "uav_keys.h"
#include "uav_private.h"

#include <string.h>

#define BYTE_TIME_US16 1440U /* 111,111 baud */
#define DOWN_LIMIT 15000000U /* us without a link: the modem may have lost its settings then */
#define MOST_UNANSWERED 2U   /* packets that the modem has */
#define FIRST_GROUND 0x0000U /* its address */
/* The smaller links: bytes of the queue and of a message that comes, fragments in flight. */
#define SECOND_SENDS 8192U
#define SECOND_TAKES 1024U
#define SECOND_WINDOW 16U
#define FELLOW_SENDS 1024U
#define FELLOW_TAKES 512U
#define FELLOW_WINDOW 4U

Link uav_link;
OS_EVENT* uav_radioWork;
const U8* uav_modemKey;
U16 uav_guardMs;
U8 uav_wire;
U8 uav_transparent;

static XBeeATEndpoint endpoint;
static OS_EVENT* linkMutex;
static OS_EVENT* iceEvent;
static U8 isAnswered; /* the radio answers for each packet */
static U32 now;       /* time of the radio task's present turn, in us */

/* The links of the second ground and of the fellow, which a vehicle may have in API mode only: it
 * tells them apart by their addresses. A second ground calls by itself and is not sought, a fellow
 * only while this vehicle calls it. */
static Link secondLink, fellowLink;
static Link_Buffers firstBuffers;
static LINK_BUFFERS(SECOND_SENDS, SECOND_TAKES, SECOND_WINDOW) secondBuffers;
static LINK_BUFFERS(FELLOW_SENDS, FELLOW_TAKES, FELLOW_WINDOW) fellowBuffers;

/* The grounds by their numbers; those that there are not have no link. */
typedef struct Peer {
    Link* link;
    U16 address;
} Peer;
static Peer peers[UAV_GROUNDS] = {{&uav_link, FIRST_GROUND}};
static U8 hasOthers; /* than the first ground */
static U8 turn;      /* the one that is polled first */
static U8 areUp;     /* grounds with a session, a bit each */
static U8 isSpecial; /* there are others, or a session whose key may have to be confirmed */
static U8 receiver;  /* of packets (receivers) */
static U8 toAll[LINK_MAX_FRAME]; /* a call to all vehicles, and its bytes while it waits; else 0 */
static U8 toAllSize;

U32 UAV_nowUs(void) {
    return OSTimeGet() * (1000000U / OS_TICKS_PER_SEC);
}

static void lockLink(void* context) {
    INT8U error;
    (void)context;
    OSMutexPend(linkMutex, 0, &error);
}

static void unlockLink(void* context) {
    (void)context;
    (void)OSMutexPost(linkMutex);
}

static void kick(void* context) {
    (void)context;
    (void)OSSemPost(uav_radioWork);
}

static int waitEvent(void* context, Ice_Int timeoutMs) {
    INT8U error;
    (void)context;
    OSSemPend(iceEvent, (INT32U)timeoutMs, &error);
    return error == OS_ERR_NONE;
}

static void signalEvent(void* context) {
    (void)context;
    (void)OSSemPost(iceEvent);
}

static U32 nowMsOf(void* context) {
    (void)context;
    return OSTimeGet() * (1000U / OS_TICKS_PER_SEC);
}

static const XBeeATEndpoint_Port endpointPort = {lockLink,  unlockLink,  kick,
                                                 waitEvent, signalEvent, nowMsOf};

/* Hands a packet over; in transparent mode, which serves the first ground only, while at most one
 * waits for the line. So the link layer knows how fast the modem is, and chooses late what goes
 * next. */
static int transmit(void* peer, const U8* frame, U32 size) {
    U32 wait, ground;
    if (!isAnswered)
        return Radio_waiting() > 1U || Radio_transmit(0, frame, size);
    wait = Link_randomWait(&uav_link);
    for (ground = 1; areUp >> ground; ++ground)
        if (areUp >> ground & 1) {
            const U32 other = Link_randomWait(peers[ground].link);
            wait = other > wait ? other : wait;
        }
    Radio_setWait(wait);
    Radio_setTarget(((const Peer*)peer)->address);
    return Radio_transmit(0, frame, size);
}

static int groundOf(const void* peer) {
    return (int)((const Peer*)peer - peers);
}

static int onMessage(void* peer, int channel, const U8* data, U32 size) {
    return XBeeATEndpoint_onMessage(&endpoint, groundOf(peer) * LINK_CHANNELS + channel, data,
                                    size);
}

static void onChannel(void* peer, int channel, int isOpen) {
    XBeeATEndpoint_onChannel(&endpoint, groundOf(peer) * LINK_CHANNELS + channel, isOpen);
}

static void onState(void* peer, Link_State state) {
    const U32 ground = (U32)groundOf(peer);
    areUp = (U8)((areUp & ~(1U << ground)) | (U32)(state == LINK_STATE_UP) << ground);
    isSpecial = 1;
}

static const Link_Port port = {transmit, UAV_random, onMessage, onChannel, onState, 0, 0};
static const Link_Config configs[UAV_GROUNDS] = {
    {&port, &peers[0], BYTE_TIME_US16, LINK_USE(firstBuffers)},
    {&port, &peers[UAV_SECOND], BYTE_TIME_US16, LINK_USE(secondBuffers)},
    {&port, &peers[UAV_FELLOW], BYTE_TIME_US16, LINK_USE(fellowBuffers)}};

/* Adds the second ground or the fellow, if the vehicle has one. */
static void addPeer(int ground, Link* link) {
    Peer* peer = &peers[ground];
    const U32 address = UAV_addressOf(ground);
    peer->link = 0;
    if (address == UAV_NO_GROUND)
        return;
    peer->link = link;
    peer->address = (U16)address;
    hasOthers = 1;
    Link_init(peer->link, &configs[ground]);
    Link_shareRadio(peer->link, &uav_link);
    (void)UAV_giveKeys(ground, peer->link);
}

int UAV_initRadio(void) {
    INT8U error;
    uav_radioWork = OSSemCreate(0);
    iceEvent = OSSemCreate(0);
    linkMutex = OSMutexCreate(PRIO_MUTEX, &error);
    areUp = hasOthers = toAllSize = 0;
    Link_init(&uav_link, &configs[0]);
    addPeer(UAV_SECOND, &secondLink);
    addPeer(UAV_FELLOW, &fellowLink);
    return UAV_giveKeys(0, &uav_link) || UAV_isOpen();
}

void UAV_useRadio(Ice_CommunicatorPtr ic) {
    int ground;
    XBeeATEndpoint_init(ic, "xbee-at", &endpoint, &uav_link, (U16)UAV_address(), &endpointPort, 0);
    for (ground = UAV_SECOND; ground < UAV_GROUNDS; ++ground)
        if (peers[ground].link)
            XBeeATEndpoint_addGround(&endpoint, ground, peers[ground].link, peers[ground].address);
    if (peers[UAV_FELLOW].link)
        XBeeATEndpoint_setVehicle(&endpoint, UAV_FELLOW, UAV_hasGroundsPart());
}

int UAV_groundOf(const Ice_Current* current) {
    return current->connection / LINK_CHANNELS;
}

int UAV_nextKey(int ground, const U8* key) {
    int isSet;
    lockLink(0);
    isSet = UAV_setNextKey(ground, peers[ground].link, key);
    unlockLink(0);
    return isSet;
}

static void onAnswer(int isDelivered) {
    Link_answer(&uav_link, isDelivered, now);
}

static void setUpModem(void) {
    XBeeInitTypeDef xbeeConf = {RADIO_250000, 0x0001, 0x0000, 0, 0, 0, 0, onAnswer};
    static const Radio_Memory rings = {UAV_TRANSMIT_RING, UAV_RECEIVE_RING};
    const Peer* peer;
    if (uav_wire || uav_transparent) {
        xbeeConf.baud = uav_wire ? RADIO_WIRE_115200 : XBEE_BD_115200;
        xbeeConf.onAnswer = 0;
    }
    xbeeConf.source = (U16)UAV_address();
    xbeeConf.key = uav_modemKey;
    xbeeConf.guardMs = uav_guardMs;
    /* The vehicle flies on without its modem, and tries again. */
    while (xbeeInit(&xbeeConf, &rings) != RADIO_OK)
        OSTimeDly(OS_TICKS_PER_SEC);
    isAnswered = (U8)Radio_answers();
    receiver = (U8)(isAnswered + (isAnswered && UAV_isOfGroup()));
    for (peer = peers; peer < peers + UAV_GROUNDS; ++peer)
        if (peer->link) {
            Link_limitFrame(peer->link, uav_modemKey ? LINK_MAX_ENCRYPTED : LINK_MAX_FRAME);
            Link_expectAnswers(peer->link, isAnswered ? MOST_UNANSWERED : 0U);
        }
}

static void onPacket(void* context, const U8* bytes, U32 size) {
    (void)context;
    Link_receive(&uav_link, bytes, size, now);
}

/* Gives a packet to the link of the ground that it is from; nobody else is served. */
static void onPacketOf(void* context, const U8* bytes, U32 size) {
    const U32 source = Radio_source();
    const Peer* peer = peers;
    (void)context;
    while (peer->address != source || !peer->link)
        if (++peer == peers + UAV_GROUNDS)
            return;
    Link_receive(peer->link, bytes, size, now);
}

/* Takes a call to all vehicles, once. While one waits for IceC no other is looked at: a later copy
 * of that may come in time. */
static void onAnyPacket(void* context, const U8* bytes, U32 size) {
    if (*bytes != LINK_BROADCAST) {
        onPacketOf(context, bytes, size);
    } else if (!toAllSize && size <= sizeof toAll) {
        memcpy(toAll, bytes, size);
        size = UAV_openBroadcast(toAll, size);
        if (size && Ice_markBroadcast(toAll + LINK_BROADCAST_HEAD, (Ice_Int)size))
            toAllSize = isSpecial = (U8)size;
    }
}

static const Radio_OnPacket receivers[] = {onPacket, onPacketOf, onAnyPacket};

/* Does what is due on all links, of which each comes first in turn. Returns the time until it must
 * be called again, in us. */
static U32 pollSpecial(void) {
    U32 wait = 0xFFFFFFFFU, due;
    int left, ground = turn;
    if (peers[UAV_FELLOW].link && isAnswered)
        XBeeATEndpoint_seek(&endpoint, UAV_FELLOW, now);
    for (left = UAV_GROUNDS; left; --left) {
        Link* link = peers[ground].link;
        if (link) {
            Link_poll(link, now);
            (void)UAV_confirmKey(ground, link);
            due = Link_deadline(link, now);
            wait = due < wait ? due : wait;
        }
        ground = (ground + 1) % UAV_GROUNDS;
    }
    turn = (U8)((turn + 1U) % UAV_GROUNDS);
    if (toAllSize && XBeeATEndpoint_onMessage(&endpoint, XBEE_OWN_CHANNEL,
                                              toAll + LINK_BROADCAST_HEAD, toAllSize) == 0)
        toAllSize = 0;
    isSpecial = (U8)(hasOthers | toAllSize); /* the endpoint kicks this task when it takes one */
    return wait;
}

void UAV_radioTask(void* argument) {
    INT8U error;
    U32 upAt;
    (void)argument;
    setUpModem();
    upAt = UAV_nowUs();
    lockLink(0);
    Link_start(&uav_link, UAV_nowUs());
    unlockLink(0);
    for (;;) {
        U32 wait;
        lockLink(0);
        now = UAV_nowUs();
        (void)Radio_receive(receivers[receiver], 0);
        if (isSpecial) {
            wait = pollSpecial();
        } else {
            Link_poll(&uav_link, now);
            wait = Link_deadline(&uav_link, now);
        }
        if (areUp)
            upAt = now;
        unlockLink(0);
        if (now - upAt > DOWN_LIMIT) {
            setUpModem();
            upAt = UAV_nowUs();
        }
        /* The wait is at least a tick, so that a full ring is not polled. */
        wait = wait > 1000000U ? OS_TICKS_PER_SEC : wait * OS_TICKS_PER_SEC / 1000000U;
        OSSemPend(uav_radioWork, wait ? wait : 1U, &error);
    }
}

void UAV_irqHandler(void) {
    U32 lines[2];
    lines[0] = FSMC_read(MAP_SLOT_SYSTEM, SYSTEM_IRQ_LO);
    lines[1] = MAP_SLOT_COUNT > 32U ? FSMC_read(MAP_SLOT_SYSTEM, SYSTEM_IRQ_HI) : 0U;
    if (lines[0] >> MAP_SLOT_MODEM & 1U) {
        (void)Radio_interrupt();
        (void)OSSemPost(uav_radioWork);
    }
    UAV_coresInterrupt(lines);
}

static OS_EVENT* callDone[ICE_CALLS + 1]; /* the last is for tasks that want to receive */
static OS_EVENT* iceMutex[2];             /* by ICE_LOCK_STATE and ICE_LOCK_SEND */

void UAV_initIceOs(void) {
    INT8U error;
    int c;
    iceMutex[ICE_LOCK_STATE] = OSMutexCreate(PRIO_MUTEX + 1U, &error);
    iceMutex[ICE_LOCK_SEND] = OSMutexCreate(PRIO_RADIO + 1U, &error);
    for (c = 0; c <= ICE_CALLS; ++c)
        callDone[c] = OSSemCreate(0);
}

static void lockIce(void* context, int which) {
    INT8U error;
    (void)context;
    OSMutexPend(iceMutex[which], 0, &error);
}

static void unlockIce(void* context, int which) {
    (void)context;
    (void)OSMutexPost(iceMutex[which]);
}

static int waitCall(void* context, int slot, Ice_Int timeoutMs) {
    INT8U error;
    (void)context;
    OSSemPend(callDone[slot], (INT32U)timeoutMs, &error);
    return error == OS_ERR_NONE;
}

static void wakeCall(void* context, int slot) {
    (void)context;
    (void)OSSemPost(callDone[slot]);
}

static int taskOf(void* context) {
    (void)context;
    return OSTaskPrio();
}

const Ice_Os uav_iceOs = {lockIce, unlockIce, waitCall, wakeCall, taskOf};
