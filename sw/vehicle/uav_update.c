/* SPDX-License-Identifier: MIT
 *
 * uav_update: servants that receive new firmware and bitstreams, and a task for the steps that take
 * long. In one step, the task verifies one signature, erases one sector, or computes one digest.
 * Only the watchdog task has a lower priority.
 */
#include "uav_update.h"
#include "Update.h"
#include "receiver.h"
#include "uav_backup.h"
#include "uav_tasks.h"
#include "ucos_ii.h"

#include <lz4.h>
#include <string.h>

#define STACK_WORDS 1152 /* verifying a signature takes 3.5 KB */
#define PERIOD (OS_TICKS_PER_SEC / 10U)
#define PIECE_BYTES 4096
#define DICTIONARY_BYTES 65535U
/* time within which new firmware must be confirmed, s; after this time, the old firmware is started
 * again */
#define TRIAL_S 60U
#define RESTART_S 1U /* delay before a restart, s; pending replies are sent meanwhile */

UAV_Update uav_update[UAV_UPDATABLES];
void (*uav_restart)(void);

static OS_STK stack[STACK_WORDS];
static OS_EVENT* work;
static Receiver receivers[UAV_UPDATABLES];
static Update_Firmware servants[UAV_UPDATABLES];

static Receiver* receiverOf(Update_FirmwarePtr servant) {
    return &receivers[servant - servants];
}

Ice_Status Update_Firmware_getStatus(Update_FirmwarePtr self, Update_Status* result,
                                     const Ice_Current* current) {
    const Receiver* receiver = receiverOf(self);
    (void)current;
    result->phase = (Update_State)receiver->state;
    result->last = (Update_Reason)receiver->reason;
    result->slot = (Ice_Int)(Slots_at(receiver->port->layout, receiver->slot) + SLOTS_IMAGE_AT);
    result->running = (Ice_Int)receiver->version;
    result->trial = (Ice_Bool)receiver->isOnTrial;
    result->confirmed = (Ice_Int)receiver->confirmed;
    result->received = (Ice_Int)receiver->received;
    return ICE_OK;
}

/* Sets the result of a call. If the result is OK, wakes the task, which then does the requested
 * work. */
static Ice_Status answer(Receiver_Reason reason, Update_Reason* result) {
    *result = (Update_Reason)reason;
    if (reason == RECEIVER_OK)
        (void)OSSemPost(work);
    return ICE_OK;
}

Ice_Status Update_Firmware_begin(Update_FirmwarePtr self, const Update_Header* signedHeader,
                                 Update_Reason* result, Update_Firmware_begin_Exception* ex,
                                 const Ice_Current* current) {
    Slots_Header header;
    (void)current;
    if (UAV_isFlying()) {
        ex->type = Update_Firmware_begin_InFlight;
        return ICE_USER_EXCEPTION;
    }
    memset(&header, 0, sizeof header);
    memcpy(&header, signedHeader->data, (size_t)signedHeader->size);
    return answer(Receiver_begin(receiverOf(self), &header), result);
}

/* Returns the unpacked bytes of a piece; 0 if their number is not the size given in the call. The
 * dictionary of a compressed piece is the part of the image that is already in flash, which the
 * processor reads like memory. The dictionary therefore also exists after a loss of power. */
static const U8* unpack(const Receiver* receiver, U32 offset, Ice_Int size,
                        const Update_Piece* bytes) {
    static U8 unpacked[PIECE_BYTES];
    const U8* known = unpacked;
    U32 count = 0;
    if (receiver->port->mapped) {
        count = offset < DICTIONARY_BYTES ? offset : DICTIONARY_BYTES;
        known = receiver->port->mapped + Slots_at(receiver->port->layout, receiver->slot) +
                SLOTS_IMAGE_AT + offset - count;
    }
    if (bytes->size == size)
        return bytes->data;
    if (bytes->size > size || offset > receiver->received)
        return 0;
    if (LZ4_decompress_safe_usingDict((const char*)bytes->data, (char*)unpacked, bytes->size,
                                      PIECE_BYTES, (const char*)known, (int)count) != size)
        return 0;
    return unpacked;
}

