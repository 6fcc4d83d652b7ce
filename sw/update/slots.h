/* SPDX-License-Identifier: MIT
 *
 * slots: two places in flash for firmware, and which of their images may run (docs/firmware.md).
 *
 * A slot begins with a signed header that has the digest of the image behind it, and with state
 * words, which are written once after an erase. A state word counts only if it is exactly its
 * value, and writing it again completes one that a loss of power has cut.
 */
#pragma once

#include "slots_header.h" /* generated from slots_header.toml */

#define SLOTS_COUNT 2U
#define SLOTS_NONE SLOTS_COUNT
#define SLOTS_KEYS_AT 0x8000U /* offset of the lists of keys in the processor's flash, sector 2 */
#define SLOTS_LISTS 64U
#define SLOTS_IMAGE_AT 0x200U /* offset in a slot: Cortex-M3 vectors are aligned to 512 bytes */

/* A list of two public keys. Their owners may sign images and the next list. The first list is
 * written by a programmer; later lists are only added, and the last complete one is valid. */
typedef struct Slots_Keys {
    Slots_Header list;
    U32 unused[23];
    U32 isComplete; /* SLOTS_TRUE, written last */
} Slots_Keys;

#define SLOTS_SIGNED_BYTES (sizeof(Slots_Header) - SLOTS_SIGNATURE_BYTES)

/* State words, by their offset in a slot. */
typedef enum Slots_State {
    SLOTS_READY = 0x1C0,     /* the complete image is present and was checked (or
                              * Slots_Layout.ready) */
    SLOTS_TRIED = 0x1D0,     /* it was started once */
    SLOTS_CONFIRMED = 0x1E0, /* the image works */
    SLOTS_REFUSED = 0x1F0    /* the FPGA has not taken it */
} Slots_State;
#define SLOTS_TRUE 0x600DF1A5U /* makes a state true */
#define SLOTS_ERASED 0xFFFFFFFFU

/* The layout of a flash. */
typedef struct Slots_Layout {
    U32 at, bytes;      /* slot 0; slot 1 follows it */
    U32 sectorBytes;    /* size of an erase */
    U32 readyAt, ready; /* offset of READY in a slot, and the value that makes it true */
    U32 logAt;          /* log of erased confirmed versions */
    U32 hasGolden;      /* slot 0 is never written; else slots take turns */
} Slots_Layout;

/* The processor's flash: sectors 5..7 and 8..10, and the log in sector 3. */
extern const Slots_Layout slots_firmware;
/* Layout for the FPGA: slot 0 contains the golden bitstream, which is never written, slot 1 the one
 * that is tried first. READY is its sync word, without which the FPGA ignores it. */
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
    int (*erase)(void* context, U32 offset); /* the sector that begins there */
    /* Programs bytes, in words, within 256 bytes aligned to 256; only clears bits. */
    int (*program)(void* context, U32 offset, const U8* bytes, U32 count);
    int (*isSigned)(const U8* signature, const U8* message, U32 bytes, const U8* key);
    void (*digest)(Slots_Read read, void* context, U32 offset, U32 bytes, U8* digest);
    const Slots_Keys* keys; /* the lists of keys, with the vehicle's vendor and board */
    const U8* mapped;       /* the flash, if it is memory-mapped; else 0 */
} Slots_Port;

/* Returns the slot's offset in flash. */
U32 Slots_at(const Slots_Layout* layout, U32 slot);
/* Reads the bytes at the slot's beginning, valid or not. */
void Slots_header(const Slots_Port* port, U32 slot, Slots_Header* header);
int Slots_is(const Slots_Port* port, U32 slot, Slots_State state);
/* Sets a state. Returns 0 if the flash could not be programmed. */
int Slots_set(const Slots_Port* port, U32 slot, Slots_State state);
/* Returns 1 if the header could be one of an image for this slot, product, vendor and board. */
int Slots_fits(const Slots_Port* port, const Slots_Header* header, U32 slot, U32 product);
/* Returns the vehicle's list of keys. */
const Slots_Header* Slots_keys(const Slots_Port* port);
/* Returns 1 if the header is signed with a key of this list. The header need not be in flash. */
int Slots_isSigned(const Slots_Port* port, const Slots_Header* keys, const Slots_Header* header);
/* Returns 1 if the image in the slot has the header's digest. */
int Slots_isWhole(const Slots_Port* port, U32 slot, const Slots_Header* header);
/* Returns the highest confirmed version; 0 if none. */
U32 Slots_confirmed(const Slots_Port* port, U32 product);
/* Clears READY of a slot before it is erased, and logs its version if it was the highest confirmed
 * one. Therefore a half-erased image never starts, and an older one is never accepted. */
int Slots_retire(const Slots_Port* port, U32 slot);

/* Returns the slot to run; SLOTS_NONE if none: with `mayTry` a new image, once; else the
 * newest confirmed one; else any valid one. Each is signed and complete. */
U32 Slots_choose(const Slots_Port* port, U32 product, int mayTry);

/* Returns 1 if the bitstream that the FPGA would load is signed and complete. The golden one, which
 * is never written, is signed with a key of the first list. */
int Slots_isLoadable(const Slots_Port* port, U32 product);
/* Checks the FPGA's flash at a start, and after each failed load of the FPGA. A new bitstream is
 * tried once. A bitstream is retired if it was tried and not confirmed, or if the FPGA has refused
 * it: it hangs, or runs the golden one. Returns 1 if the FPGA must load again. */
int Slots_settleFpga(const Slots_Port* port, int isRefused);
