// SPDX-License-Identifier: MIT
//
// uav_machine: runs the firmware on the host. Simulated time passes only in bus accesses and while
// the firmware is idle.

#include "uav_machine.h"

extern "C" {
#include "ucos_ii.h"
}

namespace {

// The firmware calls C functions for its port; their context is the UavMachine.
SocModel* socOf(void* context) {
    return static_cast<SocModel*>(context);
}

template <class F> auto access(void* context, F f) {
    auto result = f(socOf(context)->fsmc());
    OsHost::interruptPoint();
    return result;
}

const FSMC_Port fsmcPort = {
    [](void* c, U32 a) { return access(c, [=](FsmcMaster& m) { return m.read8(a); }); },
    [](void* c, U32 a, U8 v) { access(c, [=](FsmcMaster& m) { return m.write8(a, v), 0; }); },
    [](void* c, U32 a) { return access(c, [=](FsmcMaster& m) { return m.read16(a); }); },
    [](void* c, U32 a, U16 v) { access(c, [=](FsmcMaster& m) { return m.write16(a, v), 0; }); },
    [](void* c, U32 a) { return access(c, [=](FsmcMaster& m) { return m.read32(a); }); },
    [](void* c, U32 a, U32 v) { access(c, [=](FsmcMaster& m) { return m.write32(a, v), 0; }); }};

constexpr uint64_t ownTickCycles = SocModel::clkHz / OS_TICKS_PER_SEC;

} // namespace

UavMachine::UavMachine(SocModel& soc, std::function<bool()> poll, Firmware firmware)
    : soc_(soc), poll_(std::move(poll)), firmware_(std::move(firmware)),
      tickCycles_(ownTickCycles) {}

void UavMachine::hurry(unsigned times) {
    tickCycles_ = ownTickCycles / times;
}

bool UavMachine::pending() const {
    return soc_.cycles() >= nextTick_ || (soc_.irq() && firmware_.irqEnabled());
}

void UavMachine::serve() {
    if (soc_.cycles() >= nextTick_) {
        nextTick_ += tickCycles_;
        if (!poll_())
            OsHost::stop();
        OSTimeTick();
        return;
    }
    firmware_.irqHandler();
}

void UavMachine::idle() {
    do {
        soc_.tick();
        (void)soc_.passQuiet(nextTick_);
    } while (!pending());
}

void UavMachine::run() {
    nextTick_ = soc_.cycles() + tickCycles_;
    OsHost::setMachine({[this] { idle(); }, [this] { return pending(); }, [this] { serve(); }});
    OSInit();
    board.use();
    firmware_.start(&fsmcPort, &soc_);
    OsHost::run();
}
