// SPDX-License-Identifier: MIT
//
// core_pins: applies the lines of a script to pins at their times, or connects the model of the
// sensor to the pins.

#include "core_pins.h"
#include "map_regs.h"
#include "soc_pins.h"
#include <algorithm>
#include <fcntl.h>
#include <fmt/format.h>
#include <fstream>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <unistd.h>
#include <vector>
#ifdef MAP_PIN_CAMERA_PCLK_I
#include "sensor_model.h"
#endif

namespace {

struct Change {
    uint64_t ns;
    uint32_t mask, bits;
};

uint32_t maskOf(const CorePin& pin) {
    return static_cast<uint32_t>((uint64_t(1) << pin.width) - 1) << pin.lsb;
}

// Log of the output pins. The file is truncated after each line, because a debugger may go back in
// time. The process that continues then overwrites the later lines.
class PinLog {
public:
    explicit PinLog(const std::string& file)
        : fd_(open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) {
        if (fd_ < 0)
            throw std::runtime_error("cannot write '" + file + "'");
    }
    ~PinLog() { close(fd_); }
    PinLog(const PinLog&) = delete;
    PinLog& operator=(const PinLog&) = delete;

    void add(const std::string& line) {
        const ssize_t written = pwrite(fd_, line.data(), line.size(), end_);
        end_ += std::max<ssize_t>(written, 0);
        (void)!ftruncate(fd_, end_);
    }

private:
    int fd_;
    off_t end_ = 0;
};

std::vector<Change> readScript(const std::string& path) {
    std::ifstream in(path);
    if (!in)
        throw std::runtime_error("cannot read '" + path + "'");
    std::vector<Change> changes;
    std::string line;
    for (unsigned n = 1; std::getline(in, line); ++n) {
        auto fail = [&](const std::string& text) {
            throw std::runtime_error(path + ":" + std::to_string(n) + ": " + text);
        };
        std::istringstream words(line.substr(0, line.find('#')));
        double ms = 0;
        std::string name, value, more;
        if (words >> std::ws; words.eof())
            continue;
        if (!(words >> ms >> name >> value) || ms < 0 || words >> more)
            fail("expected a time in ms, a pin such as servo.fault_i, and its value");
        const CorePin* pin = corePins;
        while (pin->name && (pin->isOut || name != pin->name))
            ++pin;
        if (!pin->name)
            fail("no core of this chip has the input pin '" + name + "'");
        size_t read = 0;
        unsigned long number = 0;
        try {
            number = std::stoul(value, &read, 0);
        } catch (const std::exception&) {
        }
        if (read != value.size() || number >> pin->width)
            fail("'" + value + "' does not fit into the " + std::to_string(pin->width) +
                 " bits of " + name);
        changes.push_back({static_cast<uint64_t>(ms * 1e6), maskOf(*pin),
                           static_cast<uint32_t>(number) << pin->lsb});
    }
    std::stable_sort(changes.begin(), changes.end(),
                     [](const Change& a, const Change& b) { return a.ns < b.ns; });
    return changes;
}

} // namespace

void connectPins(SocModel& soc, const std::string& script, const std::string& logFile) {
    auto file = std::make_shared<PinLog>(logFile);
    soc.onClock([&soc, changes = readScript(script), next = size_t(0),
                 inputs = uint32_t(0)]() mutable {
        for (; next < changes.size() && changes[next].ns <= soc.now(); ++next) {
            inputs = (inputs & ~changes[next].mask) | changes[next].bits;
            soc.setCorePins(inputs);
        }
        return next < changes.size() ? (changes[next].ns + SocModel::clkNs - 1) / SocModel::clkNs
                                     : ~uint64_t(0);
    });
    auto log = [&soc, file](uint32_t changed, uint32_t outputs) {
        for (const CorePin* pin = corePins; pin->name; ++pin)
            if (pin->isOut && (changed & maskOf(*pin)))
                file->add(fmt::format("{:.4f} {} {}\n", static_cast<double>(soc.now()) / 1e6,
                                      pin->name, (outputs & maskOf(*pin)) >> pin->lsb));
    };
    soc.onCorePins([log, before = soc.corePins()](uint32_t outputs) mutable {
        log(before ^ outputs, outputs);
        before = outputs;
    });
    log(~0u, soc.corePins());
}

#ifdef MAP_PIN_CAMERA_PCLK_I
void connectSensor(SocModel& soc, const Frame& frame, std::function<bool()> sends,
                   std::function<void(uint32_t pins)> note) {
    soc.onClock([&soc, frame, sends, note, sensor = SensorModel({200, 9}),
                 pins = SensorModel::Pins(), clock = false, still = 0]() mutable {
        clock = !clock;
        if (!clock) { // the sensor changes its pins at the falling edge
            if (sensor.isIdle() && sends())
                sensor.addFrame(frame.pixels, frame.width, frame.height);
            pins = sensor.next();
        }
        const uint32_t all = uint32_t(clock) << MAP_PIN_CAMERA_PCLK_I |
                             uint32_t(pins.vsync) << MAP_PIN_CAMERA_VSYNC_I |
                             uint32_t(pins.href) << MAP_PIN_CAMERA_HREF_I |
                             uint32_t(pins.data) << MAP_PIN_CAMERA_DATA_I;
        soc.setCorePins(all, true);
        if (note)
            note(all);
        // VSYNC goes high after the last line; the core needs a few more clocks to notice this.
        still = sensor.isIdle() && pins.vsync ? still + 1 : 0;
        return soc.cycles() + (still > 32 ? SocModel::clkHz / 1000 : 1);
    });
}
#else
void connectSensor(SocModel&, const Frame&, std::function<bool()>, std::function<void(uint32_t)>) {
    throw std::runtime_error("--camera needs a chip with the camera core (ip/cores.list)");
}
#endif
