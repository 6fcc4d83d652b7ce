/* SPDX-License-Identifier: MIT
 *
 * camera_servant: implements Cores::Camera (Camera.ice) with the camera core in a slot. The
 * processor itself never handles pixels.
 */
#pragma once

#include "Camera.h"
#include "hw_core.h"

typedef struct Camera_Core {
    Cores_Camera servant;
    Hw_Core core;
} Camera_Core;

Hw_Status Camera_Core_init(Camera_Core* self, U32 slot, U32 memory, const Hw_Port* port,
                           void* context);
