// SPDX-License-Identifier: MIT
//
// fsmc_burst_master: synchronous accesses of PSRAM (RM0033, 31.5.5): FSMC_CLK, data latency, NWAIT
// one clock ahead.

#include "fsmc_fields.h"
#include "fsmc_master.h"
#include "pin_delays.h"

using namespace fsmc;

// Passes one FSMC_CLK: pins have changed at its falling edge; data and NWAIT are sampled at the
// rising one.
bool FsmcMaster::clockEdge(const Access& access, uint16_t& data) {
    unsigned period = (access.bank->btr >> 20 & 0xF) + 1;
    passHclk(period - period / 2);
    data = pins_.dFromDesign;
    bool ready = pins_.nwaitN != bool(access.bank->bcr & bcrWaitHigh);
    inTime_ = !delays_ || delays_->isSetUpForClock();
    pins_.clk = true;
    show();
    passHclk(period / 2);
    pins_.clk = false;
    show();
    return ready;
}

void FsmcMaster::beginBurst(const Access& access) {
    uint32_t bcr = access.bank->bcr;
    if (!(bcr & (access.write ? bcrBurstWrite : bcrBurst)) || !(bcr & bcrWaitEnable) ||
        (bcr & bcrWaitDuring))
        throw FsmcError(access.name + ": a burst needs BURSTEN or CBURSTRW, WAITEN, and WAITCFG 0");
    if ((access.bank->btr >> 20 & 0xF) == 0)
        throw FsmcError(access.name + ": CLKDIV is 0, which is reserved");
    turnaround(access);
    pins_.a = access.muxed ? access.halfword & ~0xFFFFu : access.halfword;
    pins_.d = static_cast<uint16_t>(access.halfword);
    pins_.dOut = access.muxed;
    pins_.nadvN = false;
    pins_.nweN = !access.write;
    pins_.neN = static_cast<uint8_t>(0xF & ~(1u << access.index));
    show();
    uint16_t nothing;
    clockEdge(access, nothing); // takes the address
    pins_.nadvN = true;
    pins_.dOut = false;
    show();
}

void FsmcMaster::endBurst(const Access& access) {
    pins_.neN = 0xF;
    show();
    pins_.noeN = pins_.nweN = true;
    pins_.nblN = 3;
    pins_.dOut = false;
    show();
    passHclk(2 * ((access.bank->btr >> 20 & 0xF) + 1)); // RM0033: two FSMC_CLK
}

std::vector<uint16_t> FsmcMaster::readBurst(uint32_t address, unsigned halfwords) {
    Access access = decode(address, false);
    beginBurst(access);
    pins_.noeN = false;
    pins_.nblN = 0;
    show();
    unsigned latency = (access.bank->btr >> 24 & 0xF) + 2;
    std::vector<uint16_t> values;
    uint16_t data;
    bool ready = false;
    for (unsigned edge = 1, waited = 0; values.size() < halfwords; ++edge) {
        bool next = clockEdge(access, data);
        if (!inTime_)
            throw FsmcError(access.name + ": data or NWAIT moves in the set-up time of FSMC_CLK");
        if (edge >= latency && ready)
            values.push_back(data), waited = 0;
        else if (++waited > waitLimit)
            throw FsmcError(access.name + ": NWAIT is active for ever");
        ready = next;
    }
    accesses_ += halfwords - 1;
    endBurst(access);
    return values;
}

void FsmcMaster::abortReadBurst(uint32_t address, unsigned edges) {
    Access access = decode(address, false);
    beginBurst(access);
    pins_.noeN = false;
    pins_.nblN = 0;
    show();
    uint16_t nobodys;
    for (unsigned edge = 1; edge < edges; ++edge)
        clockEdge(access, nobodys);
    endBurst(access);
}

void FsmcMaster::writeBurst(uint32_t address, const std::vector<uint16_t>& values, uint8_t lanes) {
    Access access = decode(address, true);
    beginBurst(access);
    unsigned latency = (access.bank->btr >> 24 & 0xF) + 2;
    uint16_t nothing;
    bool ready = false;
    pins_.nblN = static_cast<uint8_t>(3 & ~lanes);
    pins_.dOut = true;
    size_t done = 0;
    for (unsigned edge = 1, waited = 0; done < values.size(); ++edge) {
        pins_.d = values[done];
        show();
        bool next = clockEdge(access, nothing);
        if (!inTime_)
            throw FsmcError(access.name + ": NWAIT moves in the set-up time of FSMC_CLK");
        if (edge >= latency && ready)
            ++done, waited = 0;
        else if (++waited > waitLimit)
            throw FsmcError(access.name + ": NWAIT is active for ever");
        ready = next;
    }
    accesses_ += values.size() - 1;
    endBurst(access);
}
