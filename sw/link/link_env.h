/* SPDX-License-Identifier: MIT
 *
 * link_env: the surroundings of a link, which all its parts read.
 */
#pragma once

#include "link_codec.h"
#include "link_port.h"

/* link.c alone writes these fields; each count of the statistics is written by one part. */
typedef struct Link_Env {
    U32 now; /* time of the present call, us */
    const Link_Port* port;
    void* context;
    const Link_Codec* codec;
    Link_Statistics statistics;
} Link_Env;
