// SPDX-License-Identifier: MIT
//
// quiet_span: compares the chip's state before and after a clock, and adds skipped clocks to the
// chip's counters. A table of the state (model_state.h) gives the position of each signal.

#include "quiet_span.h"
#include "VSoc.h"
#include "model_state.h"
#include <algorithm>
#include <cstddef>
#include <cstring>
#include <set>
#include <stdexcept>

extern const ModelState VSoc_state;

namespace {

// bits of the baud rate's phase in modem_baud.v: the fraction and the carry
constexpr uint32_t phaseMask = (1u << 18) - 1, phaseCarry = 1u << 18;
constexpr uint32_t timerLast = (1u << 17) - 1; // count at which the timer of modem_timer.v ticks
// lowest code of the baud rate for which each carry is a tick
constexpr unsigned everyCarryTicks = 5;
// number of the last tick of a bit in modem_uart_rx.v and modem_uart_tx.v
constexpr uint8_t lastTick = 7;
// smallest number of clocks that is skipped; fewer clocks are evaluated, because skipping them
// would take longer
constexpr uint64_t worth = 4;
constexpr uint64_t margin = 2; // number of clocks before an event that are always evaluated
// number of clocks after a carry of the phase in which the tick of this carry may still have
// effects
constexpr uint64_t settling = 8;
// initial number of clocks for which only the platform is skipped; the number grows later
constexpr uint64_t least = 8;
// smallest number of clocks for which the camera works alone; copying its state takes as long as
// some tens of clocks
constexpr uint64_t worthAlone = 256;
// largest number of calls of look() between two trials for the camera
constexpr unsigned longestOthers = 4096;
constexpr unsigned longest = 32; // largest number of clocks between two comparisons of a busy chip
// number of comparisons of a busy chip between two records of the cores that have changed
constexpr uint64_t blameEvery = 256;
// blocks of soc.v that are not cores
const std::set<std::string> platform = {"u_platform", "u_modem", "u_system_slot"};
// blocks with their clock stopped while the platform is quiet (testbench/sim/CMakeLists.txt)
const char* const resting[] = {"u_platform.u_fsmc_bridge.", "u_platform.u_bus_decoder.", "u_modem.",
                               "u_system_slot."};
// blocks that the model of the camera contains
const char* const alone[] = {"u_camera.", "u_platform.u_memory."};

template <size_t count> bool isIn(const char* path, const char* const (&blocks)[count]) {
    return std::any_of(std::begin(blocks), std::end(blocks), [path](const char* block) {
        return std::string(path).rfind(block, 0) == 0;
    });
}

// Adds a member to a list of ranges. Variables that are not members, such as Verilator's scratch,
// may lie between two members, so only adjacent members share a range.
void add(std::vector<std::pair<size_t, size_t>>& ranges, size_t offset, size_t size) {
    if (!ranges.empty() && ranges.back().second == offset)
        ranges.back().second = offset + size;
    else
        ranges.emplace_back(offset, offset + size);
}

// Returns the path of a signal in soc.v, or nullptr for a signal of sim_soc.v.
const char* pathInSoc(const ModelMember& member) {
    static const std::string instance = "soc.";
    return std::string(member.path).rfind(instance, 0) == 0 ? member.path + instance.size()
                                                            : nullptr;
}

unsigned char* bytesOf(VSoc& top) {
    return reinterpret_cast<unsigned char*>(top.rootp);
}

// Finds a signal in the chip's state.
template <class T> T* find(VSoc& top, const std::string& path) {
    for (const ModelMember& m : VSoc_state)
        if (m.path == path && m.size == sizeof(T))
            return reinterpret_cast<T*>(bytesOf(top) + m.offset);
    throw std::logic_error("quiet_span: expected a signal " + path + " of " +
                           std::to_string(sizeof(T)) + " bytes in the model of the chip");
}

// Copies one signal of the current state `from` into the image of an earlier state, at the same
// offset.
template <class T>
void copyInto(std::vector<unsigned char>& image, const unsigned char* from, const T& member) {
    auto at = reinterpret_cast<const unsigned char*>(&member) - from;
    std::memcpy(image.data() + at, &member, sizeof member);
}

} // namespace

