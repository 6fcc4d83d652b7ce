/* SPDX-License-Identifier: MIT
 *
 * slots: two places in flash for firmware, and functions that decide which of their images may run
 * (docs/firmware.md).
 *
 * A slot begins with a signed header and with state words. The header contains the digest of the
 * image that follows. Each state word is written at most once after an erase. A state word counts
 * as set only if it equals SLOTS_TRUE. If a loss of power interrupts the write, writing the word
 * again completes it.
 */
#pragma once

#include "slots_header.h" /* generated from slots_header.toml */

#define SLOTS_COUNT 2U
#define SLOTS_NONE SLOTS_COUNT
/* offset of the lists of keys in the processor's flash (sector 2) */
#define SLOTS_KEYS_AT 0x8000U
#define SLOTS_LISTS 64U
/* offset of the image in a slot, bytes; a vector table of the Cortex-M3 must be aligned to 512
 * bytes */
#define SLOTS_IMAGE_AT 0x200U

/* A list of two public keys. The owners of these keys may sign images and the next list. A
 * programmer writes the first list. Later lists are added after it, and the last complete list is
 * valid. */
typedef struct Slots_Keys {
    Slots_Header list;
    U32 unused[23];
    U32 isComplete; /* SLOTS_TRUE if the list is complete; this word is written last */
} Slots_Keys;

#define SLOTS_SIGNED_BYTES (sizeof(Slots_Header) - SLOTS_SIGNATURE_BYTES)

/* State words of a slot. Each value is the word's offset in the slot. */
typedef enum Slots_State {
    /* the image in the slot is complete and was checked; Slots_Layout.ready can replace this word
     */
    SLOTS_READY = 0x1C0,
    SLOTS_TRIED = 0x1D0,     /* the image was started once */
    SLOTS_CONFIRMED = 0x1E0, /* the image has been confirmed to work */
    SLOTS_REFUSED = 0x1F0    /* the FPGA did not start with this image */
} Slots_State;
#define SLOTS_TRUE 0x600DF1A5U /* value of a state word that is set */
#define SLOTS_ERASED 0xFFFFFFFFU

/* Layout of the slots in a flash. */
typedef struct Slots_Layout {
    U32 at, bytes;      /* offset and size of slot 0; slot 1 follows directly after it */
    U32 sectorBytes;    /* size of an erase sector, bytes */
    U32 readyAt, ready; /* offset in the slot of the word READY, and its value when it is set */
    /* offset of the log, which contains the confirmed versions that were erased later */
    U32 logAt;
    /* 1 if slot 0 is never written; 0 if the two slots are written alternately */
    U32 hasGolden;
} Slots_Layout;

/* Layout of the processor's flash: slots in sectors 5..7 and 8..10, and the log in sector 3. */
extern const Slots_Layout slots_firmware;
/* Layout of the FPGA's flash. Slot 0 contains the golden bitstream and is never written. The FPGA
 * tries the bitstream in slot 1 first. The word READY is the sync word of the bitstream: without
 * it, the FPGA ignores the bitstream. */
extern const Slots_Layout slots_fpga;
#define SLOTS_SYNC_AT 16U /* offset of the sync word in a bitstream */
#define SLOTS_LOG_BYTES 0x1000U

/* Reads bytes at an offset in flash. */
typedef void (*Slots_Read)(void* context, U32 offset, U8* bytes, U32 count);

/* A flash, and functions that check images in it. Functions that return int return 1 on success. */
typedef struct Slots_Port {
    const Slots_Layout* layout;
    void* context;
    Slots_Read read;
    int (*erase)(void* context, U32 offset); /* Erases the sector that begins at `offset`. */
    /* Programs words inside one block of 256 bytes, which is aligned to 256. Programming can only
     * clear bits. */
    int (*program)(void* context, U32 offset, const U8* bytes, U32 count);
    int (*isSigned)(const U8* signature, const U8* message, U32 bytes, const U8* key);
    void (*digest)(Slots_Read read, void* context, U32 offset, U32 bytes, U8* digest);
    /* the lists of keys, which also contain the vehicle's vendor and board */
    const Slots_Keys* keys;
    /* address at which the flash can be read like memory; 0 if this is not possible */
    const U8* mapped;
} Slots_Port;

/* Returns the slot's offset in flash. */
U32 Slots_at(const Slots_Layout* layout, U32 slot);
/* Reads the bytes at the start of a slot, whether or not they are a valid header. */
void Slots_header(const Slots_Port* port, U32 slot, Slots_Header* header);
int Slots_is(const Slots_Port* port, U32 slot, Slots_State state);
/* Sets a state word. Returns 0 if the flash could not be programmed. */
int Slots_set(const Slots_Port* port, U32 slot, Slots_State state);
/* Returns 1 if the header is well-formed and matches this slot, product, vendor and board. */
int Slots_fits(const Slots_Port* port, const Slots_Header* header, U32 slot, U32 product);
/* Returns the vehicle's list of keys. */
const Slots_Header* Slots_keys(const Slots_Port* port);
/* Returns 1 if the header is signed with a key of this list. The header may be in RAM. */
int Slots_isSigned(const Slots_Port* port, const Slots_Header* keys, const Slots_Header* header);
/* Returns 1 if the digest of the image in the slot equals the digest in the header. */
int Slots_isWhole(const Slots_Port* port, U32 slot, const Slots_Header* header);
/* Returns the highest confirmed version; 0 if no version is confirmed. */
U32 Slots_confirmed(const Slots_Port* port, U32 product);
/* Clears READY of a slot that will be erased. If the version in the slot is the highest confirmed
 * version, first writes this version to the log. A slot that is partly erased therefore never
 * starts, and an older version is never accepted. */
int Slots_retire(const Slots_Port* port, U32 slot);

/* Returns the slot to run, or SLOTS_NONE. With `mayTry`, chooses a new image, but only once;
 * otherwise the newest confirmed image; without one, any valid image. The chosen image is
 * always signed and complete. */
U32 Slots_choose(const Slots_Port* port, U32 product, int mayTry);

/* Returns 1 if the bitstream that the FPGA would load is signed and complete. The golden bitstream
 * is never replaced, so it must be signed with a key of the first list. */
int Slots_isLoadable(const Slots_Port* port, U32 product);
/* Checks the FPGA's flash at each start of the vehicle, and after each failed load. A new bitstream
 * is tried once. A bitstream is retired if it was tried and not confirmed. It is also retired if
 * the FPGA has refused it, that is, if the FPGA has not started or has loaded the golden bitstream.
 * Returns 1 if the FPGA must load again. */
int Slots_settleFpga(const Slots_Port* port, int isRefused);
