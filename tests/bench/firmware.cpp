// SPDX-License-Identifier: MIT
//
// firmware: measures the cost of the firmware on the Cortex-M3, while it flies against the RTL.
//
// Figures are in cycles of the board: processor cycles and, during an access, HCLK cycles at the
// FSMC pins. (The simulated fabric is slower than the board's. As on the board, however, HCLK at
// its pins is 1.2 times as fast as the fabric clock.)

#include "figures.h"
#include "ground.h"
#include "m3_machine.h"
#include <array>
#include <cstdio>

namespace {

constexpr double hclk = 120e6; // the board's
const Ground::Call isAlive = {"uav", "isAlive", 0, {7, 0}};

// A flight of the vehicle's ARM binary with a ground station; it measures the cycles of the
// vehicle's processor.
class MeasuredFlight : public GroundAndChip {
public:
    // `scaled`: factor by which the processor clock is faster than 6/5 of the simulated fabric
    // clock. With 1, the ratio of the clocks is as on the board. With more (a simulated chip with
    // a lower CLK_HZ), the processor still runs at 120 MHz, so that it is as fast as on the board
    // in relation to the radio. `key`: key of the link, or empty. `isTransparent`: true if the
    // vehicle's modem is in transparent mode.
    MeasuredFlight(const std::string& elf, double scaled, const std::vector<uint8_t>& key = {},
                   bool isTransparent = false)
        : GroundAndChip(1), warp(scaled),
          machine(soc, configOf(elf, scaled, key, isTransparent), [this] { return poll(); }) {
        ground.key = key;
        ground.start();
        soc.reset();
        provide(48, 32, nullptr);
        until([this] { return ground.validated; }, 25, "the connection");
    }
    // Runs until `done` returns true. `done` is called every simulated millisecond. Fails with the
    // message `what` after `seconds`.
    void until(std::function<bool()> done, double seconds, const char* what) {
        done_ = std::move(done);
        uint64_t end = soc.now() + static_cast<uint64_t>(seconds * 1e9);
        late_ = false;
        end_ = end;
        machine.run();
        if (late_)
            throw std::runtime_error(std::string(what) + " has not happened within " +
                                     std::to_string(seconds) + " simulated seconds");
    }
    void wait(double seconds) {
        uint64_t end = soc.now() + static_cast<uint64_t>(seconds * 1e9);
        until([this, end] { return soc.now() >= end; }, seconds + 1, "waiting");
    }
    // Makes the calls one after the other; each begins when the previous call has been answered.
    void inTurn(const std::vector<Ground::Call>& calls, double seconds) {
        ground.replies.clear();
        until(ground.calling(calls), seconds, "the calls");
    }
    // Numbers of board cycles so far. awake: the processor did not sleep; own: it computed;
    // waiting: it waited for the FSMC.
    double awake() { return own() + waiting(); }
    double waiting() { return static_cast<double>(cpu().busCycles()) / warp; }
    double own() {
        return static_cast<double>(cpu().cycles()) - static_cast<double>(cpu().sleepingCycles()) -
               static_cast<double>(cpu().busCycles());
    }
    CortexM3& cpu() { return machine.cpu(); }
    double seconds() const { return static_cast<double>(soc.now()) / 1e9; }

