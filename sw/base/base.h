/* SPDX-License-Identifier: MIT
 *
 * base: integer types of fixed width for C90, which has no <stdint.h>.
 */
#pragma once

typedef unsigned char U8;
typedef unsigned short U16;
typedef unsigned int U32;
typedef signed short S16;
typedef signed int S32;

/* Compile-time check of the integer types: each line fails to compile if its type has another
 * width. */
typedef char base_check_u16[sizeof(U16) == 2 ? 1 : -1];
typedef char base_check_u32[sizeof(U32) == 4 ? 1 : -1];
