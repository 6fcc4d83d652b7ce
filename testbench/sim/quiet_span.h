// SPDX-License-Identifier: MIT
//
// quiet_span: speeds the simulation up. It finds the number of clocks in which only counters of the
// chip would change, and adds these clocks to the counters at once.
//
// It compares the whole state of the Verilated chip before and after a clock. The next state
// depends only on state and inputs. Therefore, if only the counters below have changed, each by its
// step, every following clock changes them in the same way until a counter reaches its event or an
// input changes. A core with any other counter is never skipped.
//
//   cycles of the system slot   one step per clock; no event
//   clocks of the modem's timer one step per clock, or stopped; event: a tick of 17/16 ms
//   phase of the baud rate      one step per clock; event: the carry, every eighth of a bit time
//   ticks of UART rx and tx     one step per tick of the baud rate, or stopped; event: tick 7
//
// If cores or the memory change while the platform (bridge, decoder, modem, system slot) does not,
// only the platform is quiet. Then the platform's clocks are skipped up to the next tick of the
// baud rate, as long as stirs_o of sim_soc.v is low (proven: formal.platform_rests).
//
// A tick of the baud rate is also skipped if an earlier tick has returned the chip to exactly the
// same state, except for these counters (proven: formal.modem_uart_rx, formal.modem_uart_tx).

#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

class VSoc;
class VSoc___024root;

// Names the bytes in the state of the Verilated chip, to describe how the state has changed between
// two times.
struct SocState {
    using Image = std::vector<unsigned char>;

    static Image of(const VSoc___024root& root);
    // Returns the names of the signals that differ between two images, as paths in the chip, such
    // as "u_modem.u_timer.clocks".
    static std::vector<std::string> differences(const Image& a, const Image& b);
};

class QuietSpan {
public:
    explicit QuietSpan(VSoc& top);

    // Records the chip's state. Call this after each evaluated clock.
    void sample();

    // chip: number of clocks, starting now, for which the whole chip is quiet. platform: the same
    // for the platform alone. camera: the same for everything except the camera core and the
    // memory, provided that the outputs of these two to the rest do not change. 0 means that the
    // blocks are busy, or that their state is unknown.
    struct Clocks {
        uint64_t chip, platform, camera;
        // True if the next clock will show whether the camera can work alone (camera_alone.h).
        bool begins = false;
    };
    // Returns the number of clocks that can be skipped. `most` is the number of clocks until an
    // input of the chip, of the platform, or of the chip without the camera's pins may change; the
    // result does not exceed `most`. The caller must end a span early if an input changes earlier.
    // most.camera is 0 while the camera's pins do not change.
    Clocks look(Clocks most);
    // The camera cannot work alone although look() said so; the next trial is later.
    void refuseCamera();
    // Call this after the state of camera and memory has been replaced.
    void replaced();
    // Returns the number of clocks until just before carry number `carry` (1, 2, ...) of the baud
    // rate's phase.
    uint64_t untilCarry(uint64_t carry) const;

    // Returns true if cores or memory may change the platform, so that it must be evaluated in the
    // next clock.
    bool stirs() const;
    void rest(bool rests);

    // Adds `clocks` to the counters; `clocks` must not exceed the result of look(). Returns the
    // number of clocks that were not added and must be evaluated, because a tick of the baud rate
    // is in progress.
    uint64_t pass(uint64_t clocks);

    // Returns the name of the core that prevents skipping, because it changed in most of the
    // evaluated clocks; empty if no core did.
    std::string mover() const;

    // Discards the recorded state. Call this when an input changes.
    void forget() { hasImage_ = hasOthers_ = false; }

private:
    struct Counters {
        uint64_t cycles;
        uint32_t phase, timer;
        uint8_t prescaler, rx, tx; // prescaler: counts the carries of `phase`
    };

    // The signals that are read and changed, in the state of the chip.
    struct Signals {
        uint64_t* cycles = nullptr;
        uint32_t *phase = nullptr, *timer = nullptr;
        uint8_t *prescaler = nullptr, *rx = nullptr, *tx = nullptr;
        const uint8_t *rate = nullptr,
                      *tick = nullptr;   // input and output of the baud rate's counter
        const uint8_t* ticked = nullptr; // last value of the model's input tick_i
    };

    using Image = SocState::Image;
    // parts of an image, each with its first offset and its end offset
    using Ranges = std::vector<std::pair<size_t, size_t>>;

    static Signals signalsOf(VSoc& top);
    Counters counters() const;
    void takeImage();
    bool isLike(const Image& image, const Ranges& ranges) const;
    bool isPlatformLikeImage();
    void beginPause();
    void lookAtOthers(Clocks& clocks, const Counters& now, uint64_t most);
    void blame();
    bool learn(const Counters& now);
    uint64_t age(uint64_t phase) const; // clocks since the last carry
    uint64_t untilEvent(const Counters& now, uint64_t most, bool passesTicks) const;

    VSoc& top_;
    Signals signals_;
    Image image_; // state of the chip at the last full comparison
    bool hasImage_ = false;
    Counters before_{};       // counters at the last comparison
    bool isFixed_ = false;    // true if the platform's state, except for counters, does not change
    bool isAllFixed_ = false; // the same for the state of the whole chip
    // true if there was a clock with a low stirs_o in which the platform's state, except for
    // counters, did not change
    bool isCalm_ = false;
    bool stirs_ = true;   // value of stirs_o before the next clock
    bool stirred_ = true; // value of stirs_o before the last clock
    // number of clocks evaluated since the last comparison with the whole image
    unsigned since_ = 0;
    // number of clocks for which only the platform is skipped before the next call of look()
    uint64_t rest_ = 0;
    Ranges platform_;   // state of the platform
    Ranges remainder_;  // all other state
    Ranges others_;     // state that belongs neither to the platform nor to camera and memory
    Image othersImage_; // state at clock othersAt_; only others_ is valid
    bool hasOthers_ = false, othersIrq_ = false;
    uint64_t samples_ = 0, othersAt_ = 0; // numbers of evaluated clocks
    // othersPatience_: number of calls of look() between two trials for the camera; othersPause_:
    // number of calls until the next trial
    unsigned othersPatience_ = 0, othersPause_ = 0;
    uint32_t step_ = 0; // step of the phase per clock
    bool timerRuns_ = false;
    // number of ticks of the baud rate since the last comparison with the whole image
    unsigned ticks_ = 0;
    // number of clocks from a carry until the chip's state, except counters, equals the image
    // again; 0 if unknown
    uint64_t nullAge_ = 0;
    uint8_t rxStep_ = 0, txStep_ = 0; // steps of the UART's tick counters at each tick
    // patience_: number of clocks between two comparisons of a busy chip; pause_: number of clocks
    // until the next comparison
    unsigned patience_ = 0, pause_ = 0;
    uint64_t busyLooks_ = 0; // number of comparisons that found the chip busy
    // number of comparisons in which the names of the changed cores were recorded
    unsigned blamed_ = 0;
    // number of these comparisons in which each core had changed; the key is the name of the core
    std::map<std::string, unsigned> movers_;
};