    double warp;
    M3Machine machine;

private:
    static M3Machine::Config configOf(const std::string& elf, double scaled,
                                      const std::vector<uint8_t>& key, bool isTransparent) {
        M3Machine::Config config;
        config.firmware = elf;
        config.hclkHz = scaled > 1 ? static_cast<uint32_t>(hclk) : 0;
        config.guardMs = Ground::guardMs;
        config.key = key;
        config.isTransparent = isTransparent;
        return config;
    }
    bool poll() {
        late_ = soc.now() > end_;
        return !late_ && !done_();
    }
    std::function<bool()> done_;
    uint64_t end_ = 0;
    bool late_ = false;
};

constexpr double hclkPerClk = 1.2;
constexpr double entering = 12,
                 // cycles of exception entry and exit; the listener is called before they pass
    leaving = 10;
constexpr unsigned fpgaInterrupt = FirstInterrupt + 6; // EXTI0
constexpr uint8_t fpgaPriority = 0x50;
constexpr double serialLimit = 11'111; // number of bytes per second at 111,111 baud

Figures figures("The firmware on the Cortex-M3 model against the RTL.");

void say(const std::string& name, double value, const std::string& unit, double limit = 0,
         const std::string& remark = "", bool isExact = false) {
    figures.add(name, value, unit, limit);
    if (!remark.empty())
        std::printf("    %s\n", remark.c_str());
    if (limit > 0 && value > limit)
        figures.miss(name + " is over its limit", isExact);
}

struct Range {
    double least = 1e30, most = 0, sum = 0;
    unsigned n = 0;
    void add(double v) {
        least = std::min(least, v);
        most = std::max(most, v);
        sum += v;
        ++n;
    }
    double mean() const { return n ? sum / n : 0; }
};

void stopListening(MeasuredFlight& f) {
    f.cpu().listener.entered = f.cpu().listener.left = nullptr;
    f.cpu().listener.instruction = nullptr;
}

void measureLatencies(MeasuredFlight& f) {
    auto interrupts = std::make_shared<Range>();
    auto switches = std::make_shared<Range>();
    auto routines = std::make_shared<Range>();
    auto rose =
        // fabric clock in which the interrupt line rose; exact if the processor sleeps or accesses
        // the FPGA at this time
        std::make_shared<uint64_t>(0);
    auto begin = std::make_shared<std::array<double, Exceptions::count>>();
    f.soc.onIrq([&f, rose](bool high) {
        if (high)
            *rose = f.soc.cycles();
        f.machine.stm32().setPinB(0, high);
    });
    f.cpu().listener.entered = [=, &f](unsigned n) {
        (*begin)[n] = f.awake();
        if (n == fpgaInterrupt && *rose) {
            interrupts->add(static_cast<double>(f.soc.cycles() - *rose) * hclkPerClk + entering);
            *rose = 0;
        }
    };
    f.cpu().listener.left = [=, &f](unsigned n) {
        if (n == PendSv)
            switches->add(f.awake() - (*begin)[n] + leaving);
        if (n == fpgaInterrupt)
            routines->add(f.awake() - (*begin)[n]);
    };
    f.cpu().countMasked(fpgaPriority);
    const Ground::Call start = {"hwengine1", "startProcessing"};
    const Ground::Call result = {"hwengine1", "getResult"};
    f.inTurn({start, isAlive, result, isAlive, isAlive, start, isAlive, result, isAlive, isAlive},
             20);
    stopListening(f);
    say("interrupt latency, minimum", interrupts->least, "cycles");
    say("interrupt latency, mean", interrupts->mean(), "cycles");
    say("interrupt latency, maximum", interrupts->most, "cycles");
    say("interrupt routine of the FPGA, maximum", routines->most, "cycles", 0,
        "the tick waits for so long");
    say("task switch (PendSV with entry and return), mean", switches->mean(), "cycles");
    say("task switch, maximum", switches->most, "cycles");
    const auto& masked = f.cpu().longestMasked();
    say("interrupts off, longest", static_cast<double>(masked.cycles) / hclk * 1e6, "us", 20,
        "in " + f.machine.stm32().image()->functionAt(masked.from));
}

// Measures calls of isAlive, and judges their cycles also with --brief, so that the regression
// notices a slower firmware. `cycles` is the limit, a little above the present figure.
void measureCalls(MeasuredFlight& f, const std::string& what, double cycles, double share) {
    constexpr unsigned calls = 20;
    const uint32_t servant = f.machine.stm32().image()->symbol("Autopilot_Vehicle_isAlive"),
                   transmit = f.machine.stm32().image()->symbol("Radio_transmit");
    Range toServant, back;
    double interruptAt = 0, servantAt = -1;
    f.cpu().listener.entered = [&](unsigned n) {
        if (n == fpgaInterrupt)
            interruptAt = f.awake();
    };
    f.cpu().listener.instruction = [&](uint32_t address) {
        if (address == servant) {
            servantAt = f.awake();
            toServant.add(servantAt - interruptAt);
        } else if (address == transmit && servantAt >= 0) {
            back.add(f.awake() - servantAt);
            servantAt = -1;
        }
    };
    double awake = f.awake(), waiting = f.waiting(), began = f.seconds();
    f.inTurn(std::vector<Ground::Call>(calls, isAlive), 30);
    awake = f.awake() - awake;
    waiting = f.waiting() - waiting;
    double took = f.seconds() - began;
    stopListening(f);
    double idle = f.awake(), idleFrom = f.seconds();
    f.wait(2);
    idle = (f.awake() - idle) / (f.seconds() - idleFrom); // a second
    double aCall = (awake - idle * took) / calls, aTrip = took / calls;
    say(what + ": processor load without calls (1 kHz tick)", 100 * idle / hclk, "%");
    say(what + ": radio interrupt to servant, mean", toServant.mean(), "cycles");
    say(what + ": servant to first frame of the reply, mean", back.mean(), "cycles");
    say(what + ": all cycles of a call, without ticks", aCall, "cycles", cycles,
        "with acknowledgements", true);
    say(what + ": share of the FSMC in these cycles", 100 * waiting / awake, "%");
    say(what + ": round trip", aTrip * 1e3, "ms");
    say(what + ": the platform's share of the round trip", 100 * aCall / hclk / aTrip, "%", share);
}

void measureStream(MeasuredFlight& f, const std::string& what) {
    // Floods the vehicle with one-way requests of 1 KB to an object that does not exist. The link's
    // send window is always full, and more requests wait in the queue. This loads the link and
    // IceC's dispatcher, but no servant, and causes no replies.
    f.ground.replies.clear();
    uint64_t bytes = 0;
    const std::vector<uint8_t> load(1000, 0x55);
    auto feed = [&] {
        while (f.ground.backlog() < 12000)
            f.ground.call(0, "missing", "listen", 0, load);
        return false;
    };
    double end = f.seconds() + 1; // the requests run for a second before the measurement begins
    f.until([&] { return feed() || f.seconds() > end; }, 3, "the stream");
    double awake = f.awake(), waiting = f.waiting(), began = f.seconds();
    bytes = f.ground.deliveredBytes;
    end = f.seconds() + 5;
    f.until([&] { return feed() || f.seconds() > end; }, 8, "the stream");
    double took = f.seconds() - began,
           goodput = static_cast<double>(f.ground.deliveredBytes - bytes) / took;
    say(what + ": goodput", goodput / 1e3, "kB/s", 0, "messages of 1 KB, no loss");
    say(what + ": goodput as a share of the serial limit", 100 * goodput / serialLimit, "%");
    say(what + ": processor load at 120 MHz", 100 * (f.awake() - awake) / took / hclk, "%", 5);
    say(what + ": share of the FSMC in this load",
        100 * (f.waiting() - waiting) / (f.awake() - awake), "%");
    say(what + ": cycles per byte", (f.awake() - awake) / (goodput * took), "cycles");
}

// Measures a ping: the time from the last byte of the request, at the endpoint, to the first frame
// of the reply.
void measurePings(MeasuredFlight& f, const std::string& program) {
    const ElfImage& image = *f.machine.stm32().image();
    const uint32_t message = image.symbol("XBeeATEndpoint_onMessage"),
                   answered = image.symbol("icec_endReply"),
                   transmit = image.symbol("Radio_transmit");
    Range took;
    double from = -1;
    bool isAnswered = false;
    f.cpu().listener.instruction = [&](uint32_t address) {
        if (address == message)
            from = f.awake(), isAnswered = false;
        else if (address == answered)
            isAnswered = true;
        else if (address == transmit && from >= 0 && isAnswered)
            took.add(f.awake() - from), from = -1;
    };
    f.inTurn(std::vector<Ground::Call>(20, {"hwengine1", "ice_ping", 2}), 60);
    stopListening(f);
    say(program + ": ping, message to first frame of the reply", took.mean(), "cycles");
    // RAM is measured from the first variable to the top of the main stack, which interrupts use.
    say(program + ": RAM with all objects and all stacks, including the main stack",
        image.symbol("stack_top") - image.symbol("data_begin"), "bytes", 131072);
}

// Measures the largest use of each stack: stacks contain zeros at the start, and the bytes that
// have changed are counted.
void measureStacks(MeasuredFlight& f, const std::string& what) {
    const ElfImage& image = *f.machine.stm32().image();
    for (const char* name : {"radioStack", "serverStack", "clientStack", "coresStack", "watchStack",
                             "idleStack", "OSTaskIdleStk"}) {
        // the idle stack is called idleStack in our kernel, and OSTaskIdleStk in the real uC/OS-II
        if (!image.has(name))
            continue;
        uint32_t words = image.size(name) / 4, free = 0;
        while (free < words && f.cpu().word(image.symbol(name) + 4 * free) == 0)
            ++free;
        say(what + ": " + name, 4.0 * (words - free), "bytes", 4.0 * words);
    }
}

// Measures how much of its only stack the minimal program uses. RAM contains zeros at power-on, so
// the stack has been used down to the lowest word that is not 0.
void measureMinimal(const std::string& elf) {
    MeasuredFlight f(elf, 1);
    measurePings(f, "minimal");
    const ElfImage& image = *f.machine.stm32().image();
    uint32_t bottom = image.symbol("stack_bottom"), top = image.symbol("stack_top"), at = bottom;
    while (at < top && f.cpu().word(at) == 0)
        at += 4;
    say("minimal: stack used", top - at, "bytes", top - bottom);
}

} // namespace

