/* SPDX-License-Identifier: MIT
 *
 * link_env: data that all parts of a link read.
 */
#pragma once

#include "link_codec.h"
#include "link_port.h"

/* Only link.c writes these fields. Each counter in the statistics is written by only one part. */
typedef struct Link_Env {
    U32 now; /* time of the current call, us */
    const Link_Port* port;
    void* context;
    const Link_Codec* codec;
    Link_Statistics statistics;
} Link_Env;
