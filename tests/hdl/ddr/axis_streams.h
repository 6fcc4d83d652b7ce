// SPDX-License-Identifier: MIT
//
// axis_streams: gives axis_memory descriptors and packets, and takes its packets, with random
// pauses.

#ifndef AXIS_STREAMS_H
#define AXIS_STREAMS_H

#include "bench.h"
#include "random.h"
#include <deque>

// Rows of a buffer in memory: bytes of a row, bytes from the begin of one to the next.
struct Window {
    uint32_t base, bytes;
    uint16_t rows;
    uint32_t stride;
    // Address of each byte, in the order of the packet.
    template <class Use> void each(Use use) const {
        for (uint32_t r = 0; r < rows; ++r)
            for (uint32_t b = 0; b < bytes; ++b)
                use(base + r * stride + b);
    }
};

struct Beat {
    uint64_t data;
    uint8_t keep;
    bool last;
};

struct Done {
    uint32_t bytes;
    bool over;
};

template <class Module> class AxisStreams {
public:
    // pause: probability, each clock, that a side does not go on.
    AxisStreams(Bench<Module>& bench, double pause, uint64_t seed)
        : top_(bench.top()), random_(seed), pause_(pause) {
        drive();
        bench.addModel([this] { sample(); }, [this] { drive(); });
    }
    void setPause(double pause) { pause_ = pause; }
    // Forgets descriptors and beats that were not given yet: after a stop.
    void forget() {
        reads.clear();
        writes.clear();
        beats.clear();
        packet_.clear();
        reading_ = writing_ = sending_ = false;
        drive();
    }
    void send(const std::vector<uint8_t>& bytes) {
        for (size_t at = 0; at < bytes.size(); at += 8) {
            Beat beat{0, 0, at + 8 >= bytes.size()};
            for (size_t b = 0; b < 8 && at + b < bytes.size(); ++b) {
                beat.data |= uint64_t(bytes[at + b]) << (8 * b);
                beat.keep |= static_cast<uint8_t>(1u << b);
            }
            beats.push_back(beat);
        }
    }

    std::deque<Window> reads, writes;           // descriptors to give
    std::deque<Beat> beats;                     // to give
    std::vector<std::vector<uint8_t>> received; // whole packets: kept bytes
    std::vector<Done> done;
    uint64_t words = 0; // that were moved

private:
    void sample() {
        if (top_.rst_i)
            return;
        if (top_.read_valid_i && top_.read_ready_o)
            reads.pop_front(), reading_ = false;
        if (top_.write_valid_i && top_.write_ready_o)
            writes.pop_front(), writing_ = false;
        if (top_.s_axis_tvalid_i && top_.s_axis_tready_o)
            beats.pop_front(), sending_ = false, ++words;
        bool taken = top_.m_axis_tvalid_o && top_.m_axis_tready_i;
        Beat beat{top_.m_axis_tdata_o, static_cast<uint8_t>(top_.m_axis_tkeep_o),
                  bool(top_.m_axis_tlast_o)};
        if (held_ && !stopped_ &&
            (!top_.m_axis_tvalid_o || beat.data != was_.data || beat.keep != was_.keep ||
             beat.last != was_.last))
            throw std::runtime_error("AXI-Stream rule broken: a word that waits has changed");
        held_ = top_.m_axis_tvalid_o && !taken;
        stopped_ = top_.stop_i;
        was_ = beat;
        if (taken) {
            ++words;
            for (unsigned b = 0; b < 8; ++b)
                if (beat.keep >> b & 1)
                    packet_.push_back(static_cast<uint8_t>(beat.data >> (8 * b)));
            if (beat.last)
                received.push_back(std::move(packet_)), packet_.clear();
        }
        if (top_.done_valid_o && top_.done_ready_i)
            done.push_back({top_.done_bytes_o, bool(top_.done_over_o)});
    }
    // A waiting valid stays; each side begins and pauses at any time.
    bool go(bool& valid, bool any) { return valid = valid || (any && !random_.chance(pause_)); }
    void drive() {
        top_.read_valid_i = go(reading_, !reads.empty());
        if (top_.read_valid_i) {
            const Window& w = reads.front();
            top_.read_base_i = w.base, top_.read_bytes_i = w.bytes, top_.read_rows_i = w.rows;
            top_.read_stride_i = w.stride;
        }
        top_.write_valid_i = go(writing_, !writes.empty());
        if (top_.write_valid_i) {
            const Window& w = writes.front();
            top_.write_base_i = w.base, top_.write_bytes_i = w.bytes, top_.write_rows_i = w.rows;
            top_.write_stride_i = w.stride;
        }
        top_.s_axis_tvalid_i = go(sending_, !beats.empty());
        if (top_.s_axis_tvalid_i) {
            top_.s_axis_tdata_i = beats.front().data;
            top_.s_axis_tkeep_i = beats.front().keep;
            top_.s_axis_tlast_i = beats.front().last;
        }
        top_.m_axis_tready_i = !random_.chance(pause_);
        top_.done_ready_i = !random_.chance(pause_);
    }

    Module& top_;
    Random random_;
    double pause_;
    bool reading_ = false, writing_ = false, sending_ = false; // valid is high
    bool held_ = false, stopped_ = false;
    Beat was_{};
    std::vector<uint8_t> packet_;
};

#endif
