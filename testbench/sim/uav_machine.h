// SPDX-License-Identifier: MIT
//
// uav_machine: runs the firmware's host build on a SocModel: bus accesses, interrupts, the tick.

#ifndef UAV_MACHINE_H
#define UAV_MACHINE_H

#include "os_host.h"
#include "soc_model.h"

extern "C" {
#include "fsmc.h"
}

class UavMachine {
public:
    // `poll` is called about once a simulated millisecond; when it returns false, run() ends.
    UavMachine(SocModel& soc, std::function<bool()> poll);

    // Boots the firmware and runs it until poll says so; exceptions of the models come through.
    void run();

private:
    void idle();
    bool pending() const;
    void serve();
    void afterAccess();

    SocModel& soc_;
    std::function<bool()> poll_;
    uint64_t nextTick_ = 0;
};

#endif
