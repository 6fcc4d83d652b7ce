// SPDX-License-Identifier: MIT
//
// quiet_span: speeds the simulation up. It finds the number of clocks in which only the chip's
// counters would change, and adds these clocks to the counters at once.
//
// It compares all state of the Verilated chip before and after a clock. If only the counters below
// have changed, by their step, every following clock does the same until a counter reaches its
// event or an input changes, because the next state depends only on state and inputs. A core with a
// counter of another kind is therefore never skipped.
//
//   cycles of the system slot   one a clock; no event
//   clocks of the modem's timer one a clock, or held; its event is a tick of 17/16 ms
//   phase of the baud rate      a step a clock; a carry is its event: an eighth of a bit time
//   ticks of the UART's halves  one a tick of the baud rate, or held; the tick at 7 is an event
//
// If cores or the memory change while the platform (bridge, decoder, modem, system slot) does not,
// only the platform is quiet: its clocks are skipped, up to the next tick of the baud rate, while
// stirs_o of sim_soc.v is low (proven: formal.platform_rests).
//
// A tick of the baud rate is also skipped, once the chip has been seen to return to exactly the
// same state after one, except for these counters (proven: formal.modem_uart_rx,
// formal.modem_uart_tx).

#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

class VSoc;
class VSoc___024root;

// SocState names the bytes of the Verilated chip's state, to describe differences between two
// moments.
struct SocState {
    using Image = std::vector<unsigned char>;

    static Image of(const VSoc___024root& root);
    // Returns the names of the signals that differ, as paths in the chip: "u_modem.u_timer.clocks".
    static std::vector<std::string> differences(const Image& a, const Image& b);
};

class QuietSpan {
public:
    explicit QuietSpan(VSoc& top);

    // Records the chip's state; to be called after each evaluated clock.
    void sample();

    // Number of clocks, starting now, in which the chip or only the platform is quiet; 0 if the
    // chip is busy, or if this is unknown.
    struct Clocks {
        uint64_t chip, platform;
    };
    // Returns the number of clocks, at most `most`, until an input of the chip (or of the platform)
    // may change.
    Clocks look(Clocks most);

    // True if cores or memory signal that the platform must be evaluated in the next clock.
    bool stirs() const;
    void rest(bool rests);

    // Adds `clocks`, at most the result of look(), to the counters. Returns the number of clocks
    // that must still be evaluated, because a tick of the baud rate is in progress.
    uint64_t pass(uint64_t clocks);

    // Returns the name of the core that prevents skipping because it changed in most of the
    // evaluated clocks; empty if there is no such core.
    std::string mover() const;

    // Forgets the recorded state; to be called when an input changes.
    void forget() { hasImage_ = false; }

private:
    struct Counters {
        uint64_t cycles;
        uint32_t phase, timer;
        uint8_t prescaler, rx, tx; // prescaler: counts the carries of `phase`
    };

    Counters counters() const;
    void takeImage();
    bool isPlatformLikeImage();
    void beginPause();
    void blame();
    bool learn(const Counters& now);
    uint64_t age(uint64_t phase) const; // clocks since the last carry
    uint64_t untilEvent(const Counters& now, uint64_t most, bool passesTicks) const;

    VSoc& top_;
    std::vector<unsigned char> image_; // state of the chip at the last full comparison
    bool hasImage_ = false;
    Counters before_{};       // counters at the last comparison
    bool isFixed_ = false;    // true if only counters change in the platform
    bool isAllFixed_ = false; // true if only counters change in the other parts as well
    // true if only counters have changed in the platform, in a clock in which stirs_o was low
    bool isCalm_ = false;
    bool stirs_ = true;   // value of stirs_o before the next clock
    bool stirred_ = true; // value of stirs_o before the last clock
    unsigned since_ = 0;  // clocks evaluated since the whole image was last compared
    // number of clocks for which only the platform is skipped, until the next look
    uint64_t rest_ = 0;
    // ranges in an image that belong to the platform: first and end offset
    std::vector<std::pair<size_t, size_t>> platform_;
    uint32_t step_ = 0; // amount added to the phase per clock
    bool timerRuns_ = false;
    unsigned ticks_ = 0; // ticks of the baud rate since the image was last compared
    // number of clocks after a carry until the chip is again in the state of the image; 0 if
    // unknown
    uint64_t nullAge_ = 0;
    uint8_t rxStep_ = 0, txStep_ = 0; // steps of the UART's tick counters per tick
    // patience_: clocks between two looks at a busy chip; pause_: clocks left until the next look
    unsigned patience_ = 0, pause_ = 0;
    uint64_t busyLooks_ = 0; // comparisons that found the chip busy
    // number of looks at a busy chip in which the changed cores were recorded
    unsigned blamed_ = 0;
    // number of looks in which each core had changed, by the name of the core
    std::map<std::string, unsigned> movers_;
};
