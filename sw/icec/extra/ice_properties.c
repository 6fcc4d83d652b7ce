/* SPDX-License-Identifier: MIT
 *
 * ice_properties: reads properties from a table of strings, and creates object adapters and proxies
 * from these properties.
 */
#include "ice_message.h"

#include <string.h>

void Ice_Communicator_setProperties(Ice_CommunicatorPtr ic, const char* const* table) {
    ic->properties = table;
}

/* Returns the value of the property with the name `key` followed by `suffix`; 0 if this property is
 * not set. */
static const char* find(Ice_CommunicatorPtr ic, const char* key, const char* suffix) {
    const char* const* entry;
    size_t n = strlen(key), m = strlen(suffix);
    for (entry = ic->properties; entry && *entry; ++entry)
        if (strncmp(*entry, key, n) == 0 && strncmp(*entry + n, suffix, m) == 0 &&
            (*entry)[n + m] == '=')
            return *entry + n + m + 1;
    return 0;
}

const char* Ice_Communicator_getProperty(Ice_CommunicatorPtr ic, const char* key) {
    return find(ic, key, "");
}

Ice_Int Ice_Communicator_getPropertyAsInt(Ice_CommunicatorPtr ic, const char* key,
                                          Ice_Int otherwise) {
    const char* text = find(ic, key, "");
    U32 value = 0;
    int negative;
    if (!text)
        return otherwise;
    negative = *text == '-';
    text += negative;
    if (*text == 0)
        return otherwise;
    for (; *text; ++text) {
        U32 digit = (U32)(U8)*text - (U32)'0';
        if (digit > 9 || value > (0x7FFFFFFFU - digit) / 10)
            return otherwise; /* the value is not a number: returns the default, as Ice does */
        value = value * 10 + digit;
    }
    return negative ? -(Ice_Int)value : (Ice_Int)value;
}

Ice_Status Ice_Communicator_propertyToProxy(Ice_CommunicatorPtr ic, const char* key,
                                            Ice_ObjectPrxPtr prx) {
    const char* text = find(ic, key, "");
    if (!text) {
        icec_initProxy(prx, ic);
        return ICE_PARSE;
    }
    return Ice_Communicator_stringToProxy(ic, text, prx);
}

Ice_Status Ice_Communicator_createObjectAdapter(Ice_CommunicatorPtr ic, const char* name,
                                                Ice_ObjectAdapterPtr adapter) {
    return Ice_Communicator_createObjectAdapterWithEndpoints(ic, name, find(ic, name, ".Endpoints"),
                                                             adapter);
}
