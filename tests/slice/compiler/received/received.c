/* SPDX-License-Identifier: MIT
 *
 * received: a Node and a Marker by value go through Declared.ice's tables, which know the class by
 * its declaration only, in both formats of 1.1 and in 1.0; so does an interface that only derives
 * from one by value.
 */
#include "Declared.h"
#include "Definer.h"

#include <stdio.h>
#include <string.h>

static Ice_Byte room[400];
static U32 arena[200];

static int check(int isRight, const char* what, int minor, int sliced) {
    if (!isRight)
        printf("received: %s, in 1.%d, sliced %d\n", what, minor, sliced);
    return isRight ? 0 : 1;
}

/* How many checks fail. */
static int pass(int minor, int sliced, const char* id) {
    Ice_ValueType type = Ice_Value_type;
    Ice_OutputStream os;
    Ice_InputStream is;
    Ice_OutputValues written;
    Ice_InputValues read;
    M_Node node, *nodeAgain = 0;
    Ice_Value marker = {0, 0}, *markerAgain = 0;
    type.id = id;
    marker.type = &type;
    M_Node_init(&node);
    node.id = 7;

    Ice_OutputStream_init(&os, room, (Ice_Int)sizeof room);
    os.minor = (Ice_Byte)minor;
    os.sliced = (Ice_Bool)sliced;
    Ice_OutputStream_beginValues(&os, &written);
    Ice_OutputStream_writeValue(&os, (const Ice_Value*)&node);
    Ice_OutputStream_writeValue(&os, &marker);
    Ice_OutputStream_endValues(&os);

    Ice_InputStream_init(&is, room, os.size);
    is.minor = (Ice_Byte)minor;
    is.arena = arena;
    is.arenaSize = (Ice_Int)sizeof arena;
    Ice_InputStream_beginValues(&is, &read, Declared_ice_valueTypes);
    Ice_InputStream_readValue(&is, &nodeAgain, &M_Node_type);
    Ice_InputStream_readValue(&is, &markerAgain, 0);
    Ice_InputStream_endValues(&is);
    return check(!os.failed && !is.failed, "the message is not read", minor, sliced) ||
           check(nodeAgain && nodeAgain->id == 7, "the Node is not the same", minor, sliced) ||
           check(markerAgain && !strcmp(markerAgain->type->id, id), id, minor, sliced);
}

int main(void) {
    static const char* const ids[] = {"::M::Marker", "::M::SubTag"};
    int failed = 0, i;
    for (i = 0; i < 2; ++i)
        failed += pass(1, 0, ids[i]) + pass(1, 1, ids[i]) + pass(0, 1, ids[i]);
    return failed;
}