SocState::Image SocState::of(const VSoc___024root& root) {
    const auto* from = reinterpret_cast<const unsigned char*>(&root);
    return {from, from + VSoc_state.size};
}

std::vector<std::string> SocState::differences(const Image& a, const Image& b) {
    std::vector<std::string> paths;
    for (const ModelMember& m : VSoc_state)
        if (const char* path = pathInSoc(m);
            path && std::memcmp(a.data() + m.offset, b.data() + m.offset, m.size) != 0)
            paths.push_back(path);
    return paths;
}

QuietSpan::Signals QuietSpan::signalsOf(VSoc& top) {
    Signals s;
    s.cycles = find<uint64_t>(top, "soc.u_system_slot.cycles");
    s.phase = find<uint32_t>(top, "soc.u_modem.u_baud.phase");
    s.timer = find<uint32_t>(top, "soc.u_modem.u_timer.clocks");
    s.prescaler = find<uint8_t>(top, "soc.u_modem.u_baud.count");
    s.rx = find<uint8_t>(top, "soc.u_modem.u_uart_rx.ticks");
    s.tx = find<uint8_t>(top, "soc.u_modem.u_uart_tx.ticks");
    s.rate = find<uint8_t>(top, "soc.u_modem.u_baud.bd_i");
    s.tick = find<uint8_t>(top, "soc.u_modem.u_baud.tick_o");
    s.ticked = find<uint8_t>(top, "ticked");
    return s;
}

QuietSpan::QuietSpan(VSoc& top)
    : top_(top), signals_(signalsOf(top)), image_(VSoc_state.size), othersImage_(image_.size()) {
    size_t at = 0; // end of the last member that is not in remainder_
    for (const ModelMember& m : VSoc_state) {
        const bool isSignal = *m.path;
        const char* path = pathInSoc(m);
        const bool isResting = path && isIn(path, resting);
        // All registers are in instances of soc.v, except for the output of the interrupt.
        const bool isOther =
            path && !isResting && std::string(path).rfind("u_", 0) == 0 && !isIn(path, alone);
        if (isResting)
            add(platform_, m.offset, m.size);
        if (isOther)
            add(others_, m.offset, m.size);
        if (isResting || !isSignal) {
            if (at < m.offset)
                add(remainder_, at, m.offset - at);
            at = m.offset + m.size;
        }
    }
    add(remainder_, at, image_.size() - at);
}

// Returns true if the state equals the image in all of the ranges.
bool QuietSpan::isLike(const Image& image, const Ranges& ranges) const {
    const unsigned char* state = bytesOf(top_);
    return std::all_of(ranges.begin(), ranges.end(), [&](const auto& range) {
        const auto [from, to] = range;
        return std::memcmp(image.data() + from, state + from, to - from) == 0;
    });
}

QuietSpan::Counters QuietSpan::counters() const {
    const Signals& s = signals_;
    return {*s.cycles, *s.phase, *s.timer, *s.prescaler, *s.rx, *s.tx};
}

void QuietSpan::takeImage() {
    std::memcpy(image_.data(), top_.rootp, image_.size());
    before_ = counters();
    hasImage_ = true;
    isFixed_ = isAllFixed_ = isCalm_ = false;
    since_ = 0;
    rest_ = least;
    ticks_ = 0;
    nullAge_ = 0;
}

// Returns true if the whole state of the platform, except its counters, equals the image.
bool QuietSpan::isPlatformLikeImage() {
    const unsigned char* now = bytesOf(top_);
    copyInto(image_, now, top_.tick_i);
    copyInto(image_, now, *signals_.ticked);
    copyInto(image_, now, *signals_.cycles);
    copyInto(image_, now, *signals_.phase);
    copyInto(image_, now, *signals_.prescaler);
    copyInto(image_, now, *signals_.timer);
    copyInto(image_, now, *signals_.rx);
    copyInto(image_, now, *signals_.tx);
    return isLike(image_, platform_);
}

