/* SPDX-License-Identifier: MIT
 *
 * ice_operation: finds the function that reads an operation's parameters.
 */
#include "ice_operation.h"

Ice_Status Ice_Object_dispatch(const Ice_Interface* interface, const void* table,
                               Ice_ObjectPtr self, const Ice_Current* current,
                               Ice_InputStreamPtr is, Ice_OutputStreamPtr os) {
    const Ice_Operation* o;
    const Ice_Base* base;
    for (o = interface->operations; o->name; ++o)
        if (Ice_String_is(&current->operation, o->name)) {
            if ((current->mode == ICE_NORMAL) != (o->mode == ICE_NORMAL))
                return ICE_PROTOCOL;
            return o->dispatch(self, table, current, is, os);
        }
    for (base = interface->bases; base && base->interface; ++base) {
        Ice_Status status = Ice_Object_dispatch(base->interface, (const char*)table + base->offset,
                                                self, current, is, os);
        if (status != ICE_OPERATION_NOT_EXIST)
            return status;
    }
    return ICE_OPERATION_NOT_EXIST;
}
