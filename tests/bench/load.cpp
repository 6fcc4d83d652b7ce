// SPDX-License-Identifier: MIT
//
// load: many programs at the ground's engine, one after the other on its three channels: no call is
// lost, doubled or answered wrongly, and memory stays as it is.

#include "../sw/ground/wire.h"
#include "figures.h"
#include <atomic>
#include <fstream>
#include <thread>

namespace {

constexpr int threads = 8;
constexpr size_t callBytes = 40;

double residentKiB() {
    size_t pages = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> pages >> resident;
    return static_cast<double>(resident) * 4;
}

class Load {
public:
    Load(unsigned programs, unsigned calls)
        : programs_(programs), calls_(calls), latencies_(calls) {}
    void run(Figures& figures) {
        std::vector<std::thread> workers;
        for (int i = 0; i < threads; ++i)
            workers.emplace_back([this] { work(); });
        double before = 0;
        wire_.until(
            [&] {
                if (before == 0 && answered_ >= calls_ / 10)
                    before = residentKiB();
                return ended_ == threads;
            },
            1200);
        for (auto& worker : workers)
            worker.join();
        const double grown = residentKiB() - before;
        unsigned arrived = 0;
        for (unsigned count : wire_.received)
            arrived += count;
        std::sort(latencies_.begin(), latencies_.end());
        figures.add("calls answered rightly", answered_, "calls", calls_);
        figures.add("latency, median", at(0.50), "us");
        figures.add("latency, 99 of 100", at(0.99), "us");
        figures.add("memory grown since the first tenth", grown, "KiB");
        if (answered_ != calls_ || arrived != calls_)
            figures.miss(std::to_string(calls_) + " calls, " + std::to_string(arrived) +
                         " arrived, " + std::to_string(answered_) + " answered rightly");
        if (grown > 2048)
            figures.miss("memory has grown by " + std::to_string(grown) + " KiB");
    }

private:
    // Runs one program after the other, until all have been served.
    void work() {
        for (unsigned program; (program = next_++) < programs_;) {
            int fd;
            while ((fd = engine_->connect(-1)) < 0)
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            for (unsigned i = program; i < calls_; i += programs_)
                call(fd, i);
            close(fd);
        }
        ++ended_;
    }
    void call(int fd, unsigned number) {
        Bytes wanted = message(1, callBytes);
        for (unsigned i = 0; i < 4; ++i)
            wanted[20 + i] = static_cast<uint8_t>(number >> 8 * i);
        const auto begin = std::chrono::steady_clock::now();
        writeAll(fd, wanted);
        const bool isRight = readAll(fd, callBytes) == wanted;
        const std::chrono::duration<float, std::micro> took =
            std::chrono::steady_clock::now() - begin;
        answered_ += isRight;
        latencies_[number] = took.count();
    }
    double at(double share) const {
        return latencies_[static_cast<size_t>(share * static_cast<double>(latencies_.size() - 1))];
    }

    const unsigned programs_, calls_;
    std::vector<float> latencies_; // as long from the start: memory is measured
    Wire wire_;
    std::shared_ptr<XBeeAT::Engine> engine_ = wire_.engine();
    std::atomic<unsigned> next_{0}, answered_{0};
    std::atomic<int> ended_{0};
};

} // namespace

int main(int argc, char** argv) {
    Figures figures("Load on the ground's engine: 200 programs, 100,000 calls by 8 threads.");
    return figures.run(argc, argv, [&] {
        Load(figures.brief ? 20 : 200, figures.brief ? 2'000 : 100'000).run(figures);
    });
}
