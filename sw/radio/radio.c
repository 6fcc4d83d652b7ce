/* SPDX-License-Identifier: MIT
 *
 * radio: sets up the controller and the modem, and manages the output ring and the receive ring.
 */
#include "radio.h"
#include "fsmc.h"
#include "map_regs.h"
#include "modem_regs.h"
#include "ucos_ii.h"

#define BUFFERS MODEM_RING_BUFFERS
/* Number of buffers of the output ring that are in use. */
#define BUSY (BUFFERS - (get(MODEM_TX_STATE) & MODEM_TX_STATE_FREE_MASK))
#define DEFAULT_CHANNEL 0x0CU
#define DEFAULT_PAN 0x3332U
#define DEFAULT_GUARD_MS 1000U
#define ANSWERS (RADIO_API && radio.onAnswer)
#define POLL_TICKS (OS_TICKS_PER_SEC / 100U)
#define MODE_STEP 13U /* number of the set-up step that sends ATAP */

/* API mode: each buffer holds the contents of a frame; the first byte is its type. In a packet to
 * send, five bytes, including the type, precede the data.
 *     01 ID TARGET TARGET 00 DATA...          packet to send
 *     89 ID STATUS                            result; 0: received by the target's modem
 *     08 00 'R' 'N' VALUE                     a setting, without a reply
 *     81 SOURCE SOURCE RSSI OPTIONS DATA...   received packet */
#define TRANSMIT 0x01U
#define COMMAND 0x08U
#define STATUS 0x89U
#define PACKET 0x81U
#define HEAD 5U
#define ID_BASE                                                                           \
    0x80U /* bit that is set in all ids, so that no id is 0; id 0 would request no result \
           */
#define ID_MASK 0x7FU
#define SILENT_TICKS (3U * OS_TICKS_PER_SEC) /* time-out for the modem's result of a packet */

typedef enum BufferState { BUFFER_FREE, BUFFER_SENDING } BufferState;

static struct {
    /* control vector of the paper: state of each buffer in DDR3 */
    BufferState output[BUFFERS];
    /* index of the oldest buffer that is being sent; number of buffers that are being sent */
    U32 head, used;
    Radio_Memory memory;
    Radio_Counters counters;
    U32 failedStep;
    Radio_OnAnswer onAnswer; /* callback for results; 0 in transparent mode */
    U16 target, source;      /* target of the next packet; source of the last packet received */
    U8 handed, answered;     /* packets queued and packets with a result, both modulo 256 */
    U8 wait;                 /* RN */
    U32 handedAt;            /* time at which the last packet was handed to the controller */
} radio;

static U32 get(U32 word) {
    return FSMC_read(MAP_SLOT_MODEM, word);
}

static void set(U32 word, U32 value) {
    FSMC_write(MAP_SLOT_MODEM, word, value);
}

/* Writes the words of the AES key to the controller, the highest word first. */
static void setKey(const U8* key) {
    U32 i;
    for (i = 0; i < 16U; i += 4U)
        set(MODEM_KEY,
            (U32)key[i] << 24 | (U32)key[i + 1U] << 16 | (U32)key[i + 2U] << 8 | key[i + 3U]);
}

static void setUpController(const XBeeInitTypeDef* conf) {
    U32 guard = conf->guardMs ? conf->guardMs : DEFAULT_GUARD_MS;
    U32 encrypt = conf->key ? 1U << MODEM_NET_ENCRYPT_LSB : 0U;
    U32 api = ANSWERS ? 1U << MODEM_NET_API_LSB : 0U;
    set(MODEM_CONTROL, MODEM_CONTROL_RESET_MODEM_MASK);
    OSTimeDly(OS_TICKS_PER_SEC / 2U); /* waits for the modem, which needs 50 to 500 ms to start */
    set(MODEM_BAUD, guard << MODEM_BAUD_GUARD_MS_LSB |
                        (RADIO_API && !api && conf->baud == RADIO_250000 ? (U32)XBEE_BD_115200
                                                                         : (U32)conf->baud));
    set(MODEM_ADDR, (U32)conf->target << MODEM_ADDR_TARGET_LSB | conf->source);
    set(MODEM_NET, (U32)(conf->pan ? conf->pan : DEFAULT_PAN) << MODEM_NET_PAN_LSB | encrypt | api |
                       (conf->channel ? conf->channel : DEFAULT_CHANNEL));
    if (encrypt)
        setKey(conf->key);
    set(MODEM_TX_BASE, radio.memory.transmitRing);
    set(MODEM_RX_BASE, radio.memory.receiveRing);
    set(MODEM_MASK, 0);
    set(MODEM_EVENT, 0xFFFFFFFFU);
    set(MODEM_CONTROL, MODEM_CONTROL_CONFIGURE_MASK);
}

