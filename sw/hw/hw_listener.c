/* SPDX-License-Identifier: MIT
 *
 * hw_listener: stores the listener's proxy twice, so that the task that sets the proxy and the task
 * that uses it never wait for each other.
 */
#include "hw_listener.h"

#include <string.h>

void Hw_Listener_init(Hw_Listener* self) {
    memset(self, 0, sizeof *self);
}

void Hw_Listener_set(Hw_Listener* self, const Ice_ObjectPrx* proxy, const Ice_Current* current) {
    U8 next = (U8)(self->count + 1U);
    Ice_ObjectPrx* stored = self->proxies + (next & 1U);
    int connection = 0;
    /* generation of the connection to which the proxy is bound; 0 if it is not bound */
    U16 generation = 0;
    /* binds a proxy without endpoints and without an adapter id to the connection of this call */
    if (!Ice_ObjectPrx_isNull(proxy) && proxy->endpointsSize == 2 &&
        Ice_Connection_createProxy(current->communicator, current->connection, "listener",
                                   stored) == ICE_OK) {
        connection = stored->connection;
        generation = stored->generation;
    }
    *stored = *proxy;
    if (generation) {
        stored->connection = connection;
        stored->generation = generation;
    }
    self->count = next;
}

int Hw_Listener_get(const Hw_Listener* self, Ice_ObjectPrx* proxy) {
    U8 count;
    do {
        count = self->count;
        *proxy = self->proxies[count & 1U];
    } while (count != self->count);
    return !Ice_ObjectPrx_isNull(proxy);
}
