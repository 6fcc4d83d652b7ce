// SPDX-License-Identifier: MIT
//
// load: many programs at the ground's engine, one after the other on its three channels, and many
// clients at once at the gateway: no call is lost, doubled or answered wrongly, and memory does not
// grow.

#include "../sw/ground/wire.h"
#include "figures.h"
#include <arpa/inet.h>
#include <atomic>
#include <csignal>
#include <fstream>
#include <sys/wait.h>
#include <thread>

namespace {

constexpr size_t callBytes = 40;
constexpr int patienceMs = 600'000; // a client waits for its channel

double residentKiB(const std::string& process) {
    size_t pages = 0, resident = 0;
    std::ifstream("/proc/" + process + "/statm") >> pages >> resident;
    return static_cast<double>(resident) * 4;
}

// The programs' calls, each with its own number.
class Load {
public:
    Load(unsigned programs, unsigned calls)
        : programs_(programs), calls_(calls), latencies_(calls) {}

protected:
    // Runs the programs in this many threads, and watches the memory of a process.
    void run(Figures& figures, unsigned threads, const std::string& process,
             const std::string& where) {
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
            3600);
        for (auto& worker : workers)
            worker.join();
        const double grown = residentKiB(process) - before;
        unsigned arrived = 0;
        for (unsigned count : wire_.received)
            arrived += count;
        std::sort(latencies_.begin(), latencies_.end());
        figures.add(where + "calls answered rightly", answered_, "calls", calls_);
        figures.add(where + "latency, median", at(0.50), "us");
        figures.add(where + "latency, 99 of 100", at(0.99), "us");
        figures.add(where + "memory grown since the first tenth", grown, "KiB");
        if (answered_ != calls_ || arrived != calls_)
            figures.miss(where + std::to_string(calls_) + " calls, " + std::to_string(arrived) +
                         " arrived, " + std::to_string(answered_) + " answered rightly");
        if (grown > 2048)
            figures.miss(where + "memory has grown by " + std::to_string(grown) + " KiB");
    }

    virtual int connect() = 0; // connects a program; -1: there is no room
    Wire wire_;

private:
    // Runs one program after the other, until all have been served.
    void work() {
        for (unsigned program; (program = next_++) < programs_;) {
            int fd;
            while ((fd = connect()) < 0)
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
        const bool isRight = readAll(fd, callBytes, patienceMs) == wanted;
        const std::chrono::duration<float, std::micro> took =
            std::chrono::steady_clock::now() - begin;
        answered_ += isRight;
        latencies_[number] = took.count();
    }
    double at(double share) const {
        return latencies_[static_cast<size_t>(share * static_cast<double>(latencies_.size() - 1))];
    }

    const unsigned programs_, calls_;
    std::vector<float> latencies_; // fixed length, since memory is measured
    std::atomic<unsigned> next_{0}, answered_{0}, ended_{0};
};

// Programs with the engine in their own process, eight at a time.
class Programs : Load {
public:
    using Load::Load;
    void run(Figures& figures) { Load::run(figures, 8, "self", "engine: "); }

private:
    int connect() override { return engine_->connect(-1); }
    std::shared_ptr<XBeeAT::Engine> engine_ = wire_.engine();
};

// Clients that come all at once to the gateway, which is a separate process.
class Clients : Load {
public:
    using Load::Load;
    void run(Figures& figures, const std::string& gateway, unsigned clients) {
        start(gateway);
        Load::run(figures, clients, std::to_string(process_), "gateway: ");
        kill(process_, SIGTERM);
        waitpid(process_, nullptr, 0);
    }

private:
    void start(const std::string& gateway) {
        int ends[2];
        if (pipe(ends) != 0 || (process_ = fork()) < 0)
            throw std::runtime_error("no pipe or no process");
        if (process_ == 0) {
            dup2(ends[1], 1);
            execl(gateway.c_str(), gateway.c_str(), "-d", wire_.path().c_str(), "--no-setup", "-l",
                  "127.0.0.1:0", "--wait", "3600", static_cast<char*>(nullptr));
            _exit(127);
        }
        close(ends[1]);
        FILE* said = fdopen(ends[0], "r");
        if (std::fscanf(said, "gateway: port %hu", &port_) != 1)
            throw std::runtime_error(gateway + " does not say its port");
        std::fclose(said);
    }
    int connect() override {
        const int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
        sockaddr_in to{};
        to.sin_family = AF_INET;
        to.sin_port = htons(port_);
        to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        if (::connect(fd, reinterpret_cast<sockaddr*>(&to), sizeof to) == 0)
            return fd;
        close(fd);
        return -1;
    }
    pid_t process_ = 0;
    unsigned short port_ = 0;
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
        Clients(clients, clients * (figures.brief ? 3 : 30)).run(figures, gateway, clients);
    });
}
