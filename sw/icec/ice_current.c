/* SPDX-License-Identifier: MIT
 *
 * ice_current: a servant's questions about the call being dispatched.
 */
#include "icec.h"

Ice_Bool Ice_Current_contextAt(const Ice_Current* current, Ice_Int index, Ice_String* key,
                               Ice_String* value) {
    Ice_InputStream is = current->context;
    Ice_Int left = Ice_InputStream_readSize(&is);
    if (index < 0 || index >= left)
        return 0;
    do {
        *key = Ice_InputStream_readString(&is);
        *value = Ice_InputStream_readString(&is);
    } while (index-- > 0);
    return !is.failed;
}

Ice_Bool Ice_Current_context(const Ice_Current* current, const char* key, Ice_String* value) {
    Ice_String found;
    Ice_Int index;
    for (index = 0; Ice_Current_contextAt(current, index, &found, value); ++index)
        if (Ice_String_is(&found, key))
            return 1;
    return 0;
}

void* Ice_Current_allocate(const Ice_Current* current, Ice_Int bytes) {
    Ice_InputStreamPtr is = current->communicator->decoding;
    Ice_Byte failed = is->failed;
    void* room;
    is->failed = 0;
    room = bytes > 0 ? Ice_InputStream_allocate(is, bytes, 1) : 0;
    is->failed = failed; /* the servant handles the lack of room */
    return room;
}
