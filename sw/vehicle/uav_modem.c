/* SPDX-License-Identifier: MIT
 *
 * uav_modem: handles the FPGA's interrupt, and runs the radio task. The task configures the modem,
 * passes its packets to the links, polls the links, and configures the modem again if no link comes
 * up.
 */
#include "uav_modem.h"
#include "map_regs.h"
#include "system_regs.h"
#include "uav.h"
#include "uav_backup.h"
#include "uav_cores.h"
#include "uav_fleet.h"
#include "uav_keys.h"
#include "uav_links.h"
#include "uav_os.h"
#include "uav_peers.h"

/* time without a link after which the modem is configured again, because it may have lost its
 * settings, us */
#define DOWN_LIMIT 15000000U

U16 uav_guardMs;
U8 uav_wire;
U8 uav_transparent;

static Radio_OnPacket receiver;
static Link_Buffers buffers;
static U8 turn;      /* index of the peer that is polled first */
static U8 hasOthers; /* 1 if there are peers other than the first ground station */

static const Link_Config config = {&uav_linkPort, &uav_peers[UAV_GROUND], UAV_BYTE_TIME_US16,
                                   LINK_USE(buffers)};

int UAV_initRadio(void) {
    UAV_initState();
    UAV_initEndpointOs();
    UAV_resetLinks();
    Link_init(&uav_link, &config);
    hasOthers = (U8)UAV_addPeers();
    return UAV_giveKeys(UAV_GROUND, &uav_link) || UAV_isOpen();
}

void UAV_useRadio(Ice_CommunicatorPtr ic) {
    XBeeATEndpoint_init(ic, "xbee-at", &uav_endpoint, &uav_link, (U16)UAV_address(),
                        &uav_endpointPort, 0);
    UAV_usePeers();
}

U32 UAV_nowUs(void) {
    return OSTimeGet() * (1000000U / OS_TICKS_PER_SEC);
}

static void onAnswer(int isDelivered) {
    Link_answer(&uav_link, isDelivered, uav_now);
}

static void onPacket(void* context, const U8* bytes, U32 size) {
    (void)context;
    Link_receive(&uav_link, bytes, size, uav_now);
}

static void setUpModem(void) {
    XBeeInitTypeDef xbeeConf = {RADIO_250000, 0x0001, UAV_GROUND_ADDRESS, 0, 0, 0, 0, onAnswer};
    static const Radio_Memory rings = {UAV_TRANSMIT_RING, UAV_RECEIVE_RING};
    if (uav_wire || uav_transparent) {
        xbeeConf.baud = uav_wire ? RADIO_WIRE_115200 : XBEE_BD_115200;
        xbeeConf.onAnswer = 0;
    }
    xbeeConf.source = (U16)UAV_address();
    xbeeConf.key = uav_modemKey;
    xbeeConf.guardMs = uav_guardMs;
    /* If the modem does not answer, the vehicle continues to fly, and the set-up is repeated. */
    while (xbeeInit(&xbeeConf, &rings) != RADIO_OK)
        OSTimeDly(OS_TICKS_PER_SEC);
    uav_isAnswered = (U8)Radio_answers();
    receiver = uav_isAnswered ? UAV_receiver() : onPacket;
    UAV_limitLinks();
}

/* Polls all links, starting with a different one in each call. Returns the time until the next
 * poll, us. */
static U32 pollAll(void) {
    U32 wait = 0xFFFFFFFFU, due;
    int left, role = turn;
    if (uav_isAnswered)
        UAV_dialVehicle();
    for (left = uav_peerCount; left; --left) {
        Link* link = uav_peers[role].link;
        if (link) {
            Link_poll(link, uav_now);
            (void)UAV_confirmKey(role, link);
            due = Link_deadline(link, uav_now);
            wait = due < wait ? due : wait;
        }
        role = (role + 1) % uav_peerCount;
    }
    turn = (U8)((turn + 1U) % uav_peerCount);
    uav_pollsAll = (U8)(UAV_offerCall() | hasOthers);
    return wait;
}

static U32 pollLinks(void) {
    if (uav_pollsAll)
        return pollAll();
    Link_poll(&uav_link, uav_now);
    return Link_deadline(&uav_link, uav_now);
}

void UAV_radioTask(void* argument) {
    INT8U error;
    U32 upAt;
    (void)argument;
    setUpModem();
    upAt = UAV_nowUs();
    UAV_lockLink(0);
    Link_start(&uav_link, UAV_nowUs());
    UAV_unlockLink(0);
    for (;;) {
        U32 wait;
        UAV_lockLink(0);
        uav_now = UAV_nowUs();
        (void)Radio_receive(receiver, 0);
        wait = pollLinks();
        if (UAV_isUp())
            upAt = uav_now;
        UAV_unlockLink(0);
        if (uav_now - upAt > DOWN_LIMIT) {
            setUpModem();
            upAt = UAV_nowUs();
        }
        /* Waits at least one tick; otherwise the task would not let others run while a ring is
         * full. */
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
    if ((lines[0] & ~(1U << MAP_SLOT_MODEM)) | lines[1])
        UAV_coresInterrupt(lines);
}
