// SPDX-License-Identifier: MIT
//
// memory: measures speed, latency and fairness of the memory controller, and compares them with the
// limit of the MCB.

#include "VMemoryMcb2.h"
#include "VMemoryMcb4.h"
#include "VMemoryMcb8.h"
#include "figures.h"
#include "memory_bench.h"
#include <fmt/format.h>

namespace {

Figures figures("Speed, latency and fairness of the memory controller.");
unsigned outstanding = 64; // number of words that a port may request ahead
// lowest fairness of the streams as Jain's index, which is 1 if all streams get the same share
double leastFairness = 1;

struct Mix {
    const char* name;
    // fraction of the requests that are writes, at ports with an even number and at ports with an
    // odd number
    double evenPorts, oddPorts;
};
constexpr Mix mixes[] = {{"reads", 0, 0},
                         {"writes", 1, 1},
                         {"even ports read, odd ports write", 0, 1},
                         {"each port reads and writes", 0.5, 0.5}};

// Returns the number of clocks that the MCB needs for the requests, from the first command to the
// last word. The MCB is driven without a lost clock: words to write are always ready, and words
// that were read are taken at once. Request is any type with the members address, words and read.
template <class Request> uint64_t directMcb(size_t bytes, const std::vector<Request>& requests) {
    McbModel memory(bytes);
    while (!memory.pins.calibDone)
        memory.cycle();
    // pushing: index of the request with the words that are pushed next; issuing: index of the
    // request that is issued next
    size_t pushing = 0, issuing = 0;
    unsigned pushed = 0, promised = 0;
    uint64_t words = 0, popped = 0, clocks = 0;
    for (const Request& r : requests)
        words += r.words;
    for (; popped + memory.wordsWritten < words; ++clocks) {
        McbModel::Pins& m = memory.pins;
        while (pushing < requests.size() && requests[pushing].read)
            ++pushing;
        bool push = pushing < requests.size() && !m.wrFull;
        const Request* next = issuing < requests.size() ? &requests[issuing] : nullptr;
        bool command =
            next && !m.cmdFull &&
            (next->read ? promised + next->words <= McbModel::dataDepth : pushing > issuing);
        m.rdEn = !m.rdEmpty;
        m.wrEn = push;
        m.wrMask = 0;
        m.cmdEn = command;
        if (m.rdEn) {
            --promised;
            ++popped;
        }
        if (push && ++pushed == requests[pushing].words) {
            pushed = 0;
            ++pushing;
        }
        if (command) {
            m.cmdInstr = next->read;
            m.cmdBl = static_cast<uint8_t>(next->words - 1);
            m.cmdByteAddr = next->address;
            promised += next->read ? next->words : 0;
            ++issuing;
        }
        memory.cycle();
    }
    return clocks;
}

// Runs streams on all ports, each through a separate part of the memory. Returns the throughput of
// all ports together as a fraction of the MCB's limit.
template <class Module, unsigned ports>
double stream(const Mix& mix, unsigned size, uint64_t cycles, uint64_t seed) {
    using Bench = MemoryBench<Module, ports>;
    Bench bench(seed);
    for (unsigned p = 0; p < ports; ++p) {
        NpiTraffic& t = bench.requesters.traffic(p);
        t.writes = p % 2 ? mix.oddPorts : mix.evenPorts;
        t.minSize = t.maxSize = size;
        t.byteEnables = t.anyLineWord = false;
        t.sequential = true;
        t.outstanding = outstanding;
        t.bytes = Bench::size / ports;
        t.base = p * t.bytes;
    }
    using Requesters = NpiRequesters<Module>;
    std::vector<typename Requesters::Accepted> accepted;
    bench.requesters.log = &accepted;
    bench.requesters.stop();
    bench.run(200); // calibration
    uint64_t start = bench.bench.cycles();
    uint64_t before = bench.memory.wordsRead + bench.memory.wordsWritten;
    bench.requesters.go();
    bench.run(cycles);
    bench.requesters.stop();
    const auto& model = bench.memory;
    bench.bench.waitFor(
        [&] {
            uint64_t asked = 0;
            for (const auto& a : accepted)
                asked += a.words;
            return bench.requesters.idle() &&
                   model.wordsRead + model.wordsWritten == before + asked;
        },
        "the end", 20000);
    uint64_t clocks = bench.bench.cycles() - start;
    double words = 0, squares = 0;
    for (unsigned p = 0; p < ports; ++p) {
        const auto& c = bench.requesters.counters(p);
        double mine = static_cast<double>(c.readWords + c.writeWords);
        words += mine;
        squares += mine * mine;
    }
    double limit = words / static_cast<double>(directMcb(Bench::size, accepted));
    double rate = words / static_cast<double>(clocks);
    std::string name = fmt::format("MCB, {} ports, {} bytes, {}", ports, 8u << size, mix.name);
    figures.add(name, rate, "64-bit words per clock", limit);
    leastFairness = std::min(leastFairness, words * words / (ports * squares));
    return rate / limit;
}

double streams(uint64_t cycles, uint64_t seed) {
    double worst = 1e9;
    for (unsigned size : {3u, 4u, 5u})
        for (const Mix& mix : mixes) {
            worst = std::min(worst, stream<VMemoryMcb2, 2>(mix, size, cycles, seed));
            worst = std::min(worst, stream<VMemoryMcb4, 4>(mix, size, cycles, seed));
            worst = std::min(worst, stream<VMemoryMcb8, 8>(mix, size, cycles, seed));
        }
    return worst;
}

// Measures the time from a request to the first word that is popped, once while no other port is in
// use, and once while all other ports stream.
template <class Module, unsigned ports> void latency(uint64_t cycles, uint64_t seed) {
    for (unsigned size = 0; size <= 5; ++size) {
        double mean[2];
        for (bool loaded : {false, true}) {
            MemoryBench<Module, ports> bench(seed);
            for (unsigned p = 0; p < ports; ++p) {
                NpiTraffic& t = bench.requesters.traffic(p);
                t.ask = p == 0 ? 0.02 : loaded ? 1 : 0;
                t.writes = p == 0 ? 0 : 0.5;
                t.minSize = t.maxSize = p == 0 ? size : 4;
            }
            bench.run(cycles);
            const auto& c = bench.requesters.counters(0);
            mean[loaded] = static_cast<double>(c.latencySum) / static_cast<double>(c.reads);
        }
        std::string name = fmt::format("MCB, {} ports, read of {} bytes", ports, 8u << size);
        figures.add(name + ", latency while other ports are idle", mean[0], "clocks");
        figures.add(name + ", latency while other ports stream", mean[1], "clocks");
    }
}

} // namespace

int main(int argc, char** argv) {
    figures.app.add_option("--outstanding", outstanding, "words that a port asks for ahead")
        ->check(CLI::Range(32, 256));
    return figures.run(argc, argv, [] {
        const uint64_t cycles = figures.brief ? 500 : 20000, seed = testSeed();
        const double worst = streams(cycles, seed);
        figures.add("memory controllers, lowest share of the limit", worst, "of 1", 0.95);
        figures.add("memory controllers, lowest fairness (Jain)", leastFairness, "of 1", 1);
        if (worst < 0.95)
            figures.miss("a memory controller is below 95 % of its limit");
        latency<VMemoryMcb2, 2>(cycles, seed);
        latency<VMemoryMcb4, 4>(cycles, seed);
        latency<VMemoryMcb8, 8>(cycles, seed);
    });
}
