// SPDX-License-Identifier: MIT
//
// second_ground: one more ground in the air of a flight: a modem on a pty of its own, with a clock
// and a recording of its own, for which simulated time waits as for the first one.

#pragma once

#include "ground_step.h"
#include "recording.h"
#include "status_file.h"
#include "xbee.h"

class SecondGround {
public:
    static constexpr uint32_t address = 0x00F0; // of its modem

    // `out`: folder of its files; `replayed`: folder of the flight that is flown again, or none.
    SecondGround(RfChannel& air, const XBee::Options& modem, const std::string& out,
                 const std::string& replayed, std::function<bool()> goOn)
        : status_(out + "/status2"), replayed_(replayed.empty() ? nullptr : open(replayed)),
          recorded_(replayed_ ? nullptr
                              : std::make_unique<RecordedLine>(
                                    pty_, out + "/" + recording,
                                    nlohmann::json{{"flight", nlohmann::json::object()}})),
          modem_(replayed_ ? static_cast<SerialLine&>(*replayed_) : *recorded_, air, modem),
          step_(*status_, pty_, std::move(goOn)) {}
    const std::string& device() const { return pty_.path(); }
    // Returns the time of its next call.
    uint64_t advance(uint64_t now) {
        modem_.advance(now);
        status_.set(now);
        step_.wait(now);
        return std::min(modem_.nextEvent(), std::max(step_.nextEvent(), now + 1));
    }

private:
    static constexpr const char* recording = "flight2.jsonl";
    static std::unique_ptr<ReplayedLine> open(const std::string& folder) {
        return std::make_unique<ReplayedLine>(folder + "/" + recording);
    }

    StatusFile status_;
    PtyLine pty_;
    std::unique_ptr<ReplayedLine> replayed_;
    std::unique_ptr<RecordedLine> recorded_;
    XBee modem_;
    GroundStep step_;
};
