// SPDX-License-Identifier: MIT
//
// plugin: measures the radio link as a program sees it, in simulated time, with and without a key.
// The program uses stock ZeroC Ice with the plugin; the other side is IceC on the chip's RTL.

#include "chip_world.h"
#include "figures.h"
#include "modem_pair.h"
#include <future>

extern "C" {
#include "echo_uav.h"
}

namespace {

const char* const modes[] = {"in the clear", "with a key"}; // index: hasKey
// Limit for one direction, in bytes per second: full packets through the modem with RN 2
// (4.688 ms is the modem's assumed processing time: docs/simulation.md).
constexpr double mostBytesPerSecond = 100 / (4.688 + 1.5 * 0.320 + 5.312) * 1000;
// size: number of bytes of the sequence in each message; a message may have up to 8192
constexpr int size = 7900, messages = 6;

struct Heard {
    std::atomic<int> count{0};
    std::atomic<uint64_t> bytes{0}, lastNs{0};
    ChipWorld* world = nullptr;
};

const EchoUav_Port port = {[](void* context, int, const U8*, int bytes) {
                               Heard& h = *static_cast<Heard*>(context);
                               h.bytes += static_cast<uint64_t>(bytes);
                               h.lastNs = h.world->ns();
                               ++h.count;
                           },
                           [](void*, int*, U8*, int*) { return -1; },
                           [](void*, int, int, const char*, const U8*, int) {}};

class Bench {
public:
    Bench(Figures& figures, bool hasKey)
        : figures_(figures), hasKey_(hasKey), world_(1, port, &heard_, hasKey) {
        heard_.world = &world_;
        ic_ = world_.client();
        echo_ = world_.echo(ic_);
        echo_->ice_ping();
    }
    ~Bench() { ic_->destroy(); }

    void goodput(double loss, bool down) {
        world_.with([&] { world_.air.weather.loss = loss; });
        const uint64_t begin = world_.ns();
        double seconds = down ? fetched(begin) : taken(begin);
        world_.with([&] { world_.air.weather.loss = 0; });
        double rate = size * messages / seconds;
        char name[80];
        std::snprintf(name, sizeof name, "Ice, goodput %s %s, loss %.2f",
                      down ? "UAV to ground" : "ground to UAV", modes[hasKey_], loss);
        figures_.add(name, rate, "bytes/s", mostBytesPerSecond);
        echo_->ice_ping(); // after this call, no late message can disturb the next figure
    }

    // Makes small calls, one after another. Returns their durations in ms, sorted. Simulated time
    // is not faster than real time meanwhile; otherwise the time that Ice's threads take to start
    // would count several times.
    std::vector<double> times(int calls, const std::function<void()>& call) {
        std::vector<double> ms;
        world_.follow(true);
        for (int i = 0; i < (figures_.brief ? 4 : calls + 2); ++i) {
            const uint64_t begin = world_.ns();
            call();
            if (i > 1) // the first two calls are not counted, because they transfer the full head
                ms.push_back(static_cast<double>(world_.ns() - begin) / 1e6);
            world_.sleep(0.06 + i * 0.0003);
        }
        world_.follow(false);
        std::sort(ms.begin(), ms.end());
        return ms;
    }
    // Measures round trips. `out` and `back` are the sizes of the request's frame and of the
    // reply's frame in bytes, without overhead and without the acknowledgement (docs/link.md, heads
    // of Ice messages).
    void roundTrip(const char* what, size_t out, size_t back, const std::function<void()>& call) {
        const size_t overhead = hasKey_ ? LINK_SECURE_OVERHEAD : LINK_OVERHEAD;
        const auto ms = times(31, call);
        out += overhead;
        back += overhead + 1;
        const double median = ms[ms.size() / 2], floor = floorMs(out, back);
        figures_.add(std::string("Ice, round trip of ") + what + " " + modes[hasKey_], median, "ms",
                     floor);
    }
    // Measures small calls on a separate connection, while pictures from the UAV arrive
    // continuously.
    void headOfLine() {
        const auto fast = world_.echo(ic_, "fast");
        const auto note = [&] { fast->note(1); };
        const auto idle = times(51, note);
        std::atomic<bool> isOver{false};
        std::thread pictures([&] {
            while (!isOver)
                echo_->fetch(size);
        });
        world_.sleep(0.5);
        const auto busy = times(51, note);
        isOver = true;
        pictures.join();
        const double median = busy[busy.size() / 2], alone = idle[idle.size() / 2];
        figures_.add(std::string("Ice, call during a picture transfer ") + modes[hasKey_], median,
                     "ms", alone);
    }
    RadioTest::EchoPrx& echo() { return *echo_; }

private:
    double since(uint64_t begin, uint64_t end) const {
        return static_cast<double>(end - begin) / 1e9;
    }
    double taken(uint64_t begin) {
        const RadioTest::Bytes data(size, 1);
        const int before = heard_.count;
        auto oneway = echo_->ice_oneway();
        for (int i = 0; i < messages; ++i)
            oneway->take(i, data);
        while (heard_.count < before + messages)
            world_.sleep(0.001);
        return since(begin, heard_.lastNs);
    }
    // Fetches messages; two or three calls are in progress at the same time, so that the line is
    // never idle between them.
    double fetched(uint64_t begin) {
        std::deque<std::future<RadioTest::Bytes>> calls;
        for (int i = 0; i < messages; ++i) {
            calls.push_back(echo_->fetchAsync(size));
            if (calls.size() > 2) {
                calls.front().get();
                calls.pop_front();
            }
        }
        for (auto& call : calls)
            call.get();
        return since(begin, world_.ns());
    }
    Figures& figures_;
    const bool hasKey_;
    Heard heard_;
    ChipWorld world_;
    Ice::CommunicatorPtr ic_;
    std::shared_ptr<RadioTest::EchoPrx> echo_;
};

} // namespace

int main(int argc, char** argv) {
    Figures figures("Calls of stock ZeroC Ice through the plugin to IceC on the RTL.");
    return figures.run(argc, argv, [&] {
        for (bool hasKey : {false, true}) {
            Bench bench(figures, hasKey);
            bench.roundTrip("note(int)", 1 + 4, 1, [&] { bench.echo().note(1); });
            if (figures.brief)
                continue;
            const RadioTest::Bytes some(20);
            bench.roundTrip("repeat(int, 20 bytes)", 1 + 4 + 21 + 2 * !hasKey, 1 + 21 + 2 * !hasKey,
                            [&] { bench.echo().repeat(1, some); });
            bench.headOfLine();
            for (bool down : {true, false})
                for (double loss : {0.0, 0.01, 0.1, 0.3})
                    bench.goodput(loss, down);
        }
    });
}
