/* SPDX-License-Identifier: MIT
 *
 * ice_adapter: implements object adapters, which find the servant for an identity.
 */
#include "ice_private.h"

#include <string.h>

static Ice_String part(const char* data, size_t size) {
    Ice_String s;
    s.data = data;
    s.size = (Ice_Int)size;
    return s;
}

Ice_Status Ice_Communicator_createObjectAdapterWithEndpoints(Ice_CommunicatorPtr ic,
                                                             const char* name,
                                                             const char* endpoints,
                                                             Ice_ObjectAdapterPtr adapter) {
    Ice_Status status = ICE_OK;
    int t;
    memset(adapter, 0, sizeof *adapter);
    adapter->communicator = ic;
    (void)name;
    icec_lock(ic, ICE_LOCK_STATE);
    while (endpoints && status == ICE_OK) {
        const char* options = icec_optionsOf(ic, endpoints, &t);
        status = ICE_NO_ENDPOINT;
        if (options)
            status = ic->transports[t].endpoint->listen(ic->transports[t].context, options);
        if (ICE_TRANSPORTS > 1 && status == ICE_OK)
            adapter->transports |= (Ice_Byte)(1 << t);
        endpoints = ICE_TRANSPORTS > 1 ? icec_nextEndpoint(endpoints) : 0;
    }
    if (status == ICE_OK) {
        adapter->next = ic->adapters;
        ic->adapters = adapter;
    }
    for (t = 0; ICE_TRANSPORTS > 1 && t < ic->transportCount && status != ICE_OK; ++t)
        /* an adapter that could not listen on all its endpoints stops listening on the others */
        if (adapter->transports >> t & 1)
            (void)ic->transports[t].endpoint->listen(ic->transports[t].context, 0);
    icec_unlock(ic, ICE_LOCK_STATE);
    return status;
}

/* Returns the index of the entry with exactly this identity and facet, or -1. */
static int indexOf(Ice_ObjectAdapterPtr adapter, const Ice_Identity* id, const Ice_String* facet) {
    int s;
    for (s = 0; s < ICE_SERVANTS; ++s)
        if (adapter->servants[s].servant &&
            Ice_String_same(&adapter->servants[s].identity.name, &id->name) &&
            Ice_String_same(&adapter->servants[s].identity.category, &id->category) &&
            Ice_String_same(&adapter->servants[s].facet, facet))
            return s;
    return -1;
}

static Ice_Status change(Ice_ObjectAdapterPtr adapter, Ice_ObjectPtr servant,
                         const Ice_Identity* id, Ice_String facet) {
    Ice_Status status = ICE_LIMIT;
    int s;
    icec_lock(adapter->communicator, ICE_LOCK_STATE);
    s = indexOf(adapter, id, &facet);
    if (!servant) {
        if (s >= 0)
            adapter->servants[s].servant = 0;
        status = s >= 0 ? ICE_OK : ICE_OBJECT_NOT_EXIST;
    } else if (s < 0) {
        for (s = 0; s < ICE_SERVANTS && status != ICE_OK; ++s)
            if (!adapter->servants[s].servant) {
                adapter->servants[s].identity = *id;
                adapter->servants[s].facet = facet;
                adapter->servants[s].servant = servant;
                status = ICE_OK;
            }
    }
    icec_unlock(adapter->communicator, ICE_LOCK_STATE);
    return status;
}

static Ice_Status changeNamed(Ice_ObjectAdapterPtr adapter, Ice_ObjectPtr servant,
                              const char* identity, const char* facet) {
    Ice_Identity id = icec_parseIdentity(identity);
    return id.name.size ? change(adapter, servant, &id, Ice_String_from(facet)) : ICE_PARSE;
}

static Ice_Status changeDefault(Ice_ObjectAdapterPtr adapter, Ice_ObjectPtr servant,
                                const char* category) {
    Ice_Identity id;
    id.name = part("", 0);
    id.category = Ice_String_from(category);
    return change(adapter, servant, &id, id.name);
}

Ice_Status Ice_ObjectAdapter_add(Ice_ObjectAdapterPtr adapter, Ice_ObjectPtr servant,
                                 const char* identity) {
    return changeNamed(adapter, servant, identity, "");
}

Ice_Status Ice_ObjectAdapter_addFacet(Ice_ObjectAdapterPtr adapter, Ice_ObjectPtr servant,
                                      const char* identity, const char* facet) {
    return changeNamed(adapter, servant, identity, facet);
}

Ice_Status Ice_ObjectAdapter_addDefaultServant(Ice_ObjectAdapterPtr adapter, Ice_ObjectPtr servant,
                                               const char* category) {
    return changeDefault(adapter, servant, category);
}

Ice_Status Ice_ObjectAdapter_remove(Ice_ObjectAdapterPtr adapter, const char* identity) {
    return changeNamed(adapter, 0, identity, "");
}

Ice_Status Ice_ObjectAdapter_removeFacet(Ice_ObjectAdapterPtr adapter, const char* identity,
                                         const char* facet) {
    return changeNamed(adapter, 0, identity, facet);
}

Ice_Status Ice_ObjectAdapter_removeDefaultServant(Ice_ObjectAdapterPtr adapter,
                                                  const char* category) {
    return changeDefault(adapter, 0, category);
}

Ice_ObjectPtr Ice_ObjectAdapter_find(Ice_ObjectAdapterPtr adapter, const char* identity) {
    Ice_Identity id = icec_parseIdentity(identity);
    Ice_String none = part("", 0);
    Ice_ObjectPtr found = 0;
    int s;
    icec_lock(adapter->communicator, ICE_LOCK_STATE);
    s = indexOf(adapter, &id, &none);
    if (s >= 0)
        found = adapter->servants[s].servant;
    icec_unlock(adapter->communicator, ICE_LOCK_STATE);
    return found;
}

void Ice_ObjectAdapter_activate(Ice_ObjectAdapterPtr adapter) {
    adapter->active = 1;
}

void Ice_ObjectAdapter_deactivate(Ice_ObjectAdapterPtr adapter) {
    adapter->active = 0;
}

void Ice_ObjectAdapter_destroy(Ice_ObjectAdapterPtr adapter) {
    Ice_ObjectAdapterPtr* at;
    icec_lock(adapter->communicator, ICE_LOCK_STATE);
    for (at = &adapter->communicator->adapters; *at && *at != adapter; at = &(*at)->next)
        ;
    if (*at)
        *at = adapter->next;
    icec_unlock(adapter->communicator, ICE_LOCK_STATE);
}

Ice_Status Ice_ObjectAdapter_createProxy(Ice_ObjectAdapterPtr adapter, const char* identity,
                                         Ice_ObjectPrxPtr prx) {
    Ice_Identity id = icec_parseIdentity(identity);
    return Ice_ObjectAdapter_createProxyTo(adapter, &id, prx);
}

Ice_Status Ice_ObjectAdapter_createProxyTo(Ice_ObjectAdapterPtr adapter,
                                           const Ice_Identity* identity, Ice_ObjectPrxPtr prx) {
    Ice_Status status;
    int t;
    icec_initProxy(prx, adapter->communicator);
    status = icec_setIdentity(prx, &identity->name, &identity->category, 0);
    for (t = 0; t < ICEC_TRANSPORTS(adapter->communicator) && status == ICE_OK; ++t)
        if (ICE_TRANSPORTS == 1 || !adapter->transports || adapter->transports >> t & 1)
            status = icec_addEndpoint(prx, t, 0);
    return status;
}
