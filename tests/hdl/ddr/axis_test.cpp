// SPDX-License-Identifier: MIT
//
// axis_test: axis_memory: packets equal memory, memory equals packets, under every pause of port
// and streams; and its speed, next to the memory's.

#include "VAxisBench.h"
#include "VAxisMemory.h"
#include "axis_streams.h"
#include "direct_drive.h"
#include "mcb_pins.h"
#include "npi_memory.h"
#include <gtest/gtest.h>

namespace {

constexpr uint32_t half = 1 << 16; // bytes that are read; as many after them are written

class Axis : public ::testing::Test {
protected:
    Axis() {
        bench_.reset();
        for (uint32_t a = 0; a < 2 * half; ++a)
            memory_.setByte(a, at(a));
    }
    static uint8_t at(uint32_t address) { return static_cast<uint8_t>(address * 167 >> 5); }
    void wait(size_t packets, size_t written) {
        bench_.waitFor(
            [&] {
                return streams_.received.size() == packets && streams_.done.size() == written &&
                       bench_.top().idle_o;
            },
            "the last packet", 200000);
    }
    // Some rows within 4096 bytes, often one.
    Window any(uint32_t place) {
        Window w{place + 8 * random_.below(16), 1, 1, 0};
        w.bytes = 1 + static_cast<uint32_t>(random_.below(random_.chance(0.5) ? 24 : 300));
        if (random_.chance(0.5)) {
            w.rows = static_cast<uint16_t>(1 + random_.below(6));
            w.stride = (w.bytes + 7) / 8 * 8 + 8 * random_.below(9);
        }
        return w;
    }