Ice_Status Update_Firmware_write(Update_FirmwarePtr self, Ice_Int offset, Ice_Int size,
                                 const Update_Piece* bytes, Update_Reason* result,
                                 Update_Firmware_write_Exception* ex, const Ice_Current* current) {
    Receiver* receiver = receiverOf(self);
    const U8* data;
    (void)current;
    if (UAV_isFlying()) {
        ex->type = Update_Firmware_write_InFlight;
        return ICE_USER_EXCEPTION;
    }
    data = unpack(receiver, (U32)offset, size, bytes);
    *result = data ? (Update_Reason)Receiver_write(receiver, (U32)offset, data, (U32)size)
                   : Update_misplacedPiece;
    return ICE_OK;
}

Ice_Status Update_Firmware_finish(Update_FirmwarePtr self, Update_Reason* result,
                                  Update_Firmware_finish_Exception* ex,
                                  const Ice_Current* current) {
    (void)current;
    if (UAV_isFlying()) {
        ex->type = Update_Firmware_finish_InFlight;
        return ICE_USER_EXCEPTION;
    }
    return answer(Receiver_finish(receiverOf(self)), result);
}

Ice_Status Update_Firmware_confirm(Update_FirmwarePtr self, Update_Reason* result,
                                   Update_Firmware_confirm_Exception* ex,
                                   const Ice_Current* current) {
    (void)current;
    if (UAV_isFlying()) {
        ex->type = Update_Firmware_confirm_InFlight;
        return ICE_USER_EXCEPTION;
    }
    *result = (Update_Reason)Receiver_confirm(receiverOf(self));
    return ICE_OK;
}

/* Does one step of each update. Returns 1 if at least one update has more steps. During flight,
 * updates wait, because an erase stalls the processor and a new image restarts it. */
static int workOn(U32 uptime) {
    int more = 0, i;
    for (i = 0; i < UAV_UPDATABLES && !UAV_isFlying(); ++i) {
        Receiver* receiver = &receivers[i];
        if (!receiver->port)
            continue;
        more |= Receiver_work(receiver);
        if (receiver->state == RECEIVER_READY ||
            (receiver->isOnTrial && uptime > TRIAL_S * OS_TICKS_PER_SEC)) {
            OSTimeDly(RESTART_S * OS_TICKS_PER_SEC);
            if (!UAV_isFlying())
                uav_restart();
        }
    }
    return more;
}

static void updateTask(void* argument) {
    const U32 begun = OSTimeGet();
    INT8U error;
    (void)argument;
    for (;;) {
        OSSemPend(work, PERIOD, &error);
        while (workOn(OSTimeGet() - begun))
            /* lets other tasks run before an erase, which stalls the processor */
            OSTimeDly(PERIOD);
    }
}

void UAV_startUpdate(Ice_ObjectAdapterPtr adapter) {
    static const char* const names[UAV_UPDATABLES] = {"update", "fpga"};
    int i;
    for (i = 0; i < UAV_UPDATABLES; ++i) {
        const UAV_Update* update = &uav_update[i];
        memset(&receivers[i], 0, sizeof receivers[i]);
        if (!update->slots)
            continue;
        Receiver_init(&receivers[i], update->slots, update->product, update->running);
        Update_Firmware_init(&servants[i]);
        (void)Ice_ObjectAdapter_add(adapter, (Ice_ObjectPtr)&servants[i], names[i]);
    }
    for (i = 0; i < UAV_UPDATABLES; ++i)
        if (receivers[0].port && receivers[1].port)
            receivers[i].counterpart = &receivers[1 - i];
    if (!uav_update[UAV_FIRMWARE].slots)
        return;
    work = OSSemCreate(0);
    (void)OSTaskCreateExt(updateTask, 0, &stack[STACK_WORDS - 1], PRIO_UPDATE, PRIO_UPDATE, stack,
                          STACK_WORDS, 0, OS_TASK_OPT_STK_CHK | OS_TASK_OPT_STK_CLR);
}
