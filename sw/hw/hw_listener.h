/* SPDX-License-Identifier: MIT
 *
 * hw_listener: the proxy that a core's events go to. One task sets it, another one uses it.
 */
#pragma once

#include "icec.h"

typedef struct Hw_Listener {
    Ice_ObjectPrx proxies[2];
    volatile U8 count; /* number of changes; its lowest bit selects the valid proxy */
} Hw_Listener;

/* Makes a listener without a proxy. */
void Hw_Listener_init(Hw_Listener* self);
/* Stores the proxy that a call passed. A proxy without endpoints is called over the connection of
 * that call, until the connection ends. */
void Hw_Listener_set(Hw_Listener* self, const Ice_ObjectPrx* proxy, const Ice_Current* current);
/* Copies the proxy. Returns 0 if no listener is set. */
int Hw_Listener_get(const Hw_Listener* self, Ice_ObjectPrx* proxy);
