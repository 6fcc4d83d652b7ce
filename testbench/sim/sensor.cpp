// SPDX-License-Identifier: MIT
//
// sensor: the sensor's model on the chip's pins, with a frame each quarter of a second. Its clock
// stops between frames, as many sensors' can.

#include "camera.h"
#include "map_regs.h"
#include "soc_model.h"
#include <algorithm>
#include <stdexcept>

#ifdef MAP_PIN_CAMERA_PCLK_I
#include "sensor_model.h"

void connectSensor(SocModel& soc, const Frame& frame) {
    constexpr uint64_t period = SocModel::clkHz / 4;
    soc.onClock([&soc, frame, sensor = SensorModel({200, 9}), pins = SensorModel::Pins(),
                 clock = false, nextFrame = uint64_t(0), still = 0]() mutable {
        clock = !clock;
        if (!clock) { // its pins change at the falling edge
            if (sensor.isIdle() && soc.cycles() >= nextFrame) {
                sensor.addFrame(frame.pixels, frame.width, frame.height);
                nextFrame = soc.cycles() + period;
            }
            pins = sensor.next();
        }
        soc.setCorePins(uint32_t(clock) << MAP_PIN_CAMERA_PCLK_I |
                        uint32_t(pins.vsync) << MAP_PIN_CAMERA_VSYNC_I |
                        uint32_t(pins.href) << MAP_PIN_CAMERA_HREF_I |
                        uint32_t(pins.data) << MAP_PIN_CAMERA_DATA_I);
        // VSYNC goes high after the last line, and some more clocks show it to the core.
        still = sensor.isIdle() && pins.vsync ? still + 1 : 0;
        return still > 32 ? std::max(nextFrame, soc.cycles() + 1) : soc.cycles() + 1;
    });
}
#else
void connectSensor(SocModel&, const Frame&) {
    throw std::runtime_error("--camera needs a chip with the camera core (ip/cores.list)");
}
#endif
