/* SPDX-License-Identifier: MIT
 *
 * ascon_servant: implements Cores::Ascon with the core: it accesses the registers of the core and
 * its buffers through the FSMC.
 */
#include "ascon_servant.h"
#include "ascon_regs.h"
#include "fsmc.h"

#define TIMEOUT_MS 100U /* time-out, ms; a message of 1024 bytes takes 2200 clocks */
#define KEY_BYTES 16

/* Byte offsets of the buffers, relative to the core's memory address. */
#define ASSOCIATED 0U
#define MESSAGE 1024U
#define RESULT 2048U
#define TAG 3072U

enum { DONE, REFUSED }; /* events */

static void set(const Ascon_Core* self, U32 word, U32 value) {
    FSMC_write(self->core.slot, word, value);
}

Hw_Status Ascon_Core_init(Ascon_Core* self, U32 slot, U32 memory, const Hw_Port* port,
                          void* context) {
    Hw_Status status = Hw_Core_init(&self->core, slot, ASCON_ID_VALUE, port, context);
    if (status != HW_OK)
        return status;
    self->memory = memory;
    Cores_Ascon_init(&self->servant);
    set(self, ASCON_AD_BASE, memory + ASSOCIATED);
    set(self, ASCON_SOURCE, memory + MESSAGE);
    set(self, ASCON_TARGET, memory + RESULT);
    set(self, ASCON_TAG, memory + TAG);
    return HW_OK;
}

/* Writes a key or a nonce as four little-endian words. */
static void setFour(const Ascon_Core* self, U32 word, const U8* bytes) {
    int i;
    for (i = 0; i < KEY_BYTES; i += 4)
        set(self, word,
            (U32)bytes[i] | (U32)bytes[i + 1] << 8 | (U32)bytes[i + 2] << 16 |
                (U32)bytes[i + 3] << 24);
}

static int fits(const Cores_Bytes* bytes) {
    return bytes->size <= ASCON_LIMIT;
}

static Ice_Status refuseSizes(const Ice_Current* current) {
    return Ice_Current_refuse(current, "nonce, tag: expected 16 bytes; texts: at most 1024");
}

/* Returns 1 if an earlier operation of the core is still in progress. This happens if the memory
 * does not respond. The core would then ignore a new key, nonce or start, and the end of the
 * earlier operation would look like the end of the new operation. */
static int hangs(const Ascon_Core* self) {
    return (FSMC_read(self->core.slot, ASCON_STATUS) & ASCON_STATUS_BUSY_MASK) != 0;
}

static Ice_Status run(Ascon_Core* self, const Ice_Current* current, U32 control,
                      const Cores_Bytes* associated, const Cores_Bytes* message) {
    U32 associatedSize = associated ? (U32)associated->size : 0U, size = (U32)message->size;
    if (associatedSize > 0U)
        FSMC_writeMemory(self->memory + ASSOCIATED, associated->data, associatedSize);
    if (size > 0U)
        FSMC_writeMemory(self->memory + MESSAGE, message->data, size);
    set(self, ASCON_AD_SIZE, associatedSize);
    set(self, ASCON_SIZE, size);
    set(self, ASCON_EVENT,
        /* clears the events that an abandoned operation has left */
        ASCON_EVENT_DONE_MASK | ASCON_EVENT_REFUSED_MASK);
    self->core.done[DONE] = 0;
    self->core.done[REFUSED] = 0;
    set(self, ASCON_CONTROL, control);
    while (!self->core.done[DONE] && !self->core.done[REFUSED])
        if (!self->core.port->wait(self->core.context, DONE, TIMEOUT_MS) &&
            !self->core.done[DONE] && !self->core.done[REFUSED]) {
            set(self, ASCON_CONTROL, ASCON_CONTROL_ABORT_MASK);
            return ICE_TIMEOUT;
        }
    return self->core.done[REFUSED] ? Ice_Current_refuse(current, "expected a key, see setKey")
                                    : ICE_OK;
}

