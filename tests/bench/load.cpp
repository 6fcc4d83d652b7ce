// SPDX-License-Identifier: MIT
//
// load: puts the engine and the gateway of the ground under load. Many programs use the engine one
// after the other, on its three channels. Many clients call through the gateway at once. No call
// may be lost, duplicated or answered wrongly, and memory use must stay constant.

#include "../sw/ground/ice/world.h"
#include "../sw/ground/wire.h"
#include "figures.h"
#include <atomic>
#include <fstream>
#include <thread>

namespace {

constexpr size_t callBytes = 40;
constexpr int patienceMs = 600'000; // longest time for which a client waits for its channel, ms

double residentKiB(const std::string& process) {
    size_t pages = 0, resident = 0;
    std::ifstream("/proc/" + process + "/statm") >> pages >> resident;
    return static_cast<double>(resident) * 4;
}

// Programs in this process that use the engine, eight at a time. No two calls have the same number.
class Programs {
public:
    Programs(unsigned programs, unsigned calls)
        : programs_(programs), calls_(calls), latencies_(calls) {}

    // Runs the programs, and watches the memory use of this process.
    void run(Figures& figures) {
        constexpr unsigned threads = 8;
        const std::string process = "self", where = "engine: ";
        std::vector<std::thread> workers;
        for (unsigned i = 0; i < threads; ++i)
            workers.emplace_back([this] { work(); });
        double before = 0;
        wire_.until(
            [&] {
                if (before == 0 && answered_ >= calls_ / 10)
                    before = residentKiB(process);
                return ended_ == threads;
            },
            1'800'000);
        for (auto& worker : workers)
            worker.join();
        const double grown = residentKiB(process) - before;
        unsigned arrived = 0;
        for (unsigned count : wire_.received)
            arrived += count;
        std::sort(latencies_.begin(), latencies_.end());
        figures.add(where + "calls answered correctly", answered_, "calls", calls_);
        figures.add(where + "latency, median", at(0.50), "us");
        figures.add(where + "latency, 99th percentile", at(0.99), "us");
        figures.add(where + "memory growth after the first tenth", grown, "KiB");
        if (answered_ != calls_ || arrived != calls_)
            figures.miss(where + std::to_string(calls_) + " calls, " + std::to_string(arrived) +
                         " arrived, " + std::to_string(answered_) + " answered rightly");
        if (grown > 2048)
            figures.miss(where + "memory has grown by " + std::to_string(grown) + " KiB");
    }

private:
    // Runs one program after another, until all have run; several threads do this at the same
    // time.
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
        Bytes got;
        uint8_t bytes[callBytes];
        for (pollfd p{fd, POLLIN, 0}; got.size() < callBytes && poll(&p, 1, patienceMs) > 0;) {
            const ssize_t count = read(fd, bytes, callBytes - got.size());
            if (count <= 0)
                break;
            got.insert(got.end(), bytes, bytes + count);
        }
        const bool isRight = got == wanted;
        const std::chrono::duration<float, std::micro> took =
            std::chrono::steady_clock::now() - begin;
        answered_ += isRight;
        latencies_[number] = took.count();
    }
    double at(double share) const {
        return latencies_[static_cast<size_t>(share * static_cast<double>(latencies_.size() - 1))];
    }

    Wire wire_;
    std::shared_ptr<XBeeAT::Peer> engine_ = wire_.engine();
    const unsigned programs_, calls_;
    std::vector<float> latencies_; // allocated at the start, because memory use is measured later
    std::atomic<unsigned> next_{0}, answered_{0}, ended_{0};
};

// Stock Ice clients that all call at the same time. The calls pass through the gateway, which is a
// separate process, and over modems and air.
class Clients {
public:
    Clients(const std::string& gateway, unsigned clients)
        : clients_(clients),
          gateway_({gateway, "-d", world_.rig.pty.path(), "-g", std::to_string(Rig::guardMs), "-l",
                    "127.0.0.1:0", "--wait", "3600"}) {
        echo_ = Ice::uncheckedCast<RadioTest::EchoPrx>(ic_->stringToProxy(
            "echo:tcp -h 127.0.0.1 -t 600000 -p " + std::to_string(gateway_.port())));
    }
    void run(Figures& figures, unsigned callsEach) {
        echo_->ice_ping(); // when this call returns, the modem is set up
        std::vector<double> alone, together;
        call(0, 20, alone);
        const double before = residentKiB(std::to_string(gateway_.pid()));
        std::vector<std::thread> threads;
        for (unsigned client = 1; client <= clients_; ++client)
            threads.emplace_back([&, client] { call(client, callsEach, together); });
        for (auto& thread : threads)
            thread.join();
        const double grown = residentKiB(std::to_string(gateway_.pid())) - before;
        std::sort(alone.begin(), alone.end());
        std::sort(together.begin(), together.end());
        const double last = together.empty() ? 0 : together[together.size() * 99 / 100];
        const double fair = clients_ * alone[alone.size() / 2];
        const auto answered = static_cast<double>(together.size());
        figures.add("gateway: calls answered correctly", answered, "calls", clients_ * callsEach);
        figures.add("gateway: call of a single client, median", alone[alone.size() / 2], "us");
        figures.add("gateway: latency, median", together[together.size() / 2], "us");
        figures.add("gateway: latency, 99th percentile", last, "us", 3 * fair);
        figures.add("gateway: memory growth", grown, "KiB");
        if (answered != clients_ * callsEach)
            figures.miss("gateway: calls were lost or answered wrongly");
        if (last > 3 * fair)
            figures.miss("gateway: 1 of 100 calls waits more than three turns of every client");
    }

private:
    // Makes calls on a separate connection, and records the duration of each correct reply.
    void call(unsigned client, unsigned count, std::vector<double>& took) {
        auto echo = echo_->ice_connectionId(std::to_string(client));
        for (unsigned i = 0; i < count; ++i) {
            const auto begin = std::chrono::steady_clock::now();
            const auto bytes = World::pattern(static_cast<int>(client), 20);
            const int id = static_cast<int>(client * 1000 + i);
            if (echo->repeat(id, bytes) != bytes)
                continue;
            const std::chrono::duration<double, std::micro> time =
                std::chrono::steady_clock::now() - begin;
            std::lock_guard<std::mutex> lock(mutex_);
            took.push_back(time.count());
        }
    }
    World world_{testSeed()};
    const unsigned clients_;
    Server gateway_;
    const Ice::CommunicatorHolder ic_{program({{"Ice.Default.InvocationTimeout", "600000"}})};
    std::shared_ptr<RadioTest::EchoPrx> echo_;
    std::mutex mutex_;
};

} // namespace

int main(int argc, char** argv) {
    Figures figures(
        "Load on the ground: 200 programs, 100,000 calls by 8 threads at the engine; 200 "
        "clients at once at the gateway.");
    std::string gateway;
    figures.app.add_option("--gateway", gateway, "the program")->required();
    return figures.run(argc, argv, [&] {
        Programs(figures.brief ? 20 : 200, figures.brief ? 2'000 : 100'000).run(figures);
        const unsigned clients = figures.brief ? 20 : 200;
        Clients(gateway, clients).run(figures, figures.brief ? 3 : 30);
    });
}
