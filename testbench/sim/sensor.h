// SPDX-License-Identifier: MIT
//
// sensor: an image sensor on the camera core's pins.

#ifndef SENSOR_H
#define SENSOR_H

#include "camera.h"
#include "soc_model.h"

// Sends the frame again and again, a pixel every second clock. Throws std::runtime_error if the
// chip has no camera core.
void connectSensor(SocModel& soc, const Frame& frame);

#endif
