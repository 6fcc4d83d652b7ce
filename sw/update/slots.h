/* SPDX-License-Identifier: MIT
 *
 * slots: two places in flash for firmware, and decides which of their images may run
 * (docs/firmware.md).
 *
 * A slot begins with a signed header and with state words. The header contains the digest of the
 * image that follows. Each state word is written at most once after an erase. It counts only if it
 * has exactly the defined value; if a power loss interrupts the write, writing the word again
 * completes it.
 */
#pragma once

#include "slots_header.h" /* generated from slots_header.toml */

#define SLOTS_COUNT 2U
#define SLOTS_NONE SLOTS_COUNT
/* offset of the lists of keys in the processor's flash (sector 2) */
#define SLOTS_KEYS_AT 0x8000U
#define SLOTS_LISTS 64U
/* offset of the image in a slot: Cortex-M3 vectors are aligned to 512 bytes */
#define SLOTS_IMAGE_AT 0x200U

/* A list of two public keys. Their owners may sign images and the next list. The first list is
 * written by a programmer; later lists are only added, and the last complete one is valid. */
typedef struct Slots_Keys {
    Slots_Header list;
    U32 unused[23];
    U32 isComplete; /* SLOTS_TRUE if the list is complete; written last */
} Slots_Keys;

#define SLOTS_SIGNED_BYTES (sizeof(Slots_Header) - SLOTS_SIGNATURE_BYTES)

/* State words. The values are their offsets in a slot. */
typedef enum Slots_State {
    /* the image in the slot is complete and was checked (Slots_Layout.ready can replace this
     * word) */
    SLOTS_READY = 0x1C0,
    SLOTS_TRIED = 0x1D0,     /* the image was started once */
    SLOTS_CONFIRMED = 0x1E0, /* the image has been confirmed to work */
    SLOTS_REFUSED = 0x1F0    /* the FPGA did not start with this image */
} Slots_State;
#define SLOTS_TRUE 0x600DF1A5U /* value of a state word that is set */
#define SLOTS_ERASED 0xFFFFFFFFU

/* The layout of a flash. */
typedef struct Slots_Layout {
    U32 at, bytes;      /* offset and size of slot 0; slot 1 follows directly */
    U32 sectorBytes;    /* size of an erase sector, bytes */
    U32 readyAt, ready; /* offset of the word READY in a slot, and its value if it is set */
    U32 logAt;          /* offset of the log of confirmed versions that were erased */
    /* 1 if slot 0 is never written; 0 if updates are written to the two slots alternately */
    U32 hasGolden;
} Slots_Layout;

/* Layout of the processor's flash: slots in sectors 5..7 and 8..10, and the log in sector 3. */
extern const Slots_Layout slots_firmware;
/* Layout of the FPGA's flash: slot 0 contains the golden bitstream, which is never written; slot
 * 1 contains the bitstream that is tried first. Its word READY is the sync word of the
 * bitstream, without which the FPGA ignores the bitstream. */
extern const Slots_Layout slots_fpga;
#define SLOTS_SYNC_AT 16U /* offset of the sync word in a bitstream */
#define SLOTS_LOG_BYTES 0x1000U

/* Reads bytes at an offset in flash. */
typedef void (*Slots_Read)(void* context, U32 offset, U8* bytes, U32 count);

/* A flash, and the checks of its images. Functions that return int return 1 for success. */
typedef struct Slots_Port {
    const Slots_Layout* layout;
    void* context;
    Slots_Read read;
    int (*erase)(void* context, U32 offset); /* Erases the sector that begins at `offset`. */
    /* Programs words within a block of 256 bytes aligned to 256. Programming can only clear
     * bits. */
    int (*program)(void* context, U32 offset, const U8* bytes, U32 count);
    int (*isSigned)(const U8* signature, const U8* message, U32 bytes, const U8* key);
    void (*digest)(Slots_Read read, void* context, U32 offset, U32 bytes, U8* digest);
    const Slots_Keys* keys; /* lists of keys; they also contain the vehicle's vendor and board */
    const U8* mapped;       /* address of the flash if it is memory-mapped; otherwise 0 */
} Slots_Port;

/* Returns the slot's offset in flash. */
U32 Slots_at(const Slots_Layout* layout, U32 slot);
/* Reads the bytes at the slot's beginning, valid or not. */
void Slots_header(const Slots_Port* port, U32 slot, Slots_Header* header);
int Slots_is(const Slots_Port* port, U32 slot, Slots_State state);
/* Sets a state. Returns 0 if the flash could not be programmed. */
int Slots_set(const Slots_Port* port, U32 slot, Slots_State state);
/* Returns 1 if the header is possible for this slot, product, vendor and board. */
int Slots_fits(const Slots_Port* port, const Slots_Header* header, U32 slot, U32 product);
/* Returns the vehicle's list of keys. */
const Slots_Header* Slots_keys(const Slots_Port* port);
/* Returns 1 if the header is signed with a key of this list. The header need not be in flash. */
int Slots_isSigned(const Slots_Port* port, const Slots_Header* keys, const Slots_Header* header);
/* Returns 1 if the image in the slot has the digest in the header. */
int Slots_isWhole(const Slots_Port* port, U32 slot, const Slots_Header* header);
/* Returns the highest confirmed version; 0 if no version is confirmed. */
U32 Slots_confirmed(const Slots_Port* port, U32 product);
/* Clears READY of a slot before it is erased, and logs its version if it was the highest confirmed
 * one. Therefore a half-erased image never starts, and an older one is never accepted. */
int Slots_retire(const Slots_Port* port, U32 slot);

/* Returns the slot to run, or SLOTS_NONE. With `mayTry`, a new image is chosen once; otherwise
 * the newest confirmed image, or else any valid image. A chosen image is always signed and
 * complete. */
U32 Slots_choose(const Slots_Port* port, U32 product, int mayTry);

/* Returns 1 if the bitstream that the FPGA would load is signed and complete. The golden bitstream,
 * which is never written, must be signed with a key of the first list. */
int Slots_isLoadable(const Slots_Port* port, U32 product);
/* Checks the FPGA's flash at each start of the vehicle, and after each failed load of the FPGA. A
 * new bitstream is tried once. A bitstream is retired if it was tried and not confirmed, or if the
 * FPGA has refused it (the FPGA does not start, or starts the golden one). Returns 1 if the FPGA
 * must load again. */
int Slots_settleFpga(const Slots_Port* port, int isRefused);
