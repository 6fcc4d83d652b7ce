// SPDX-License-Identifier: MIT
//
// icesoc-sim: the simulated UAV with its modem, the air, and the ground's modem on a pty; and, as
// its child, the program that uses that pty.

#include "app.h"
#include "camera.h"
#include "ground_step.h"
#include "m3_machine.h"
#include "mark_file.h"
#include "sensor.h"
#include "soc_model.h"
#include "status.h"
#include "uav_machine.h"

extern "C" {
#include "uav.h"
}

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <iostream>
#include <optional>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace {

using Clock = std::chrono::steady_clock;

volatile sig_atomic_t stopSignal = 0;
constexpr uint64_t clockStepNs = 100'000; // of the time that other programs read

struct Options {
    std::string key; // 32 hexadecimal digits
    std::string image, size = "320x240", out = ".", speed = "real", cpu = "host",
                       firmware = FIRMWARE_ELF;
    uint32_t hclk = 120'000'000;
    uint16_t guard = 1000;
    int gdb = -1;
    std::string marks;
    double loss = 0, duration = 0;
    uint64_t seed = 1;
    bool quiet = false, sensor = false;
    std::vector<std::string> command;
};

// Shared memory that the ground station reads (status.h).
class StatusFile {
public:
    explicit StatusFile(const std::string& path) {
        int fd = open(path.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
        if (fd < 0 || ftruncate(fd, sizeof(SimStatus)) != 0)
            throw std::system_error(errno, std::generic_category(), "cannot write '" + path + "'");
        void* at = mmap(nullptr, sizeof(SimStatus), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
        close(fd);
        if (at == MAP_FAILED)
            throw std::system_error(errno, std::generic_category(), "cannot map '" + path + "'");
        status_ = static_cast<SimStatus*>(at);
        std::memcpy(status_->magic, "ICESOC1", 8);
    }
    ~StatusFile() { munmap(status_, sizeof(SimStatus)); }
    StatusFile(const StatusFile&) = delete;
    StatusFile& operator=(const StatusFile&) = delete;
    SimStatus* operator->() { return status_; }
    SimStatus& operator*() { return *status_; }

private:
    SimStatus* status_;
};

void loadCamera(SocModel& soc, const Frame& frame) {
    uint8_t* memory = soc.memory().data();
    const uint32_t size[2] = {static_cast<uint32_t>(frame.width),
                              static_cast<uint32_t>(frame.height)};
    std::memcpy(memory + UAV_FRAME_HEADER, size, sizeof size);
    std::memcpy(memory + UAV_FRAME, frame.pixels.data(), frame.pixels.size());
}

std::vector<uint8_t> keyBytes(const std::string& digits) {
    std::vector<uint8_t> key;
    for (size_t i = 0; i + 1 < digits.size(); i += 2)
        key.push_back(static_cast<uint8_t>(std::stoul(digits.substr(i, 2), nullptr, 16)));
    return key;
}

class Child {
public:
    void start(std::vector<std::string> command, const std::map<std::string, std::string>& places) {
        for (std::string& word : command)
            for (auto& [name, value] : places)
                for (size_t at; (at = word.find(name)) != std::string::npos;)
                    word.replace(at, name.size(), value);
        std::vector<char*> argv;
        for (std::string& word : command)
            argv.push_back(word.data());
        argv.push_back(nullptr);
        pid_ = fork();
        if (pid_ == 0) {
            execvp(argv[0], argv.data());
            std::fprintf(stderr, "icesoc-sim: cannot start '%s': %s\n", argv[0],
                         std::strerror(errno));
            _exit(127);
        }
    }
    // True while it runs; afterwards status() is its exit status.
    bool runs() {
        int status;
        if (pid_ > 0 && waitpid(pid_, &status, WNOHANG) == pid_) {
            pid_ = 0;
            status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
        }
        return pid_ > 0;
    }
    // Asks it to end, and waits until it has.
    void stop() {
        if (!runs())
            return;
        kill(pid_, SIGINT);
        for (int i = 0; i < 300 && runs(); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        if (runs()) {
            kill(pid_, SIGKILL);
            while (runs())
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    }
    int status() const { return status_; }

private:
    pid_t pid_ = 0;
    int status_ = 0;
};

// Keeps simulated time from running ahead of the wall clock, and counts the time it really worked.
class Pace {
public:
    // `rate`: simulated seconds in one of the wall clock; 0: as many as there may be.
    explicit Pace(double rate) : rate_(rate), anchor_(Clock::now()), begin_(anchor_) {}
    void keep(uint64_t simulatedNs) {
        if (rate_ == 0)
            return;
        auto due = anchor_ + std::chrono::nanoseconds(static_cast<int64_t>(
                                 static_cast<double>(simulatedNs - anchorNs_) / rate_));
        auto now = Clock::now();
        if (due > now) {
            std::this_thread::sleep_until(due);
            slept_ += Clock::now() - now;
        } else if (now - due > std::chrono::milliseconds(50)) {
            anchor_ = now; // too slow for a while: go on from here, without hurry
            anchorNs_ = simulatedNs;
        }
    }
    uint64_t workedNs() const {
        return static_cast<uint64_t>((Clock::now() - begin_ - slept_).count());
    }

private:
    double rate_;
    Clock::time_point anchor_, begin_;
    uint64_t anchorNs_ = 0;
    Clock::duration slept_{};
};

// What the processor did, and what stopped it, if anything did.
void report(M3Machine& machine) {
    CortexM3& cpu = machine.cpu();
    const Stm32F2::Resets& resets = machine.stm32().resets();
    double cycles = static_cast<double>(cpu.cycles());
    std::printf("icesoc-sim: Cortex-M3: %llu instructions; asleep %.1f %% of the time, %.2f %% in "
                "bus accesses; "
                "resets: %u software, %u watchdog\n",
                static_cast<unsigned long long>(cpu.instructions()),
                100 * static_cast<double>(cpu.sleepingCycles()) / cycles,
                100 * static_cast<double>(cpu.busCycles()) / cycles, resets.software,
                resets.watchdog);
    if (!cpu.lastFault.empty())
        std::printf("icesoc-sim: last fault: %s in %s\n", cpu.lastFault.c_str(),
                    machine.stm32().image()->functionAt(cpu.reg(CortexM3::Pc)).c_str());
}

int simulate(const Options& o) {
    int width = 0, height = 0;
    if (std::sscanf(o.size.c_str(), "%dx%d", &width, &height) != 2 || width < 8 || width > 1024 ||
        height < 8 || height > 4096)
        throw std::runtime_error("size '" + o.size + "': give WIDTHxHEIGHT, 8x8 to 1024x4096");
    Frame frame = loadFrame(o.image, width, height);
    mkdir(o.out.c_str(), 0755);
    savePng(o.out + "/before.png", frame);
    StatusFile status(o.out + "/status");

    RfChannel air(o.seed);
    air.weather.loss = o.loss;
    XBee::Options uavModem, groundModem;
    uavModem.name = "uav";
    groundModem.name = "ground";
    uavModem.set["GT"] = groundModem.set["GT"] = o.guard;
    uav_guardMs = o.guard;
    PtyLine pty;
    XBee ground(pty, air, groundModem);
    SocModel soc(air, uavModem);
    Child child;
    auto isWanted = [&] { return !stopSignal && (o.command.empty() || child.runs()); };
    GroundStep step(*status, pty, isWanted);
    soc.onTime([&](uint64_t now) {
        ground.advance(now);
        __atomic_store_n(&status->ns, now, __ATOMIC_RELAXED); // the ground's clock
        step.wait(now);
        return std::min({ground.nextEvent(), std::max(step.nextEvent(), now + 1), now + clockStepNs});
    });
    air.onPacket([&](uint64_t, const RfPacket& packet, RfChannel::Outcome outcome) {
        (packet.from == 1 ? status->bytesDown : status->bytesUp) += packet.bytes.size();
        ++status->packets;
        status->lost += outcome != RfChannel::Outcome::Delivered;
    });
    if (o.sensor)
        connectSensor(soc, frame);
    else
        loadCamera(soc, frame);
    const uint32_t boots =
        static_cast<uint32_t>(o.seed * 1000 + static_cast<uint64_t>(getpid()) * 77);
    std::memcpy(soc.memory().data() + UAV_BOOTS, &boots, sizeof boots);
    soc.reset();
    soc.fsmc().onWord = [&](uint32_t address, uint32_t value, bool isWrite) {
        constexpr uint32_t control = 0x64000000, bytes = 4096; // NE2
        if (address - control >= bytes)
            return;
        status->registers[(address - control) / 4] = value;
        status->seen[(address - control) / 4] = isWrite ? 2 : 1;
    };

    if (!o.quiet)
        std::cout << "icesoc-sim: UAV is up, frame " << frame.width << " x " << frame.height
                  << ", the ground's modem is " << pty.path() << std::endl;
    setenv("XBEEAT_CLOCK", std::filesystem::absolute(o.out + "/status").c_str(),
           1); // sw/ground/clock.h
    if (!o.command.empty())
        child.start(o.command, {{"{device}", pty.path()},
                                {"{frame}", o.out + "/before.png"},
                                {"{status}", o.out + "/status"},
                                {"{guard}", std::to_string(o.guard)},
                                {"{out}", o.out}});
    Pace pace(o.speed == "real" ? 1 : o.speed == "max" ? 0 : std::stod(o.speed));
    auto poll = [&] {
        status->cycles = soc.cycles();
        status->wallNs = pace.workedNs() - step.waitedNs();
        pace.keep(soc.now());
        bool over = o.duration > 0 && static_cast<double>(soc.now()) >= o.duration * 1e9;
        return !over && isWanted();
    };
    if (o.cpu == "m3") {
        M3Machine machine(soc, {o.firmware, o.hclk, o.guard}, poll);
        std::optional<MarkFile> marks;
        if (!o.marks.empty())
            marks.emplace(o.marks, machine.stm32(), [&] { return soc.now(); });
        if (o.gdb >= 0) {
            GdbStub stub(static_cast<uint16_t>(o.gdb));
            std::cout << "icesoc-sim: waiting for a debugger: gdb-multiarch " << o.firmware
                      << " -ex 'target remote localhost:" << stub.port() << "'" << std::endl;
            machine.debug(stub);
        } else {
            machine.run();
        }
        if (!o.quiet)
            report(machine);
    } else {
        UavMachine(soc, poll, simulatedFirmware(keyBytes(o.key))).run();
    }
    child.stop();
    double worked = static_cast<double>(pace.workedNs() - step.waitedNs()) / 1e9;
    if (!o.quiet)
        std::printf("icesoc-sim: %.1f s simulated, %.2f million clocks/s while it worked (real "
                    "time is %.1f), "
                    "%llu packets on the air, %llu lost\n",
                    static_cast<double>(soc.now()) / 1e9,
                    static_cast<double>(soc.cycles()) / worked / 1e6, SocModel::clkHz / 1e6,
                    static_cast<unsigned long long>(status->packets),
                    static_cast<unsigned long long>(status->lost));
    return stopSignal ? 128 + stopSignal : child.status();
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app{
        "Simulates the UAV: RTL, DDR3, firmware, modems, radio. The ground's modem is a pty.\n"
        "Words of COMMAND: {device} the pty, {frame} the camera's picture, {status} counters, "
        "{guard}, {out}."};
    Options o;
    app.add_option("--image", o.image, "picture for the camera: PNG, JPEG or PGM")->required();
    app.add_flag("--sensor", o.sensor,
                 "the picture comes through the camera core's pins, not into memory");
    app.add_option("--size", o.size, "of the camera's frame, WIDTHxHEIGHT");
    app.add_option("--loss", o.loss, "loss on the air, each way")->check(CLI::Range(0.0, 1.0));
    app.add_option("--seed", o.seed, "of the radio's misfortunes");
    app.add_option("--key", o.key,
                   "the UAV's modem encrypts with this AES key, 32 hexadecimal digits")
        ->check([](const std::string& text) {
            bool good = text.size() == 32 &&
                        text.find_first_not_of("0123456789abcdefABCDEF") == std::string::npos;
            return good ? std::string() : std::string("give 32 hexadecimal digits");
        });
    app.add_option("--guard", o.guard,
                   "guard time of both modems, ms; a ground station must know it: {guard}")
        ->check(CLI::Range(2, 3300));
    app.add_option("--out", o.out, "folder for before.png and the counters");
    app.add_option("--speed", o.speed,
                   "real: simulated time follows the clock; 0.25: at a quarter of its speed; max: "
                   "as fast as it goes")
        ->check(CLI::IsMember({"real", "max"}) | CLI::Range(0.01, 100.0));
    app.add_option("--duration", o.duration, "end after so many simulated seconds");
    app.add_option("--cpu", o.cpu,
                   "host: the firmware's host build; m3: its ARM binary on a Cortex-M3 model")
        ->check(CLI::IsMember({"host", "m3"}));
    app.add_option("--firmware", o.firmware, "ELF file for --cpu m3");
    app.add_option("--hclk", o.hclk,
                   "of the Cortex-M3, Hz in simulated time; 0: 6/5 of the fabric's clock");
    app.add_option("--gdb", o.gdb, "wait for GDB on this port of the loopback interface; 0: any")
        ->check(CLI::Range(0, 65535));
    app.add_option("--marks", o.marks, "write exceptions and tasks to this waveform file (VCD)");
    app.add_flag("--quiet", o.quiet, "say nothing");
    app.add_option("command", o.command, "program to run against the modem, behind --");
    app.positionals_at_end();
    CLI11_PARSE(app, argc, argv);
    struct sigaction action {};
    action.sa_handler = [](int signal) { stopSignal = signal; };
    for (int signal : {SIGINT, SIGTERM, SIGHUP})
        sigaction(signal, &action, nullptr);
    if (o.cpu == "m3" && !o.key.empty()) {
        std::cerr << "icesoc-sim: --key needs --cpu host: the ARM binary has its own\n";
        return 2;
    }
    if (o.cpu != "m3" && (o.gdb >= 0 || !o.marks.empty())) {
        std::cerr << "icesoc-sim: --gdb and --marks need --cpu m3\n";
        return 2;
    }
    try {
        return simulate(o);
    } catch (const std::exception& e) {
        std::cerr << "icesoc-sim: error: " << e.what() << "\n";
        return 1;
    }
}
