/* SPDX-License-Identifier: MIT
 *
 * ice_builtin: calls the operations that every object has.
 */
#include "ice_message.h"

#define MODE 1 /* mode of requests for these operations: nonmutating, as in Ice */

Ice_Status Ice_ObjectPrx_ice_ping(Ice_ObjectPrxPtr self) {
    Ice_InputStreamPtr is;
    if (!Ice_ObjectPrx_begin(self, "ice_ping", MODE))
        return (Ice_Status)self->status;
    return Ice_ObjectPrx_end(self, Ice_ObjectPrx_invoke(self, &is));
}

Ice_Status Ice_ObjectPrx_ice_isA(Ice_ObjectPrxPtr self, const char* id, Ice_Bool* result) {
    Ice_InputStreamPtr is;
    Ice_OutputStreamPtr os = Ice_ObjectPrx_begin(self, "ice_isA", MODE | ICE_RESULTS);
    Ice_Status status;
    if (!os)
        return (Ice_Status)self->status;
    Ice_OutputStream_writeString(os, Ice_String_from(id));
    status = Ice_ObjectPrx_invoke(self, &is);
    if (status == ICE_OK) {
        *result = Ice_InputStream_readBool(is);
        (void)Ice_InputStream_end(is);
    }
    return Ice_ObjectPrx_end(self, status);
}

Ice_Status Ice_ObjectPrx_ice_id(Ice_ObjectPrxPtr self, Ice_String* result) {
    Ice_InputStreamPtr is;
    Ice_Status status;
    if (!Ice_ObjectPrx_begin(self, "ice_id", MODE | ICE_RESULTS))
        return (Ice_Status)self->status;
    status = Ice_ObjectPrx_invoke(self, &is);
    if (status == ICE_OK) {
        *result = Ice_InputStream_readString(is);
        (void)Ice_InputStream_end(is);
    }
    return Ice_ObjectPrx_end(self, status);
}

Ice_Status Ice_ObjectPrx_checkedCast(Ice_ObjectPrxPtr self, const Ice_ObjectPrx* from,
                                     const char* id) {
    Ice_Bool is = 0;
    Ice_Status status;
    *self = *from;
    if (Ice_ObjectPrx_isNull(from))
        return ICE_OK;
    status = Ice_ObjectPrx_ice_isA(self, id, &is);
    if (status != ICE_OK || !is)
        icec_initProxy(self, from->communicator);
    return status;
}
