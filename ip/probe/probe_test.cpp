// SPDX-License-Identifier: MIT
//
// probe_test: compares the probe's captures, clock by clock, with the signals that the test
// applied; the probe is called through its servant.

#include "Vprobe_1.h"
#include "Vprobe_4.h"
#include "Vprobe_slot.h"
#include "core_slot.h"
extern "C" {
#include "probe_regs.h"
#include "probe_servant.h"
}

namespace {

void put(IData& port, unsigned, uint32_t value) {
    port = value & 0x7FFFFFFFu;
}
template <size_t Words> void put(VlWide<Words>& port, unsigned word, uint32_t value) {
    port[word] = word + 1 == Words ? value & 0x7FFFFFFFu : value;
}

template <class Module> class ProbeTest : public ::testing::Test {
protected:
    static constexpr unsigned bits = sizeof(Module::signals_i) * 8 - 1, words = (bits + 33) / 64;
    static constexpr unsigned ring = (1u << PROBE_LOG2_BYTES) / 8 / words;
    using Value = std::array<uint32_t, (bits + 1) / 32>;

    ProbeTest() {
        slot_.bench_.addModel([] {}, [this] { drive(); });
        EXPECT_EQ(Probe_Core_init(&core_, coreSlot, coreMemory, &slot_.port, &slot_), HW_OK);
    }
    // Sets the signals for the next clock. On average, some bits change once in `quiet_` clocks.
    void drive() {
        auto& top = slot_.bench_.top();
        ++cycles_;
        if (random_.below(quiet_) == 0)
            for (uint32_t& v : value_)
                v ^= random_.next() & random_.next() & random_.next();
        value_.back() &= 0x7FFFFFFFu;
        for (unsigned w = 0; w < value_.size(); ++w)
            put(top.signals_i, w, value_[w]);
        top.cycles_i = static_cast<uint32_t>(cycles_);
        if (record_)
            given_[cycles_] = value_;
    }
    Probes_State state() {
        Probes_State s{};
        EXPECT_EQ(Probes_Probe_getState(servant(), &s, nullptr), ICE_OK);
        return s;
    }
    Ice_Status arm(uint32_t mask, uint32_t value, bool edge, int after) {
        record_ = true;
        given_.clear();
        return Probes_Probe_arm(servant(), static_cast<Ice_Int>(mask), static_cast<Ice_Int>(value),
                                edge, after, &call_.current);
    }
    Probes_State finish(unsigned limit = 20000) {
        for (unsigned i = 0; i < limit && state().phase != Probes_done; ++i)
            slot_.tick();
        EXPECT_EQ(state().phase, Probes_done);
        return state();
    }
    struct Change {
        uint64_t clock;
        bool gap;
        Value value;
    };
    // Returns the changes in the ring, oldest first. Computes their complete clock counts from the
    // recorded low 32 bits.
    std::vector<Change> capture(const Probes_State& s) {
        std::vector<Ice_Byte> bytes;
        auto read = [&](int first, int end) {
            for (int n; first < end; first += n) {
                n = std::min<int>(end - first, PROBE_READ_BYTES / (8 * words));
                Probes_Bytes part;
                ASSERT_EQ(Probes_Probe_read(servant(), first, n, &part, nullptr), ICE_OK);
                bytes.insert(bytes.end(), part.data, part.data + part.size);
            }
        };
        if (s.wrapped)
            read(s.next, static_cast<int>(ring));
        read(0, s.next);
        std::vector<Change> all;
        for (size_t at = 0; at < bytes.size(); at += 8 * words) {
            uint32_t w[2 * words];
            std::memcpy(w, &bytes[at], sizeof w);
            Change c{w[0] - 2u, (w[1] & 1) != 0, {}};
            for (unsigned i = 0; i < c.value.size(); ++i)
                c.value[i] = w[i + 1] >> 1 | (i + 2 < 2 * words ? w[i + 2] << 31 : 0);
            c.value.back() &= 0x7FFFFFFFu;
            // The first change in the ring is at most 2^31 clocks after the first clock of the
            // test.
            const uint64_t last = all.empty() ? given_.begin()->first : all.back().clock;
            c.clock = last + static_cast<uint32_t>(c.clock - last);
            all.push_back(c);
        }
        return all;
    }
    // Checks that in each clock from the first change to the last, the recorded value is the
    // value that the test applied. Clocks after a loss are not checked.
    void expectGiven(const std::vector<Change>& all, bool loses = false) {
        unsigned found = 0;
        for (size_t i = 0; i < all.size(); ++i) {
            ASSERT_EQ(all[i].value, given_.at(all[i].clock)) << "clock " << all[i].clock;
            found += all[i].gap;
            if (i + 1 == all.size() || all[i + 1].gap)
                continue;
            const auto end = given_.lower_bound(all[i + 1].clock);
            for (auto at = given_.find(all[i].clock); at != end; ++at) {
                ASSERT_EQ(all[i].value, at->second) << "clock " << at->first;
            }
        }
        EXPECT_EQ(found != 0, loses);
    }
    Probes_ProbePtr servant() { return &core_.servant; }

    CoreSlot<Module> slot_;
    Probe_Core core_{};
    DirectCall call_; // context of arm and read
    Random random_{testSeed()};
    std::map<uint64_t, Value> given_;
    Value value_{};
    uint64_t cycles_ = 0;
    unsigned quiet_ = 5;
    bool record_ = false;
};

using Widths = ::testing::Types<Vprobe_1, Vprobe_slot, Vprobe_4>;
TYPED_TEST_SUITE(ProbeTest, Widths);

TYPED_TEST(ProbeTest, StoresSamplesBeforeAndAfterTheTrigger) {
    ASSERT_EQ(this->arm(0x15, 0x11, true, 300), ICE_OK);
    this->slot_.bus_.write(PROBE_BASE, coreMemory + (1u << PROBE_LOG2_BYTES)); // too late
    auto s = this->finish();
    auto all = this->capture(s);
    ASSERT_EQ(all.size(), static_cast<size_t>(s.trigger) + 301);
    this->expectGiven(all);
    const uint64_t at = all[static_cast<size_t>(s.trigger)].clock;
    EXPECT_EQ(this->given_.at(at)[0] & 0x15, 0x11u);
    EXPECT_NE(this->given_.at(at - 1)[0] & 0x15, 0x11u);
    auto fits = [](const auto& given) { return (given->second[0] & 0x15) == 0x11; };
    for (auto i = std::next(this->given_.find(all[0].clock)); i->first < at; ++i)
        EXPECT_FALSE(fits(i) && !fits(std::prev(i))) << "the trigger condition occurred earlier";
    EXPECT_EQ(s.words, static_cast<int>(this->words));
    EXPECT_EQ(s.clkHz, 100000000);
}

TYPED_TEST(ProbeTest, APresentLevelTriggersAtOnce) {
    ASSERT_EQ(this->arm(0, 0, false, 4), ICE_OK); // the last burst to memory is not full
    auto s = this->finish();
    EXPECT_EQ(s.trigger, 0);
    EXPECT_EQ(s.next, 5);
    this->expectGiven(this->capture(s));
}

TYPED_TEST(ProbeTest, AnEdgeTriggerNeedsAChange) {
    this->quiet_ = 1u << 31; // signals change only when the test sets them
    auto become = [&](uint32_t value) {
        this->value_[0] = value;
        for (int i = 0; i < 50; ++i)
            this->slot_.tick();
    };
    become(1);
    ASSERT_EQ(this->arm(1, 1, true, 0), ICE_OK);
    become(3);
    EXPECT_EQ(this->state().phase, Probes_armed);
    become(0);
    EXPECT_EQ(this->state().phase, Probes_armed);
    become(5);
    EXPECT_EQ(this->finish().trigger, 3);
}

// No test can detect whether `settled` in probe.v stops at 7 or wraps around: the capture would
// only end up to 7 clocks later, and flushing a second time has no effect.
TYPED_TEST(ProbeTest, TheRingKeepsTheNewestSamples) {
    this->quiet_ = 2 * this->words;
    ASSERT_EQ(this->arm(0, 1, true, static_cast<int>(this->ring) - 100),
              // with mask 0 the condition is always met, so it never changes, and an edge never
              // triggers
              ICE_OK);
    for (unsigned i = 0; i < this->ring * 3 * this->words; ++i)
        this->slot_.tick();
    EXPECT_EQ(this->state().phase, Probes_armed);
    EXPECT_TRUE(this->state().wrapped);
    ASSERT_EQ(Probes_Probe_stop(this->servant(), nullptr), ICE_OK);
    auto s = this->finish(1);
    EXPECT_EQ(s.trigger, -1);
    auto all = this->capture(s);
    EXPECT_EQ(all.size(), this->ring);
    this->expectGiven(all);
}

TYPED_TEST(ProbeTest, ReportsLostChanges) {
    this->quiet_ = 1;
    this->slot_.memory_.hold(true);
    ASSERT_EQ(this->arm(0, 0, false, 2000), ICE_OK);
    for (unsigned i = 0; i < 1500; ++i)
        this->slot_.tick();
    this->slot_.memory_.hold(false);
    auto s = this->finish();
    auto all = this->capture(s);
    EXPECT_EQ(all.size(), 2001u);
    this->expectGiven(all, true);
    EXPECT_FALSE(all[512].gap);
    for (size_t i = 0; i < 512; ++i) // number of entries in the FIFO
        ASSERT_EQ(all[i + 1].clock - all[i].clock <= 3, true) << i;
}

TYPED_TEST(ProbeTest, TimesAreCorrectAfterTheClockCountOverflows) {
    this->quiet_ = 1u << 31; // no signal changes by itself
    this->cycles_ = 0x7FFFFF00;
    ASSERT_EQ(this->arm(0, 0, false, 2), ICE_OK);
    for (int i = 0; i < 1000; ++i)
        this->slot_.tick();
    this->cycles_ += 0x7FFFFC00;
    auto s = this->finish();
    auto all = this->capture(s);
    ASSERT_EQ(all.size(), 3u);
    EXPECT_EQ(all[1].clock + 2, 0x80000000u);
    EXPECT_EQ(all[2].clock + 2, 0x100000000u);
}

TYPED_TEST(ProbeTest, RefusesSignalsThatDoNotExist) {
    EXPECT_EQ(this->arm(0, 0, false, -1), ICE_UNKNOWN_EXCEPTION);
    EXPECT_EQ(this->arm(0, 0, false, static_cast<int>(this->ring)), ICE_UNKNOWN_EXCEPTION);
    EXPECT_EQ(this->call_.reason(), "after: expected less than the ring's changes");
    EXPECT_EQ(this->state().phase, Probes_off);
    Probes_Bytes bytes;
    for (auto [first, count] : {std::pair<int, int>{-1, 1},
                                {0, -1},
                                {0, 1 + PROBE_READ_BYTES / (8 * this->words)},
                                {this->ring, 1},
                                {this->ring - 1, 2},
                                {this->ring + 1, 0}})
        EXPECT_EQ(Probes_Probe_read(this->servant(), first, count, &bytes, &this->call_.current),
                  ICE_UNKNOWN_EXCEPTION)
            << first << " " << count;
    EXPECT_EQ(Probe_Core_init(&this->core_, coreSlot, 0x1020000, &this->slot_.port, &this->slot_),
              HW_UNALIGNED);
}

TYPED_TEST(ProbeTest, ANewCaptureReplacesTheCurrentOne) {
    for (int round = 0; round < 20; ++round) {
        this->quiet_ = 1 + this->random_.below(8);
        ASSERT_EQ(this->arm(0, 1, true, 5), ICE_OK);
        for (unsigned i = this->random_.below(200); i; --i)
            this->slot_.tick();
        ASSERT_EQ(this->arm(0, 0, false, 20), ICE_OK);
        auto s = this->finish();
        EXPECT_EQ(s.next, 21);
        this->expectGiven(this->capture(s));
    }
}

} // namespace
