/* SPDX-License-Identifier: MIT
 *
 * camera_servant: implements Cores::Camera with the registers of the core, which it accesses
 * through the FSMC. It also gives other servants the location of the frames (Hw_Frames).
 */
#include "camera_servant.h"
#include "camera_regs.h"
#include "fsmc.h"

/* maximum number of reads of STATUS after STOP; a burst in progress ends during the first read */
#define STOP_READS 1000

static U32 get(const Camera_Core* self, U32 word) {
    return FSMC_read(self->core.slot, word);
}

static void set(const Camera_Core* self, U32 word, U32 value) {
    FSMC_write(self->core.slot, word, value);
}

Hw_Status Camera_Core_init(Camera_Core* self, U32 slot, U32 memory, const Hw_Port* port,
                           void* context) {
    Hw_Status status = Hw_Core_init(&self->core, slot, CAMERA_ID_VALUE, port, context);
    if (status != HW_OK)
        return status;
    self->core.memory = memory;
    /* All interrupts are masked, because the core counts frames itself and no task waits for a
     * frame. */
    set(self, CAMERA_MASK, 0);
    Cores_Camera_init(&self->servant);
    return HW_OK;
}

static Ice_Status stop(Camera_Core* self) {
    int i;
    self->core.port->frames->width = 0;
    set(self, CAMERA_CONTROL, CAMERA_CONTROL_STOP_MASK);
    for (i = 0; i < STOP_READS; ++i)
        if (!(get(self, CAMERA_STATUS) & CAMERA_STATUS_ACTIVE_MASK))
            return ICE_OK;
    return ICE_TIMEOUT;
}

static Ice_Status refuse(const Ice_Current* current) {
    return Ice_Current_refuse(current,
                              "width: expected 8 to 2048 in steps of 8; height: 1 to 4095; "
                              "3 frames: at most 4 MiB");
}

Ice_Status Cores_Camera_capture(Cores_CameraPtr servant, Ice_Short width, Ice_Short height,
                                const Ice_Current* current) {
    Camera_Core* self = (Camera_Core*)servant;
    Hw_Frames* frames = self->core.port->frames;
    U32 stride;
    Ice_Status status = stop(self);
    if (status != ICE_OK)
        return status;
    if (width <= 0 || height <= 0)
        return refuse(current);
    stride =
        ((U32)width * (U32)height + CAMERA_ALIGNMENT - 1U) / CAMERA_ALIGNMENT * CAMERA_ALIGNMENT;
    if (stride > CAMERA_MEMORY_BYTES / CAMERA_BUFFERS)
        return refuse(current);
    set(self, CAMERA_SIZE,
        (U32)width << CAMERA_SIZE_WIDTH_LSB | (U32)height << CAMERA_SIZE_HEIGHT_LSB);
    set(self, CAMERA_BASE, self->core.memory);
    set(self, CAMERA_STRIDE, stride);
    set(self, CAMERA_CONTROL, CAMERA_CONTROL_START_MASK);
    if (!(get(self, CAMERA_STATUS) & CAMERA_STATUS_ACTIVE_MASK))
        return refuse(current);
    frames->base = self->core.memory;
    frames->stride = stride;
    frames->height = (U32)height;
    frames->width = (U32)width;
    return ICE_OK;
}

Ice_Status Cores_Camera_stop(Cores_CameraPtr servant, const Ice_Current* current) {
    (void)current;
    return stop((Camera_Core*)servant);
}

Ice_Status Cores_Camera_isActive(Cores_CameraPtr servant, Ice_Int* frames, Ice_Int* dropped,
                                 Ice_Bool* result, const Ice_Current* current) {
    const Camera_Core* self = (const Camera_Core*)servant;
    (void)current;
    *frames = (Ice_Int)get(self, CAMERA_FRAMES);
    *dropped = (Ice_Int)get(self, CAMERA_DROPPED);
    *result = (get(self, CAMERA_STATUS) & CAMERA_STATUS_ACTIVE_MASK) != 0;
    return ICE_OK;
}