void QuietSpan::beginPause() {
    hasImage_ = false;
    patience_ = std::min(patience_ + patience_ / 2 + 1, longest);
    pause_ = patience_;
}

// Records, in some of the comparisons, which cores have changed since the image was taken.
void QuietSpan::blame() {
    if (++busyLooks_ % blameEvery)
        return;
    ++blamed_;
    std::set<std::string> blocks;
    for (const std::string& path : SocState::differences(image_, SocState::of(*top_.rootp)))
        blocks.insert(path.substr(0, path.find('.')));
    for (const std::string& block : blocks)
        if (block.rfind("u_", 0) == 0 &&
            !platform.count(block)) // u_clock_fir is the clock of the core fir
            ++movers_[block.substr(block.rfind("u_clock_", 0) == 0 ? 8 : 2)];
}

std::string QuietSpan::mover() const {
    std::string name;
    unsigned most = blamed_ / 2;
    for (const auto& [block, looks] : movers_)
        if (looks > most) {
            name = block;
            most = looks;
        }
    return name;
}

uint64_t QuietSpan::age(uint64_t phase) const {
    return step_ ? (phase & phaseMask) / step_ : ~0ull;
}

// Returns the number of clocks until the first counter reaches its event, minus the margin.
uint64_t QuietSpan::untilEvent(const Counters& now, uint64_t most, bool passesTicks) const {
    uint64_t clocks = most;
    if (timerRuns_)
        clocks = std::min<uint64_t>(clocks, timerLast - now.timer);
    uint64_t carries =
        nullAge_ && passesTicks ? ~0ull >> 32 : 0; // number of carries that may be skipped
    if (rxStep_)
        carries = std::min<uint64_t>(carries, lastTick - now.rx);
    if (txStep_)
        carries = std::min<uint64_t>(carries, lastTick - now.tx);
    if (step_)
        clocks = std::min<uint64_t>(clocks,
                                    (((carries + 1) << 18) - 1 - (now.phase & phaseMask)) / step_);
    return clocks > margin ? clocks - margin : 0;
}

// Determines the steps of the counters from their values at the last comparison and their current
// values. Returns false if the step of a counter differs from its step before.
bool QuietSpan::learn(const Counters& now) {
    const uint8_t rx = (now.rx - before_.rx) & lastTick, tx = (now.tx - before_.tx) & lastTick;
    if (!isFixed_) { // first call after the image was taken
        uint32_t timerStep = now.timer - before_.timer;
        step_ = (now.phase - before_.phase) & phaseMask;
        timerRuns_ = timerStep == 1;
        rxStep_ = txStep_ = 0;
        isFixed_ = now.cycles - before_.cycles == 1 && timerStep <= 1 && !ticks_ && !rx && !tx;
        return isFixed_;
    }
    if (ticks_ && !nullAge_) {
        if (ticks_ > 1 || rx > 1 || tx > 1 || ((rx | tx) && *signals_.rate < everyCarryTicks))
            return false;
        rxStep_ = rx;
        txStep_ = tx;
        nullAge_ = std::max<uint64_t>(age(now.phase), margin);
    }
    return rx == ((rxStep_ * ticks_) & lastTick) && tx == ((txStep_ * ticks_) & lastTick);
}

void QuietSpan::sample() {
    ticks_ += *signals_.tick;
    ++since_;
    ++samples_;
    stirred_ = stirs_;
    stirs_ = top_.stirs_o;
}

