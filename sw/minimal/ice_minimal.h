/* SPDX-License-Identifier: MIT
 *
 * ice_minimal: communicator and object adapter of the minimal run time. Only icec.h includes it.
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

/* Small members come first, because small offsets give shorter code. */
struct Ice_Communicator {
    const Ice_Endpoint* endpoint;
    void* endpointContext;
    Ice_ObjectAdapterPtr adapter; /* the active adapter */
    Ice_Byte stopping;
    Ice_Byte busy; /* 1 while an operation runs */
    /* status of the current call: ICE_LATER while its reply is expected. ICE_OK if the connection
     * is open or the reply has arrived. */
    Ice_Byte call;
    Ice_Byte connections[ICE_CONNECTIONS];
    int connection;      /* connection of the current call */
    Ice_Int id;          /* id of the current call; always odd */
    Ice_Int body;        /* start of the encapsulation in `os` */
    Ice_OutputStream os; /* stream that writes to `out`: a request or a reply */
    Ice_InputStream is;  /* stream that reads from `in` */
    U32 arena[ICE_ARENA_BYTES / 4];
    Ice_Byte in[ICE_MESSAGE_MAX], out[ICE_RESULT_MAX];
};
