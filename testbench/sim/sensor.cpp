// SPDX-License-Identifier: MIT
//
// sensor: the sensor's model on the chip's pins.

#include "sensor.h"
#include "map_regs.h"
#include <stdexcept>

#ifdef MAP_PIN_CAMERA_PCLK_I
#include "sensor_model.h"

void connectSensor(SocModel& soc, const Frame& frame) {
    soc.onClock([&soc, frame, sensor = SensorModel({200, 9}), pins = SensorModel::Pins(),
                 clock = false]() mutable {
        clock = !clock;
        if (!clock) { // its pins change at the falling edge
            if (sensor.isIdle())
                sensor.addFrame(frame.pixels, frame.width, frame.height);
            pins = sensor.next();
        }
        soc.setCorePins(uint32_t(clock) << MAP_PIN_CAMERA_PCLK_I |
                        uint32_t(pins.vsync) << MAP_PIN_CAMERA_VSYNC_I |
                        uint32_t(pins.href) << MAP_PIN_CAMERA_HREF_I |
                        uint32_t(pins.data) << MAP_PIN_CAMERA_DATA_I);
    });
}
#else
void connectSensor(SocModel&, const Frame&) {
    throw std::runtime_error("--sensor needs a chip with the camera core (ip/cores.list)");
}
#endif