    Random random_{testSeed()};
    Bench<VAxisMemory> bench_;
    NpiMemory<VAxisMemory> memory_{bench_, 0.2, testSeed()};
    AxisStreams<VAxisMemory> streams_{bench_, 0.2, testSeed()};
};

TEST_F(Axis, PacketsAreWhatMemoryHolds) {
    std::vector<std::vector<uint8_t>> wanted;
    for (unsigned i = 0; i < 200; ++i) {
        Window w = any(random_.below(half / 4096) * 4096);
        streams_.reads.push_back(w);
        wanted.emplace_back();
        w.each([&](uint32_t a) { wanted.back().push_back(at(a)); });
    }
    for (double pause : {0.0, 0.5, 0.9}) { // each for a while
        streams_.setPause(pause);
        for (unsigned i = 0; i < 2000; ++i)
            bench_.tick();
    }
    streams_.setPause(0.1);
    wait(wanted.size(), 0);
    EXPECT_EQ(streams_.received, wanted);
}

TEST_F(Axis, MemoryIsWhatPacketsHeld) {
    std::vector<Done> wanted;
    std::vector<uint8_t> now(half);
    for (uint32_t a = 0; a < half; ++a)
        now[a] = at(half + a);
    memory_.setLinger(0.3);
    for (unsigned i = 0; i < 200; ++i) {
        Window w = any(half + random_.below(half / 4096) * 4096);
        // A packet of several rows has a word for each begun word of a row: whole words here.
        if (w.rows > 1)
            w.bytes = (w.bytes + 7) / 8 * 8;
        uint32_t room = w.bytes * w.rows;
        std::vector<uint8_t> packet(1 + random_.below(room + (random_.chance(0.3) ? 40 : 0)));
        for (auto& b : packet)
            b = static_cast<uint8_t>(random_.next());
        size_t n = 0;
        w.each([&](uint32_t a) {
            if (n < packet.size())
                now[a - half] = packet[n++];
        });
        wanted.push_back({static_cast<uint32_t>(n), packet.size() > room});
        streams_.writes.push_back(w);
        streams_.send(packet);
    }
    wait(0, wanted.size());
    for (size_t i = 0; i < wanted.size(); ++i) {
        EXPECT_EQ(streams_.done[i].bytes, wanted[i].bytes) << "packet " << i;
        EXPECT_EQ(streams_.done[i].over, wanted[i].over) << "packet " << i;
    }
    for (uint32_t a = 0; a < 2 * half; ++a)
        ASSERT_EQ(memory_.byte(a), a < half ? at(a) : now[a - half]) << "address " << a;
}

TEST_F(Axis, BytesThatAreNotKeptStay) {
    streams_.writes.push_back({half + 8, 24, 1, 0});
    streams_.beats = {{~0ull, 0x0F, false}, {~0ull, 0x00, false}, {~0ull, 0x81, true}};
    wait(0, 1);
    EXPECT_EQ(streams_.done[0].bytes, 24u);
    for (uint32_t b = 0; b < 24; ++b)
        EXPECT_EQ(memory_.byte(half + 8 + b),
                  b < 4 || b == 16 || b == 23 ? 0xFF : at(half + 8 + b));
}

TEST_F(Axis, AStopLeavesNothingBehind) {
    for (unsigned i = 0; i < 100; ++i) {
        streams_.reads.push_back({64 * i, 500, 1, 0});
        streams_.writes.push_back({half + 64 * i, 500, 1, 0});
        streams_.send(std::vector<uint8_t>(500, 1));
        for (uint64_t n = random_.below(200); n > 0; --n)
            bench_.tick();
        bench_.top().stop_i = 1;
        streams_.forget();
        bench_.tick();
        bench_.top().stop_i = 0;
        streams_.forget();
        bench_.waitFor([&] { return bench_.top().idle_o; }, "the end of what was under way");
        streams_.received.clear();
        streams_.done.clear();
        Window w{half + 4096, 100, 1, 0};
        streams_.reads.push_back({8 * i, 100, 1, 0});
        streams_.writes.push_back(w);
        std::vector<uint8_t> packet(100, static_cast<uint8_t>(i));
        streams_.send(packet);
        wait(1, 1);
        for (uint32_t b = 0; b < 100; ++b) {
            EXPECT_EQ(streams_.received[0][b], at(8 * i + b));
            EXPECT_EQ(memory_.byte(w.base + b), packet[b]);
        }
    }
}

// Share of the speed at which the memory carries out the same requests when it is driven directly.
double shareOfLimit(const std::vector<Window>& reads, const std::vector<Window>& writes,
                    const std::string& what) {
    struct Request {
        uint32_t address;
        unsigned words;
        bool read;
    };
    std::vector<Request> requests;
    Bench<VAxisBench> bench;
    McbModel memory(1 << 20);
    bench.addModel(
        [&] {
            if (bench.top().mcb_cmd_en_o)
                requests.push_back({bench.top().mcb_cmd_byte_addr_o, bench.top().mcb_cmd_bl_o + 1u,
                                    bool(bench.top().mcb_cmd_instr_o & 1)});
            sampleMcb(bench.top(), memory);
        },
        [&] { driveMcb(bench.top(), memory); });
    driveMcb(bench.top(), memory);
    AxisStreams<VAxisBench> streams(bench, 0, 1);
    bench.reset();
    bench.waitFor([&] { return bench.top().mcb_calib_done_i; }, "the memory", 1000000);
    uint64_t start = bench.cycles();
    streams.reads.assign(reads.begin(), reads.end());
    streams.writes.assign(writes.begin(), writes.end());
    for (const Window& w : writes)
        streams.send(std::vector<uint8_t>(w.bytes * w.rows, 0x5A));
    bench.waitFor(
        [&] {
            return streams.received.size() == reads.size() && streams.done.size() == writes.size();
        },
        "the last packet", 100000);
    double words = static_cast<double>(streams.words);
    double rate = words / static_cast<double>(bench.cycles() - start);
    double limit = words / static_cast<double>(directMcb(1 << 20, requests));
    printf("%-44s %.3f words a clock of %.3f, %.1f %%\n", what.c_str(), rate, limit,
           100 * rate / limit);
    return rate / limit;
}

TEST(AxisSpeed, IsThatOfThePort) {
    const uint32_t far = 1 << 19;
    EXPECT_GE(shareOfLimit({{0, 65536, 1, 0}}, {}, "reads, one buffer"), 0.95);
    EXPECT_GE(shareOfLimit({}, {{0, 65536, 1, 0}}, "writes, one buffer"), 0.95);
    EXPECT_GE(shareOfLimit({{0, 320, 200, 1280}}, {}, "reads, a window of 200 rows of 320 bytes"),
              0.95);
    EXPECT_GE(shareOfLimit({}, {{0, 320, 200, 1280}}, "writes, a window of 200 rows of 320 bytes"),
              0.95);
    std::vector<Window> in, out;
    for (uint32_t i = 0; i < 256; ++i) {
        in.push_back({256 * i, 256, 1, 0});
        out.push_back({far + 256 * i, 256, 1, 0});
    }
    EXPECT_GE(shareOfLimit(in, {}, "reads, 256 buffers of 256 bytes"), 0.95);
    EXPECT_GE(shareOfLimit({}, out, "writes, 256 buffers of 256 bytes"), 0.95);
    EXPECT_GE(shareOfLimit(in, out, "both at once"), 0.95);
}

} // namespace
