/* SPDX-License-Identifier: MIT
 *
 * uav_update: the servant of new firmware, and the task that does what takes long: below all
 * others but the watchdog's, one signature, sector or digest at a time.
 */
#include "uav_update.h"
#include "Update.h"
#include "receiver.h"
#include "uav_private.h"

#include <lz4.h>
#include <string.h>

#define STACK_WORDS 1152 /* a signature takes 3.5 KB */
#define PERIOD (OS_TICKS_PER_SEC / 10U)
#define PIECE_BYTES 4096
#define DICTIONARY_BYTES 65535U
#define TRIAL_S 60U  /* then firmware that nobody has confirmed goes */
#define RESTART_S 1U /* for the answers that are under way */

const Slots_Port* uav_slots;
U32 uav_slot, uav_product;
void (*uav_restart)(void);

static OS_STK stack[STACK_WORDS];
static OS_EVENT* work;
static Receiver receiver;
static Update_Firmware servant;

Ice_Status Update_Firmware_getStatus(Update_FirmwarePtr self, Update_Status* result,
                                     const Ice_Current* current) {
    (void)self;
    (void)current;
    result->phase = (Update_State)receiver.state;
    result->last = (Update_Reason)receiver.reason;
    result->slot = (Ice_Int)(Slots_at(Receiver_slot(&receiver)) + SLOTS_IMAGE_AT);
    result->running = (Ice_Int)Slots_header(uav_slots, uav_slot)->version;
    result->trial = (Ice_Bool)Receiver_isOnTrial(&receiver);
    result->confirmed = (Ice_Int)Slots_confirmed(uav_slots, uav_product);
    result->received = (Ice_Int)receiver.received;
    return ICE_OK;
}

/* Answers, and wakes the task for what was asked for. */
static Ice_Status answer(Receiver_Reason reason, Update_Reason* result) {
    *result = (Update_Reason)reason;
    if (reason == RECEIVER_OK)
        (void)OSSemPost(work);
    return ICE_OK;
}

Ice_Status Update_Firmware_begin(Update_FirmwarePtr self, const Update_Header* signedHeader,
                                 Update_Reason* result, const Ice_Current* current) {
    Slots_Header header;
    (void)self;
    (void)current;
    memset(&header, 0, sizeof header);
    memcpy(&header, signedHeader->data, (size_t)signedHeader->size);
    return answer(Receiver_begin(&receiver, &header), result);
}

/* Returns the piece's bytes, 0 if they are not what was promised. Compressed ones are unpacked by
 * what of the image is in flash, so nothing is lost with the power. */
static const U8* unpack(U32 offset, Ice_Int size, const Update_Piece* bytes) {
    static U8 unpacked[PIECE_BYTES];
    const U32 known = offset < DICTIONARY_BYTES ? offset : DICTIONARY_BYTES;
    const U8* image = uav_slots->flash + Slots_at(Receiver_slot(&receiver)) + SLOTS_IMAGE_AT;
    if (bytes->size == size)
        return bytes->data;
    if (bytes->size > size || offset > receiver.received ||
        LZ4_decompress_safe_usingDict((const char*)bytes->data, (char*)unpacked, bytes->size,
                                      PIECE_BYTES, (const char*)(image + (offset - known)),
                                      (int)known) != size)
        return 0;
    return unpacked;
}

Ice_Status Update_Firmware_write(Update_FirmwarePtr self, Ice_Int offset, Ice_Int size,
                                 const Update_Piece* bytes, Update_Reason* result,
                                 const Ice_Current* current) {
    const U8* data = unpack((U32)offset, size, bytes);
    (void)self;
    (void)current;
    *result = data ? (Update_Reason)Receiver_write(&receiver, (U32)offset, data, (U32)size)
                   : Update_misplacedPiece;
    return ICE_OK;
}

Ice_Status Update_Firmware_finish(Update_FirmwarePtr self, Update_Reason* result,
                                  const Ice_Current* current) {
    (void)self;
    (void)current;
    return answer(Receiver_finish(&receiver), result);
}

Ice_Status Update_Firmware_confirm(Update_FirmwarePtr self, Update_Reason* result,
                                   const Ice_Current* current) {
    (void)self;
    (void)current;
    *result = (Update_Reason)Receiver_confirm(&receiver);
    return ICE_OK;
}

static void updateTask(void* argument) {
    const U32 begun = OSTimeGet();
    INT8U error;
    (void)argument;
    for (;;) {
        OSSemPend(work, PERIOD, &error);
        while (Receiver_work(&receiver))
            OSTimeDly(PERIOD); /* an erase stops everything: others come first */
        if (receiver.state == RECEIVER_READY ||
            (Receiver_isOnTrial(&receiver) && OSTimeGet() - begun > TRIAL_S * OS_TICKS_PER_SEC)) {
            OSTimeDly(RESTART_S * OS_TICKS_PER_SEC);
            uav_restart();
        }
    }
}

void UAV_startUpdate(Ice_ObjectAdapterPtr adapter) {
    if (!uav_slots)
        return;
    Receiver_init(&receiver, uav_slots, uav_product, uav_slot);
    Update_Firmware_init(&servant);
    (void)Ice_ObjectAdapter_add(adapter, (Ice_ObjectPtr)&servant, "update");
    work = OSSemCreate(0);
    (void)OSTaskCreateExt(updateTask, 0, &stack[STACK_WORDS - 1], PRIO_UPDATE, PRIO_UPDATE, stack,
                          STACK_WORDS, 0, OS_TASK_OPT_STK_CHK | OS_TASK_OPT_STK_CLR);
}
