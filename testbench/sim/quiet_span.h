// SPDX-License-Identifier: MIT
//
// quiet_span: finds the number of clocks in which only the chip's counters would move, and adds
// these clocks to the counters at once.
//
// It compares all state of the Verilated chip before and after a clock. If only the counters below
// have moved, by their step, every following clock does the same until a counter has its event or
// an input moves, because the next state depends only on state and inputs. A core with a counter of
// another kind is therefore never skipped.
//
//   cycles of the system slot   one a clock; no event
//   clocks of the modem's timer one a clock, or held; its event is a tick of 17/16 ms
//   phase of the baud rate      a step a clock; a carry is its event: an eighth of a bit time
//   ticks of the UART's halves  one a tick of the baud rate, or held; the tick at 7 is an event
//
// If cores or the memory move while the platform (bridge, decoder, modem, system slot) does not,
// only the platform is quiet, up to the next tick of the baud rate, while stirs_o of sim_soc.v is
// low (proven: formal.platform_rests).
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

// SocState names the bytes of the Verilated chip's state, for differences between two moments.
struct SocState {
    using Image = std::vector<unsigned char>;

    static Image of(const VSoc___024root& root);
    // Returns the signals that differ, by their paths in the chip: "u_modem.u_timer.clocks".
    static std::vector<std::string> differences(const Image& a, const Image& b);
};

class QuietSpan {
public:
    explicit QuietSpan(VSoc& top);

    // Records the chip's state; to be called after each evaluated clock.
    void sample();

    // Number of clocks from here during which the chip, or only the platform, is quiet; 0 if it is
    // not, or if this is unknown.
    struct Clocks {
        uint64_t chip, platform;
    };
    // Returns at most `most`: the clocks until an input of the chip, or of the platform, may move.
    Clocks look(Clocks most);

    // True if the platform needs a clock, according to cores and memory.
    bool stirs() const;
    void rest(bool rests);

    // Adds `clocks`, at most look()'s result, to the counters. Returns the number that remains:
    // those with a tick of the baud rate in progress, which must be evaluated.
    uint64_t pass(uint64_t clocks);

    // Returns the name of the core that keeps the chip from being quiet: it has changed in most of
    // the evaluated clocks. Empty if no core did.
    std::string mover() const;

    // Forgets the recorded state; to be called when an input changes.
    void forget() { hasImage_ = false; }

private:
    struct Counters {
        uint64_t cycles;
        uint32_t phase, timer;
        uint8_t prescaler, rx, tx; // prescaler: counts the carries of phase
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
    std::vector<unsigned char> image_; // a state of the chip
    bool hasImage_ = false;
    Counters before_{};       // the counters when it was last compared
    bool isFixed_ = false;    // only counters move in the image's platform
    bool isAllFixed_ = false; // nor elsewhere
    bool isCalm_ = false;     // nor in the platform in a clock in which it did not stir
    bool stirs_ = true;       // before the next clock
    bool stirred_ = true;     // before the last one
    unsigned since_ = 0;      // clocks evaluated since the whole image was last compared
    uint64_t rest_ = 0;       // clocks of the platform alone before the next look
    std::vector<std::pair<size_t, size_t>> platform_; // offsets in an image: from, to
    uint32_t step_ = 0;                               // step of the phase per clock
    bool timerRuns_ = false;
    unsigned ticks_ = 0;   // ticks of the baud rate since the image was last compared
    uint64_t nullAge_ = 0; // clocks after a carry the chip is back at the image; 0: not known
    uint8_t rxStep_ = 0, txStep_ = 0;        // steps of the UART's tick counters per tick
    unsigned patience_ = 0, pause_ = 0;      // clocks before the next look at a busy chip
    uint64_t busyLooks_ = 0;                 // comparisons that found the chip busy
    unsigned blamed_ = 0;                    // busy looks in which movers were recorded
    std::map<std::string, unsigned> movers_; // cores, by the looks in which they had moved
};