Radio_Status xbeeInit(const XBeeInitTypeDef* conf, const Radio_Memory* memory) {
    U32 events = 0;
    U32 i;
    if (get(MODEM_ID) >> 16 != MODEM_ID_VALUE >> 16)
        return RADIO_NO_DEVICE;
    radio.memory = *memory;
    if (RADIO_API) {
        radio.onAnswer = get(MODEM_STATUS) & MODEM_STATUS_API_MASK ? conf->onAnswer : 0;
        radio.target = conf->target;
        radio.handed = radio.answered = 0; /* the modem was reset, so its packets are lost */
        radio.wait = RADIO_WAIT;
    }
    radio.head = radio.used = 0;
    for (i = 0; i < BUFFERS; ++i)
        radio.output[i] = BUFFER_FREE;
    setUpController(conf);
    /* The configuration always ends: after about 40 s at the latest, when all rates have been
     * tried. */
    while (!(events & (MODEM_EVENT_CONFIGURED_MASK | MODEM_EVENT_CONFIGURE_FAILED_MASK))) {
        OSTimeDly(POLL_TICKS);
        events = get(MODEM_EVENT);
    }
    set(MODEM_EVENT, events);
    if (events & MODEM_EVENT_CONFIGURE_FAILED_MASK) {
        radio.failedStep = (get(MODEM_STATUS) & MODEM_STATUS_STEP_MASK) >> MODEM_STATUS_STEP_LSB;
        if (ANSWERS && radio.failedStep == MODE_STEP) {
            XBeeInitTypeDef transparent = *conf;
            transparent.onAnswer = 0;
            return xbeeInit(&transparent, memory);
        }
        return radio.failedStep <= 1U ? RADIO_NO_MODEM : RADIO_REFUSED;
    }
    set(MODEM_MASK, MODEM_MASK_RX_PACKET_MASK | MODEM_MASK_RX_OVERRUN_MASK);
    return RADIO_OK;
}

int Radio_answers(void) {
    return ANSWERS != 0;
}

U32 Radio_failedStep(void) {
    return radio.failedStep;
}

U32 Radio_waiting(void) {
    return BUSY;
}

/* Frees the buffers of packets that were sent, oldest first. */
static void reclaim(void) {
    U32 busy = BUSY;
    while (radio.used > busy) {
        radio.output[radio.head] = BUFFER_FREE;
        radio.head = (radio.head + 1U) % BUFFERS;
        --radio.used;
    }
}

/* Writes the bytes that precede the data of a packet to send. Returns their number. */
static U32 writeHead(U32 address) {
    U8 head[HEAD];
    head[0] = TRANSMIT;
    head[1] = (U8)(ID_BASE | (radio.handed++ & ID_MASK));
    head[2] = (U8)(radio.target >> 8);
    head[3] = (U8)radio.target;
    head[4] = 0;
    FSMC_writeMemory(address, head, HEAD);
    radio.handedAt = OSTimeGet();
    return HEAD;
}

/* Puts a packet, or the contents of another frame, into the output ring. Returns 0; returns 1 if no
 * buffer is free. */
