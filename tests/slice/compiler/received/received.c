/* SPDX-License-Identifier: MIT
 *
 * received: a Node and a Marker by value go through Declared.ice's tables, which know the class by
 * its declaration only, in both formats of 1.1 and in 1.0.
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
static int pass(int minor, int sliced) {
    static const Ice_ValueType markerType = {
        "::M::Marker", 0, -1, (Ice_Int)sizeof(Ice_Value), 0, 0, 0};
    Ice_ValueType type = markerType;
    Ice_OutputStream os;
    Ice_InputStream is;
    Ice_OutputValues written;
    Ice_InputValues read;
    M_Node node, *nodeAgain = 0;
    Ice_Value marker = {0, 0}, *markerAgain = 0;
    type.write = Ice_Value_type.write;
    type.read = Ice_Value_type.read;
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
           check(markerAgain && !strcmp(markerAgain->type->id, "::M::Marker"),
                 "the Marker has another type", minor, sliced);
}

int main(void) {
    return pass(1, 0) + pass(1, 1) + pass(0, 1);
}
