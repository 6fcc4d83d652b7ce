/* SPDX-License-Identifier: MIT
 *
 * ice_batch: collects one-way requests and sends them in one message: a header, the number of
 * requests, and the requests without ids.
 */
#include "ice_private.h"

static void restart(Ice_Batch* batch) {
    batch->count = 0;
    icec_beginMessage(&batch->os, ICEC_BATCH);
    Ice_OutputStream_writeInt(&batch->os, 0);
}

/* Sends the batch on an open connection; the caller holds ICE_LOCK_SEND. */
static Ice_Status flush(Ice_ObjectPrxPtr prx) {
    Ice_Batch* batch = prx->batch;
    Ice_Status status;
    icec_patchInt(&batch->os, ICEC_HEADER, batch->count);
    icec_endMessage(&batch->os);
    status = icec_send(prx->communicator, prx->connection, &batch->os);
    restart(batch);
    return status;
}

/* Adds a complete request to the batch. If the batch has no room for the request and has an open
 * connection, sends the batch first. A connection cannot be opened here: while waiting for it, this
 * task could receive another request, and the reply to that request would overwrite the buffer that
 * holds this request. */
static Ice_Status keep(Ice_ObjectPrxPtr prx) {
    Ice_Batch* batch = prx->batch;
    Ice_OutputStreamPtr request = &prx->communicator->request;
    Ice_Status status = ICE_OK;
    if (request->failed || batch->os.failed)
        return ICE_MARSHAL;
    if (request->size > batch->os.capacity - batch->os.size && batch->count) {
        if (prx->connection < 0 ||
            prx->communicator->connections[prx->connection].state != ICE_CONNECTION_OPEN)
            return ICE_LIMIT;
        status = flush(prx);
    }
    if (status == ICE_OK && request->size > batch->os.capacity - batch->os.size)
        return ICE_LIMIT;
    if (status == ICE_OK) {
        Ice_OutputStream_writeBlob(&batch->os, request->data, request->size);
        ++batch->count;
    }
    return status;
}

void Ice_ObjectPrx_ice_batchOneway(Ice_ObjectPrxPtr prx, Ice_Batch* batch, Ice_Byte* data,
                                   Ice_Int size) {
    Ice_OutputStream_init(&batch->os, data, size < ICE_MESSAGE_MAX ? size : ICE_MESSAGE_MAX);
    batch->keep = keep;
    prx->mode = ICE_BATCH_ONEWAY;
    prx->batch = batch;
    restart(batch);
}

Ice_Status Ice_ObjectPrx_ice_flushBatchRequests(Ice_ObjectPrxPtr prx) {
    Ice_Batch* batch = prx->batch;
    Ice_Status status;
    int connection;
    if (!batch || batch->count == 0)
        return ICE_OK;
    /* hides the batch from ice_getConnection, which then connects as for any other call */
    prx->batch = 0;
    status = Ice_ObjectPrx_ice_getConnection(prx, &connection);
    prx->batch = batch;
    if (status != ICE_OK)
        return status;
    icec_lock(prx->communicator, ICE_LOCK_SEND);
    status = flush(prx);
    icec_unlock(prx->communicator, ICE_LOCK_SEND);
    return status;
}
