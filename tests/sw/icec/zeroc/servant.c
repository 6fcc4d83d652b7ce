/* SPDX-License-Identifier: MIT
 *
 * servant: shared by the servants for ZeroC's test suites.
 */
#include "servant.h"

void* Suite_joined(const Ice_Current* current, const void* a, Ice_Int countA, const void* b,
                   Ice_Int countB, size_t element) {
    size_t first = (size_t)countA * element, second = (size_t)countB * element;
    char* room = Ice_Current_allocate(current, (Ice_Int)(first + second));
    if (room && first)
        memcpy(room, a, first);
    if (room && second)
        memcpy(room + first, b, second);
    return room;
}

void* Suite_reversed(const Ice_Current* current, const void* a, Ice_Int count, size_t element) {
    char* room = Ice_Current_allocate(current, (Ice_Int)((size_t)count * element));
    Ice_Int i;
    for (i = 0; room && i < count; ++i)
        memcpy(room + (size_t)i * element, (const char*)a + (size_t)(count - 1 - i) * element,
               element);
    return room;
}