QuietSpan::Clocks QuietSpan::look(Clocks most) {
    if (pause_) {
        --pause_;
        return {};
    }
    if (most.chip < worth && most.platform < worth)
        return {};
    Counters now = counters();
    if (now.phase & phaseCarry || *signals_.tick)
        return {}; // a tick is in progress
    if (!hasImage_) {
        takeImage();
        return {};
    }
    if (!isPlatformLikeImage() || !learn(now)) {
        blame();
        if (isFixed_ && age(now.phase) < settling) // the tick changed more than counters
            takeImage();
        else
            beginPause();
        return {};
    }
    patience_ = 0;
    isCalm_ |= !stirred_ && now.cycles - before_.cycles == 1;
    before_ = now;
    ticks_ = 0;
    Clocks clocks = {untilEvent(now, most.chip, true),
                     isCalm_ ? untilEvent(now, most.platform, false) : 0, 0};
    if (clocks.chip < worth) {
        clocks.chip = 0;
        if (isCalm_ && most.camera)
            lookAtOthers(clocks, now, most.camera);
        return clocks;
    }
    const bool isSame = isLike(image_, remainder_);
    isAllFixed_ = isSame && (isAllFixed_ || since_ == 1);
    since_ = 0;
    if (isSame) {
        rest_ = least;
        // if anything except counters has changed, the next clock is compared again
        return isAllFixed_ ? clocks : Clocks{};
    }
    blame();
    std::memcpy(image_.data(), top_.rootp, image_.size());
    rest_ = std::min(2 * rest_, 8 * uint64_t(longest));
    return {0, std::min(clocks.platform, rest_), 0};
}

// Finds out in two successive clocks whether anything except counters, the camera and the memory
// changes. look() has compared the platform in both clocks.
void QuietSpan::lookAtOthers(Clocks& clocks, const Counters& now, uint64_t most) {
    if (othersPause_) {
        --othersPause_;
        return;
    }
    const uint64_t until = untilEvent(now, most, true);
    if (until < worthAlone)
        return;
    const unsigned char* state = bytesOf(top_);
    const bool isNext = hasOthers_ && samples_ == othersAt_ + 1;
    if (!isNext) {
        for (const auto& [from, to] : others_)
            std::memcpy(othersImage_.data() + from, state + from, to - from);
        othersIrq_ = top_.irq_o;
        hasOthers_ = clocks.begins = true;
        othersAt_ = samples_;
        clocks.platform = 0; // the next clock is evaluated
        return;
    }
    hasOthers_ = false;
    if (othersIrq_ == (top_.irq_o != 0) && isLike(othersImage_, others_))
        clocks.camera = until;
    else
        refuseCamera();
}

void QuietSpan::refuseCamera() {
    othersPatience_ = std::min(2 * othersPatience_ + 1, longestOthers);
    othersPause_ = othersPatience_;
}

void QuietSpan::replaced() {
    stirs_ = top_.stirs_o;
    since_ += 2; // the image is not of the clock before
    hasOthers_ = false;
    othersPatience_ = 0;
}

uint64_t QuietSpan::untilCarry(uint64_t carry) const {
    return step_ ? ((carry << 18) - 1 - (*signals_.phase & phaseMask)) / step_ : ~0ull;
}

bool QuietSpan::stirs() const {
    return top_.stirs_o;
}

void QuietSpan::rest(bool rests) {
    top_.rests_i = rests;
}

uint64_t QuietSpan::pass(uint64_t clocks) {
    Signals& s = signals_;
    const uint64_t low = *s.phase & phaseMask;
    uint64_t passed = clocks;
    while (passed && low + passed * step_ > phaseMask && age(low + passed * step_) < nullAge_)
        --passed;
    const uint64_t phase = low + passed * step_, ticks = phase >> 18;
    *s.cycles += passed;
    *s.phase = static_cast<uint32_t>(phase & phaseMask);
    *s.prescaler = static_cast<uint8_t>((*s.prescaler + ticks) & 31);
    *s.rx = static_cast<uint8_t>((*s.rx + rxStep_ * ticks) & lastTick);
    *s.tx = static_cast<uint8_t>((*s.tx + txStep_ * ticks) & lastTick);
    if (timerRuns_)
        *s.timer += static_cast<uint32_t>(passed);
    before_ = counters();
    return clocks - passed;
}