int main(int argc, char** argv) {
    std::string elf, minimal;
    figures.app.add_option("--firmware", elf, "ELF file")->required();
    figures.app.add_option("--minimal", minimal, "ELF file of the minimal program, to be compared");
    return figures.run(argc, argv, [&] {
        std::printf("Setting modems up, waiting for the link ...\n");
        if (!figures.brief) {
            MeasuredFlight atBoardsRatio(elf, 1);
            measureLatencies(atBoardsRatio);
            if (!minimal.empty()) {
                measurePings(atBoardsRatio, "full");
                measureMinimal(minimal);
            }
        }
        const double scaled = hclk / (SocModel::clkHz * hclkPerClk);
        const std::vector<uint8_t> key(LINK_KEY_BYTES, 1);
        MeasuredFlight plain(elf, scaled, {}, true);
        measureCalls(plain, "call, transparent, in the clear", 11280, 1);
        if (!figures.brief)
            measureStream(plain, "full stream, transparent, in the clear");
        MeasuredFlight f(elf, scaled);
        measureCalls(f, "call in the clear", 13820, 1);
        if (!figures.brief)
            measureStream(f, "full stream in the clear");
        measureStacks(f, "stack used in the clear");
        MeasuredFlight keyedPlain(elf, scaled, key, true);
        measureCalls(keyedPlain, "call, transparent, with a key", 17120, 2);
        MeasuredFlight keyed(elf, scaled, key);
        measureCalls(keyed, "call with a key", 19650, 2);
        if (!figures.brief)
            measureStream(keyed, "full stream with a key");
        measureStacks(keyed, "stack used with a key");
    });
}