static int put(const U8* bytes, U32 size, int isPacket) {
    U32 buffer, address, head = 0;
    buffer = (radio.head + radio.used) % BUFFERS;
    if (radio.output[buffer] != BUFFER_FREE)
        reclaim();
    if (radio.output[buffer] != BUFFER_FREE) {
        ++radio.counters.ringFull;
        return 1;
    }
    address = radio.memory.transmitRing + buffer * MODEM_BUFFER_BYTES;
    if (ANSWERS && isPacket)
        head = writeHead(address);
    FSMC_writeMemory(address + head, bytes, size);
    radio.output[buffer] = BUFFER_SENDING;
    ++radio.used;
    set(MODEM_TX_PUT, head + size);
    ++radio.counters.framesSent;
    radio.counters.bytesCopiedOut += size;
    return 0;
}

int Radio_transmit(void* context, const U8* frame, U32 size) {
    (void)context;
    return put(frame, size, 1);
}

#if RADIO_API

void Radio_setWait(U32 exponent) {
    U8 command[5] = {COMMAND, 0, 'R', 'N', 0};
    command[4] = (U8)exponent;
    if (ANSWERS && exponent != radio.wait && put(command, sizeof command, 0) == 0)
        radio.wait = command[4];
}

void Radio_setTarget(U16 target) {
    radio.target = target;
}

U16 Radio_source(void) {
    return radio.source;
}

#endif

/* Reports the result of a packet. Results arrive in the order in which the packets were sent, so
 * earlier packets without a result are reported as lost. */
static void takeStatus(U8 id, int isDelivered) {
    U32 before = (U32)(id - radio.answered) & ID_MASK;
    if (before >= (U8)(radio.handed - radio.answered))
        return;
    for (;; --before) {
        int isIt = before == 0 && isDelivered;
        ++radio.answered;
        ++*(isIt ? &radio.counters.delivered : &radio.counters.lost);
        radio.onAnswer(isIt);
        if (!before)
            return;
    }
}

/* Reports packets without a result in time as lost. */
static void expire(void) {
    if (radio.handed != radio.answered && OSTimeGet() - radio.handedAt >= SILENT_TICKS)
        takeStatus((U8)(radio.handed - 1U), 0);
}

/* Processes the contents of a received frame. */
static void takeFrame(const U8* frame, U32 bytes, Radio_OnPacket onPacket, void* context) {
    if (frame[0] == STATUS && bytes == 3U) {
        takeStatus(frame[1], frame[2] == 0);
    } else if (frame[0] == PACKET && bytes > HEAD) {
        radio.source = (U16)(frame[1] << 8 | frame[2]);
        radio.counters.signal = frame[3];
        onPacket(context, frame + HEAD, bytes - HEAD);
    }
}

U32 Radio_receive(Radio_OnPacket onPacket, void* context) {
    U8 packet[MODEM_BUFFER_BYTES];
    U32 packets = 0;
    if (ANSWERS)
        expire();
    for (; packets < 2U * BUFFERS; ++packets) {
        U32 entry = get(MODEM_RX_GET);
        U32 bytes = entry & MODEM_RX_GET_BYTES_MASK;
        U32 buffer = (entry & MODEM_RX_GET_BUFFER_MASK) >> MODEM_RX_GET_BUFFER_LSB;
        if (!(entry & MODEM_RX_GET_VALID_MASK))
            break;
        if (bytes > sizeof packet)
            bytes = sizeof packet;
        FSMC_readMemory(radio.memory.receiveRing + buffer * MODEM_BUFFER_BYTES, packet, bytes);
        set(MODEM_RX_RELEASE, 1);
        ++radio.counters.framesReceived;
        radio.counters.bytesCopiedIn += bytes;
        if (ANSWERS)
            takeFrame(packet, bytes, onPacket, context);
        else
            onPacket(context, packet, bytes);
    }
    return packets;
}

U32 Radio_interrupt(void) {
    U32 events = get(MODEM_EVENT);
    set(MODEM_EVENT, events);
    ++radio.counters.interrupts;
    return events;
}

const Radio_Counters* Radio_counters(void) {
    U32 errors = get(MODEM_ERRORS);
    radio.counters.framingErrors = errors & MODEM_ERRORS_FRAMING_MASK;
    radio.counters.hardwareOverruns =
        (errors & MODEM_ERRORS_OVERRUN_MASK) >> MODEM_ERRORS_OVERRUN_LSB;
    return &radio.counters;
}
