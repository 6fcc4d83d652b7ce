// SPDX-License-Identifier: MIT
//
// plugin: the radio's figures as a program sees them: stock ZeroC Ice with the plugin, against IceC
// on the chip's RTL; in simulated time.

#include "chip_world.h"
#include "figures.h"
#include <cstdio>
#include <future>

extern "C" {
#include "echo_uav.h"
}

namespace {

constexpr double serialBytesPerSecond = 1e6 / 90; // 111,111 baud
constexpr int size = 7900, messages = 6;          // bytes of a sequence; a message has up to 8192

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
    explicit Bench(Figures& figures) : figures_(figures), world_(1, port, &heard_) {
        heard_.world = &world_;
        ic_ = world_.client();
        echo_ = world_.echo(ic_);
        echo_->ice_ping();
    }
    ~Bench() { ic_->destroy(); }

    void goodput(double loss, double target, bool down) {
        world_.with([&] { world_.air.weather.loss = loss; });
        const uint64_t begin = world_.ns();
        double seconds = down ? fetched(begin) : taken(begin);
        world_.with([&] { world_.air.weather.loss = 0; });
        double rate = size * messages / seconds;
        std::printf("Ice, goodput %s, %4.0f %% lost: %7.0f bytes/s, %.1f %% of %.0f (target %.0f "
                    "%%)\n",
                    down ? "UAV to ground" : "ground to UAV", loss * 100, rate,
                    rate / serialBytesPerSecond * 100, serialBytesPerSecond, target * 100);
        std::fflush(stdout);
        char name[80];
        std::snprintf(name, sizeof name, "Ice, goodput %s, loss %.2f",
                      down ? "UAV to ground" : "ground to UAV", loss);
        figures_.add(name, rate, "bytes/s", serialBytesPerSecond);
        echo_->ice_ping(); // what is late is over before the next one
    }

    // Small calls, one by one; `floor`: both serial ports and the air alone, for the frames that go
    // (docs/link.md, heads of Ice messages).
    void roundTrip(const char* what, double out, double back, const std::function<void()>& call) {
        std::vector<double> ms;
        for (int i = 0; i < (figures_.brief ? 4 : 33); ++i) {
            const uint64_t begin = world_.ns();
            call();
            if (i > 1) // the first ones bring the head
                ms.push_back(static_cast<double>(world_.ns() - begin) / 1e6);
            world_.sleep(0.06 + i * 0.0003);
        }
        std::sort(ms.begin(), ms.end());
        const double median = ms[ms.size() / 2];
        const double floor =
            2 * (out + back) * 0.09 + 2 * (0.128 + 0.192 + 0.544) + (19 + out + 19 + back) * 0.032;
        std::printf("Ice, round trip of %s (%.0f and %.0f bytes on the line): median %.1f ms, "
                    "longest %.1f, floor %.1f, ratio %.2f (target 1.30)\n",
                    what, out, back, median, ms.back(), floor, median / floor);
        figures_.add(std::string("Ice, round trip of ") + what, median, "ms", floor);
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
    // Two calls are under way, so that the line does not rest between them.
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
    Heard heard_;
    ChipWorld world_;
    Ice::CommunicatorPtr ic_;
    std::shared_ptr<RadioTest::EchoPrx> echo_;
};

} // namespace

int main(int argc, char** argv) {
    Figures figures("Calls of stock ZeroC Ice through the plugin to IceC on the RTL.");
    return figures.run(argc, argv, [&] {
        Bench bench(figures);
        const double targets[][2] = {{0, 0.93}, {0.01, 0.92}, {0.1, 0.82}, {0.3, 0.60}};
        for (bool down : {true, false})
            for (auto [loss, target] : targets)
                if (!figures.brief)
                    bench.goodput(loss, target, down);
        bench.roundTrip("note(int) -> void", 8 + 2, 7, [&] { bench.echo().note(1); });
        const RadioTest::Bytes some(20);
        if (!figures.brief)
            bench.roundTrip("repeat(int, 20 bytes) -> 20 bytes", 8 + 2 + 21, 7 + 21,
                            [&] { bench.echo().repeat(1, some); });
    });
}
