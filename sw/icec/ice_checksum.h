/* SPDX-License-Identifier: MIT
 *
 * ice_checksum: checksums of Slice definitions (slice2c --checksum), the same as those of Ice's
 * other compilers: peers that tell each other theirs find out whether their Slice is the same.
 */
#ifndef ICE_CHECKSUM_H
#define ICE_CHECKSUM_H

typedef struct Ice_SliceChecksum {
    const char* id; /* "::M::Thing" */
    const char* checksum;
} Ice_SliceChecksum;

#endif
