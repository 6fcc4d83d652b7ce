/* SPDX-License-Identifier: MIT
 *
 * hw_listener: the proxy that receives a core's events. One task sets it, and another task uses it.
 */
#pragma once

#include "icec.h"

typedef struct Hw_Listener {
    Ice_ObjectPrx proxies[2];
    volatile U8 count; /* number of changes; the lowest bit selects the valid one of two proxies */
} Hw_Listener;

/* Initialises a listener without a proxy. */
void Hw_Listener_init(Hw_Listener* self);
/* Stores a proxy that was passed in a call. A proxy without endpoints is called over the connection
 * of this call, until the connection ends. */
void Hw_Listener_set(Hw_Listener* self, const Ice_ObjectPrx* proxy, const Ice_Current* current);
/* Copies the proxy. Returns 0 if no proxy is set. */
int Hw_Listener_get(const Hw_Listener* self, Ice_ObjectPrx* proxy);
