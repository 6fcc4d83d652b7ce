/* SPDX-License-Identifier: MIT
 *
 * radio: set-up of controller and modem, the circular output buffer, the receive ring.
 */
#include "radio.h"
#include "fsmc.h"
#include "map_regs.h"
#include "modem_regs.h"
#include "ucos_ii.h"

#define BUFFERS MODEM_RING_BUFFERS
#define BUSY (BUFFERS - (get(MODEM_TX_STATE) & MODEM_TX_STATE_FREE_MASK)) /* in the output ring */
#define DEFAULT_CHANNEL 0x0CU
#define DEFAULT_PAN 0x3332U
#define DEFAULT_GUARD_MS 1000U
#define POLL_TICKS (OS_TICKS_PER_SEC / 100U)

typedef enum BufferState { BUFFER_FREE, BUFFER_SENDING } BufferState;

/* The fixed control vector of the output buffer: one entry a DDR3 buffer. */
typedef struct OutputBuffer {
    BufferState state;
    U8 bytes;
} OutputBuffer;

static struct {
    OutputBuffer output[BUFFERS];
    U32 head, used; /* oldest being sent; how many are */
    Radio_Memory memory;
    Radio_Counters counters;
    U32 failedStep;
} radio;

static U32 get(U32 word) {
    return FSMC_read(MAP_SLOT_MODEM, word);
}

static void set(U32 word, U32 value) {
    FSMC_write(MAP_SLOT_MODEM, word, value);
}

/* Writes the key's words, the highest first. */
static void setKey(const U8* key) {
    U32 i;
    for (i = 0; i < 16U; i += 4U)
        set(MODEM_KEY,
            (U32)key[i] << 24 | (U32)key[i + 1U] << 16 | (U32)key[i + 2U] << 8 | key[i + 3U]);
}

static void setUpController(const XBeeInitTypeDef* conf) {
    U32 guard = conf->guardMs ? conf->guardMs : DEFAULT_GUARD_MS;
    U32 encrypt = conf->key ? 1U << MODEM_NET_ENCRYPT_LSB : 0U;
    set(MODEM_CONTROL, MODEM_CONTROL_RESET_MODEM_MASK);
    OSTimeDly(OS_TICKS_PER_SEC / 2U); /* the modem boots in 50 to 500 ms */
    set(MODEM_BAUD, guard << MODEM_BAUD_GUARD_MS_LSB | (U32)conf->baud);
    set(MODEM_ADDR, (U32)conf->target << MODEM_ADDR_TARGET_LSB | conf->source);
    set(MODEM_NET, (U32)(conf->pan ? conf->pan : DEFAULT_PAN) << MODEM_NET_PAN_LSB | encrypt |
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
    radio.head = radio.used = 0;
    for (i = 0; i < BUFFERS; ++i)
        radio.output[i].state = BUFFER_FREE;
    setUpController(conf);
    /* The controller always ends: with all rates tried, after about 40 s. */
    while (!(events & (MODEM_EVENT_CONFIGURED_MASK | MODEM_EVENT_CONFIGURE_FAILED_MASK))) {
        OSTimeDly(POLL_TICKS);
        events = get(MODEM_EVENT);
    }
    set(MODEM_EVENT, events);
    if (events & MODEM_EVENT_CONFIGURE_FAILED_MASK) {
        radio.failedStep = (get(MODEM_STATUS) & MODEM_STATUS_STEP_MASK) >> MODEM_STATUS_STEP_LSB;
        return radio.failedStep <= 1U ? RADIO_NO_MODEM : RADIO_REFUSED;
    }
    set(MODEM_MASK, MODEM_MASK_RX_PACKET_MASK | MODEM_MASK_RX_OVERRUN_MASK);
    return RADIO_OK;
}

U32 Radio_failedStep(void) {
    return radio.failedStep;
}

U32 Radio_waiting(void) {
    return BUSY;
}

/* Frees the buffers whose packets have left, oldest first. */
static void reclaim(void) {
    U32 busy = BUSY;
    while (radio.used > busy) {
        radio.output[radio.head].state = BUFFER_FREE;
        radio.head = (radio.head + 1U) % BUFFERS;
        --radio.used;
    }
}

int Radio_transmit(void* context, const U8* frame, U32 size) {
    U32 buffer;
    (void)context;
    buffer = (radio.head + radio.used) % BUFFERS;
    if (radio.output[buffer].state != BUFFER_FREE)
        reclaim();
    if (radio.output[buffer].state != BUFFER_FREE) {
        ++radio.counters.ringFull;
        return 1;
    }
    FSMC_writeMemory(radio.memory.transmitRing + buffer * MODEM_BUFFER_BYTES, frame, size);
    radio.output[buffer].state = BUFFER_SENDING;
    radio.output[buffer].bytes = (U8)size;
    ++radio.used;
    set(MODEM_TX_PUT, size);
    ++radio.counters.framesSent;
    radio.counters.bytesCopiedOut += size;
    return 0;
}

U32 Radio_receive(Radio_OnPacket onPacket, void* context) {
    U8 packet[MODEM_BUFFER_BYTES];
    U32 packets = 0;
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