Ice_Status Cores_Ascon_setKey(Cores_AsconPtr servant, const Cores_Bytes* key,
                              const Ice_Current* current) {
    if (key->size != KEY_BYTES)
        return Ice_Current_refuse(current, "key: expected 16 bytes");
    if (hangs((Ascon_Core*)servant))
        return ICE_TIMEOUT;
    setFour((Ascon_Core*)servant, ASCON_KEY, key->data);
    return ICE_OK;
}

Ice_Status Cores_Ascon_forget(Cores_AsconPtr servant, const Ice_Current* current) {
    (void)current;
    if (hangs((Ascon_Core*)servant))
        return ICE_TIMEOUT;
    set((Ascon_Core*)servant, ASCON_CONTROL, ASCON_CONTROL_FORGET_MASK);
    return ICE_OK;
}

Ice_Status Cores_Ascon_seal(Cores_AsconPtr servant, const Cores_Bytes* nonce,
                            const Cores_Bytes* associated, const Cores_Bytes* message,
                            Cores_Bytes* text, Cores_Bytes* tag, const Ice_Current* current) {
    Ascon_Core* self = (Ascon_Core*)servant;
    Ice_Status status;
    if (nonce->size != KEY_BYTES || !fits(associated) || !fits(message))
        return refuseSizes(current);
    if (hangs(self))
        return ICE_TIMEOUT;
    setFour(self, ASCON_NONCE, nonce->data);
    status = run(self, current, ASCON_CONTROL_ENCRYPT_MASK, associated, message);
    if (status != ICE_OK)
        return status;
    FSMC_readMemory(self->memory + RESULT, self->result, (U32)message->size);
    FSMC_readMemory(self->memory + TAG, self->tag, KEY_BYTES);
    text->size = message->size;
    text->data = self->result;
    tag->size = KEY_BYTES;
    tag->data = self->tag;
    return ICE_OK;
}

Ice_Status Cores_Ascon_unseal(Cores_AsconPtr servant, const Cores_Bytes* nonce,
                              const Cores_Bytes* associated, const Cores_Bytes* text,
                              const Cores_Bytes* tag, Cores_Bytes* message, Ice_Bool* result,
                              const Ice_Current* current) {
    Ascon_Core* self = (Ascon_Core*)servant;
    Ice_Status status;
    if (nonce->size != KEY_BYTES || tag->size != KEY_BYTES || !fits(associated) || !fits(text))
        return refuseSizes(current);
    if (hangs(self))
        return ICE_TIMEOUT;
    FSMC_writeMemory(self->memory + TAG, tag->data, KEY_BYTES);
    setFour(self, ASCON_NONCE, nonce->data);
    status = run(self, current, ASCON_CONTROL_DECRYPT_MASK, associated, text);
    if (status != ICE_OK)
        return status;
    *result = (FSMC_read(self->core.slot, ASCON_STATUS) & ASCON_STATUS_VALID_MASK) != 0;
    message->size = *result ? text->size : 0;
    message->data = self->result;
    FSMC_readMemory(self->memory + RESULT, self->result, (U32)message->size);
    return ICE_OK;
}

Ice_Status Cores_Ascon_hash(Cores_AsconPtr servant, const Cores_Bytes* message, Cores_Bytes* result,
                            const Ice_Current* current) {
    Ascon_Core* self = (Ascon_Core*)servant;
    Ice_Status status;
    if (!fits(message))
        return refuseSizes(current);
    if (hangs(self))
        return ICE_TIMEOUT;
    status = run(self, current, ASCON_CONTROL_HASH_MASK, 0, message);
    if (status != ICE_OK)
        return status;
    FSMC_readMemory(self->memory + RESULT, self->result, ASCON_DIGEST_BYTES);
    result->size = ASCON_DIGEST_BYTES;
    result->data = self->result;
    return ICE_OK;
}
