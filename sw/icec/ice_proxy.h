/* SPDX-License-Identifier: MIT
 *
 * ice_proxy: IceC's own functions that make proxies.
 */
#ifndef ICE_PROXY_H
#define ICE_PROXY_H

#include "icec.h"

/* Makes a null proxy. */
void icec_initProxy(Ice_ObjectPrxPtr prx, Ice_CommunicatorPtr ic);
/* Sets name, category and facet; the last two may be 0. ICE_LIMIT: ICE_IDENTITY_MAX. */
Ice_Status icec_setIdentity(Ice_ObjectPrxPtr prx, const Ice_String* name,
                            const Ice_String* category, const Ice_String* facet);
/* Adds the transport's endpoint; `options` 0: the one that it listens on. ICE_LIMIT:
 * ICE_ENDPOINT_MAX.
 */
Ice_Status icec_addEndpoint(Ice_ObjectPrxPtr prx, const char* options);
/* Returns the options after the transport's name; 0: the text names another transport. */
const char* icec_optionsOf(Ice_CommunicatorPtr ic, const char* text);
/* Splits "category/name", or "name". */
Ice_Identity icec_parseIdentity(const char* text);

#endif
