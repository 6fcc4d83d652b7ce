/* SPDX-License-Identifier: MIT
 *
 * hw_listener: the proxy that receives a core's events. One task sets it, and another task uses it.
 */
#pragma once

#include "icec.h"

typedef struct Hw_Listener {
    Ice_ObjectPrx proxies[2];
    /* number of changes so far; its lowest bit is the index of the valid proxy */
    volatile U8 count;
} Hw_Listener;

/* Initialises a listener without a proxy. */
void Hw_Listener_init(Hw_Listener* self);
/* Stores a proxy that was a parameter of a call. If the proxy has no endpoints, it is called over
 * the connection of this call, as long as this connection exists. */
void Hw_Listener_set(Hw_Listener* self, const Ice_ObjectPrx* proxy, const Ice_Current* current);
/* Copies the proxy. Returns 0 if no proxy is set. */
int Hw_Listener_get(const Hw_Listener* self, Ice_ObjectPrx* proxy);
