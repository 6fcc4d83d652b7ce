// SPDX-License-Identifier: MIT
//
// latency: how long a call takes from the ground, and from the air, to the core's register and
// back.

#include "figures.h"
#include "ground.h"
#include "map_regs.h"
#include "uav_machine.h"
#include "vision_regs.h"
#include <algorithm>
#include <cstdio>
#include <numeric>

extern "C" {
#include "uav.h"
}

namespace {

struct Times {
    const char* name;
    std::vector<double> ms;
    double mean() const {
        return std::accumulate(ms.begin(), ms.end(), 0.0) / static_cast<double>(ms.size());
    }
};

void measure(Figures& figures) {
    const int calls = figures.brief ? 2 : 50;
    RfChannel air(1);
    Ground ground(air, 6);
    uav_guardMs = Ground::guardMs;
    SocModel soc(air, Ground::uavModem());
    soc.onTime([&](uint64_t now) { return ground.advance(now); });
    soc.reset();
    uint64_t called = 0, heard = 0, written = 0;
    int sent = 0;
    bool opened = false;
    Times fromGround{"call on the ground to the core's register", {}},
        fromAir{"end of its last packet on the air to the register", {}},
        back{"call on the ground to its reply", {}};
    air.onPacket([&](uint64_t now, const RfPacket& packet, RfChannel::Outcome) {
        // The last one that comes before the register is written: the modem cuts a call in packets.
        if (packet.from == 0 && !written)
            heard = now;
    });
    soc.fsmc().onWord = [&](uint32_t address, uint32_t value, bool isWrite) {
        constexpr uint32_t threshold =
            MAP_CONTROL_WINDOW + 64 * MAP_SLOT_VISION + 4 * VISION_THRESHOLD;
        if (isWrite && address == threshold && sent && value == static_cast<uint32_t>(sent) &&
            !written)
            written = soc.now();
    };
    auto ms = [](uint64_t from, uint64_t to) { return static_cast<double>(to - from) / 1e6; };
    UavMachine machine(soc, [&] {
        if (!opened && ground.isUp()) {
            ground.open();
            opened = true;
        }
        if (sent && ground.replies.count(sent) && called) {
            fromGround.ms.push_back(ms(called, written));
            fromAir.ms.push_back(ms(heard, written));
            back.ms.push_back(ms(called, soc.now()));
            called = 0;
        }
        if (ground.validated && !called && sent < calls) {
            ++sent;
            called = soc.now();
            heard = written = 0;
            ground.call(sent, "hwengine1", "setParameterA", 0, {static_cast<uint8_t>(sent), 0});
        }
        return static_cast<int>(back.ms.size()) < calls && soc.now() < 60'000'000'000;
    });
    machine.run();
    if (static_cast<int>(back.ms.size()) != calls)
        throw std::runtime_error("only " + std::to_string(back.ms.size()) + " calls were answered");
    for (const Times* t : {&fromGround, &fromAir, &back}) {
        auto [least, most] = std::minmax_element(t->ms.begin(), t->ms.end());
        std::printf("%-46s %6.2f ms (%.2f to %.2f)\n", t->name, t->mean(), *least, *most);
        figures.add(t->name, t->mean(), "ms").update({{"least", *least}, {"most", *most}});
    }
}

} // namespace

int main(int argc, char** argv) {
    Figures figures("How long a call takes to a core's register and back, in simulated time.");
    return figures.run(argc, argv, [&] { measure(figures); });
}
