/* SPDX-License-Identifier: MIT
 *
 * adder_servant: the interface of a servant for tests, as slice2c would generate it.
 */
#include "hw_core.h"
#include "icec.h"
typedef struct Demo_Adder_Core {
    Ice_Object servant;
    Hw_Core core;
} Demo_Adder_Core;
Hw_Status Demo_Adder_Core_init(Demo_Adder_Core* self, U32 slot, U32 memory, const Hw_Port* port,
                               void* context);
void Demo_Adder_Core_interrupt(Demo_Adder_Core* self);
U32 Demo_Adder_Core_poll(Demo_Adder_Core* self, U32 nowMs);
