/* SPDX-License-Identifier: MIT
 *
 * client: one operation of an interface that has more.
 */
#include "Linked.h"

static Ice_Communicator ic;

int main(void) {
    Linked_CounterPrx counter;
    Ice_Int sum = 0;
    Ice_initialize(&ic);
    (void)Ice_Communicator_stringToProxy(&ic, "counter:tcp -p 1", &counter);
    (void)Linked_CounterPrx_add(&counter, 1, 2, &sum);
    return (int)sum;
}
