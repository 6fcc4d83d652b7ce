/* SPDX-License-Identifier: MIT
 *
 * ice_minimal: communicator and adapter of the minimal run time. Included by icec.h only.
 */
#pragma once

#define ICEC_FULL 0

struct Ice_ObjectAdapter {
    Ice_CommunicatorPtr communicator;
    struct {
        Ice_ObjectPtr servant; /* 0: free */
        const char* name;
    } servants[ICE_SERVANTS];
};

/* Small members first: their offsets are short in the code. */
struct Ice_Communicator {
    const Ice_Endpoint* endpoint;
    void* endpointContext;
    Ice_ObjectAdapterPtr adapter; /* the active one */
    Ice_Byte stopping;
    Ice_Byte busy; /* an operation runs */
    /* Ice_Status: ICE_OK the connection is open, the reply has arrived; ICE_LATER it is awaited. */
    Ice_Byte call;
    Ice_Byte connections[ICE_CONNECTIONS];
    int connection;      /* connection of the call */
    Ice_Int id;          /* id of the call; odd */
    Ice_Int body;        /* start of the encapsulation in `os` */
    Ice_OutputStream os; /* in `out`: a request, or a reply */
    Ice_InputStream is;  /* in `in` */
    U32 arena[ICE_ARENA_BYTES / 4];
    Ice_Byte in[ICE_MESSAGE_MAX], out[ICE_RESULT_MAX];
};
