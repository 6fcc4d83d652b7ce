// SPDX-License-Identifier: MIT
//
// flight: creates and connects the models, starts the ground program, and runs the processor.

#include "flight.h"
#include "board_faults.h"
#include "core_pins.h"
#include "files.h"
#include "map_regs.h"
#include "standstill.h"
#include "uav_machine.h"
#ifdef MAP_SLOT_VISION
#include "vision_regs.h"
#endif

extern "C" {
#include "uav.h"
}

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iostream>
#include <unistd.h>

volatile sig_atomic_t Flight::stopSignal = 0;

namespace {

// interval between two updates of the time that other programs read, ns
constexpr uint64_t clockStepNs = 100'000;
constexpr uint64_t digestNs = 100'000'000;

Frame pictureFor(const Flight::Options& o) {
    int width = 0, height = 0;
    char more = 0;
    if (std::sscanf(o.size.c_str(), "%dx%d%c", &width, &height, &more) != 2 || width < 8 ||
        width > 1024 || width % 8 || height < 8 || height > 4096)
        throw std::runtime_error(
            "size '" + o.size +
            "': expected WIDTHxHEIGHT, 8x8 to 1024x4096, WIDTH a multiple of 8");
    return loadFrame(o.image, width, height);
}

// Creates the folder for the files of the flight and stores the picture there. Returns the path of
// the picture.
std::string prepared(const Flight::Options& o, const Frame& frame) {
    std::filesystem::create_directories(o.out);
    savePng(o.out + "/before.png", frame);
    return o.out;
}

RfWeather weatherOf(const Flight::Options& o) {
    RfWeather weather;
    weather.loss = o.loss;
    weather.interference = o.interference;
    weather.distance = o.distance;
    if (!o.trace.empty())
        weather.trace = std::make_shared<RfTrace>(o.trace);
    return weather;
}

XBee::Options modem(const char* name, const Flight::Options& o) {
    XBee::Options options;
    options.name = name;
    options.profile = o.modem;
    options.set["GT"] = o.guard;
    return options;
}

void loadCamera(SocModel& soc, const Frame& frame) {
    uint8_t* memory = soc.memory().data();
    const uint32_t size[2] = {static_cast<uint32_t>(frame.width),
                              static_cast<uint32_t>(frame.height)};
    std::memcpy(memory + UAV_FRAME_HEADER, size, sizeof size);
    std::memcpy(memory + UAV_FRAME, frame.pixels.data(), frame.pixels.size());
}

// Returns the first line of the recording.
nlohmann::json headOf(const Flight::Options& o) {
    nlohmann::json head = {{"flight", o.flight}, {"clkHz", SocModel::clkHz}};
    head["bridge"] = SOC_BRIDGE;
    for (const std::string& file :
         {o.pins, o.trace, o.flash, o.fpga_flash, o.cpu == "m3" ? o.firmware : ""})
        if (!file.empty())
            head["hashes"][std::filesystem::absolute(file)] = hexHash(readFile(file));
    return head;
}

std::vector<uint8_t> keyBytes(const std::string& digits) {
    std::vector<uint8_t> key;
    for (size_t i = 0; i + 1 < digits.size(); i += 2)
        key.push_back(static_cast<uint8_t>(std::stoul(digits.substr(i, 2), nullptr, 16)));
    return key;
}

// Returns the bytes of a file with the initial contents of a flash; returns nothing if no file is
// given.
std::vector<uint8_t> flashOf(const std::string& file, size_t size, const std::string& owner) {
    const std::string bytes = file.empty() ? "" : readFile(file);
    if (!file.empty() && bytes.size() != size)
        throw std::runtime_error("'" + file + "': expected " + std::to_string(size >> 20) +
                                 " MiB, the size of " + owner + " flash; make it with pack_update");
    return {bytes.begin(), bytes.end()};
}

} // namespace

std::string fileOfSimulator(const std::string& installed, const std::string& built) {
    const auto folder = std::filesystem::read_symlink("/proc/self/exe").parent_path();
    const auto file = folder / ".." / installed;
    return (std::filesystem::exists(file) ? file : folder / built).lexically_normal();
}

std::string defaultFirmware() {
    return fileOfSimulator("lib/icesoc/uav.elf", "../../firmware/uav.elf");
}

Flight::Flight(const Options& options)
    : o_(options), frame_(pictureFor(o_)), key_(keyOf(o_.key, 1)), weather_(weatherOf(o_)),
      air_(o_.seed), ground_(air_, modem("ground", o_), prepared(o_, frame_), "", o_.replayed,
                             headOf(o_), [this] { return isWanted(); }),
      soc_(air_, modem("uav", o_)), events_(o_.out + "/events.jsonl"),
      pace_(o_.speed == "real"                          ? 1
            : o_.speed == "max" || o_.speed == "viewed" ? 0
                                                        : std::stod(o_.speed)) {
    if (!o_.board.empty())
        soc_.wires() = BoardWires::fromFolder(o_.board);
    std::vector<WireFault> faults;
    for (const std::string& fault : o_.fault)
        faults.push_back(WireFault::parse(fault));
    plantFaults(soc_, faults);
    air_.weather = weather_;
    uav_guardMs = o_.guard;
    connectModels();
    if (!o_.pins.empty())
        connectPins(soc_, o_.pins, o_.out + "/pins.log");
    placePicture(soc_, frame_);
    callFollowers();
    if (o_.every_clock)
        soc_.ungate();
    soc_.evaluateAll(o_.every_clock);
    soc_.reset(true);
    watchRegisters();
}

void Flight::connectModels() {
    constexpr double bitNs = 9000; // 111,111 baud
    if (o_.wire) {
        uav_wire = 1;
        cable_ = std::make_unique<Cable>(
            soc_.line(), ground_.line(), bitNs, [this](const SerialLine& from) {
                ++(&from == &soc_.line() ? ground_.status->bytesDown : ground_.status->bytesUp);
            });
        soc_.plugIn(*cable_);
    }
    soc_.onTime([this](uint64_t now) {
        const uint64_t next = ground_.advance(now, o_.wire);
        return std::min({next, second_ ? second_->advance(now) : never,
                         trouble_ ? trouble_->advance(now) : never, now + clockStepNs});
    });
    air_.onPacket([this](uint64_t now, const RfPacket& packet, RfChannel::Outcome outcome) {
        const bool isGrounds = packet.from == 0;
        SimStatus& status = *ground_.status;
        (isGrounds ? status.bytesUp : status.bytesDown) += packet.bytes.size();
        ++status.packets;
        const bool lost = outcome != RfChannel::Outcome::Delivered;
        status.lost += lost;
        events_.packet(now, packet.bytes.size(), isGrounds, lost);
    });
}

void Flight::placePicture(SocModel& soc, const Frame& frame) {
    if (o_.camera)
        connectSensor(soc, frame, [&soc, next = uint64_t(0)]() mutable {
            const bool sends = soc.cycles() >= next;
            next = sends ? soc.cycles() + SocModel::clkHz / 4 : next;
            return sends;
        });
    else
        loadCamera(soc, frame);
}

void Flight::callFollowers() {
    if (o_.vehicles > 1) {
        XBee::Options options = modem("observer", o_);
        options.set["MY"] = Station::second;
        std::shared_ptr<ReplayedLine> replayed;
        if (o_.replayed)
            replayed =
                std::make_shared<ReplayedLine>(o_.flight.value("replay", "") + "/flight2.jsonl");
        second_ = std::make_unique<Station>(air_, options, o_.out, "2", replayed,
                                            nlohmann::json{{"flight", nlohmann::json::object()}},
                                            [this] { return isWanted(); });
    }
    for (unsigned address = 2; address <= o_.vehicles; ++address)
        callFollower(address);
    if (!o_.trouble.empty())
        bringTrouble();
    soc_.onAir([this](uint64_t now) {
        for (const auto& follower : followers_)
            follower->advance(now);
        air_.advance(now);
    });
}

void Flight::callFollower(unsigned address, const std::vector<uint8_t>& otherKey) {
    M3Machine::Config config;
    config.firmware = o_.firmware;
    config.guardMs = o_.guard;
    config.address = address;
    giveKeys(config, o_.vehicles, o_.key, o_.observer);
    if (!otherKey.empty())
        config.key = otherKey;
    config.seed = o_.seed + followers_.size() + 2;
    followers_.push_back(std::make_unique<Follower>(air_, modem("follower", o_), config));
    SocModel& soc = followers_.back()->soc;
    soc.fsmc().onWord = [this, &soc](uint32_t at, uint32_t value, bool isWrite) {
        countStarts(soc, at, value, isWrite);
    };
    const Frame seen = movedBy(frame_, static_cast<int>(address - 1) * frame_.width /
                                           static_cast<int>(o_.vehicles));
    savePng(o_.out + "/before" + std::to_string(address) + ".png", seen);
    placePicture(soc, seen);
}

void Flight::bringTrouble() {
    trouble_ = std::make_unique<Trouble>(o_.trouble);
    const auto address = static_cast<unsigned>(trouble_->address);
    if (address > o_.vehicles)
        throw std::runtime_error("--trouble " + o_.trouble +
                                 ": expected an address of 0 (the ground station) to " +
                                 std::to_string(o_.vehicles) + " (the last vehicle)");
    const XBee* modem = nullptr;
    if (trouble_->kind == "twin") {
        callFollower(address, std::vector<uint8_t>(LINK_KEY_BYTES, 0xEE));
        modem = &followers_.back()->soc.modem();
    } else if (trouble_->kind == "away") {
        modem = !address       ? &ground_.modem
                : address == 1 ? &soc_.modem()
                               : &followers_[address - 2]->soc.modem();
    }
    trouble_->begin(air_, modem);
}

// Counts how often a vehicle's vision core was started; each access that sets START is one start.
void Flight::countStarts(SocModel& soc, uint32_t address, uint32_t value, bool isWrite) {
#ifdef MAP_SLOT_VISION
    constexpr uint32_t control = MAP_CONTROL_WINDOW + 4 * (16 * MAP_SLOT_VISION + VISION_CONTROL);
    starts_[&soc] += isWrite && address == control && (value & VISION_CONTROL_START_MASK);
#else
    (void)soc, (void)address, (void)value, (void)isWrite;
#endif
}

void Flight::watchRegisters() {
    soc_.fsmc().onWord = [this](uint32_t address, uint32_t value, bool isWrite) {
        countStarts(soc_, address, value, isWrite);
        constexpr uint32_t control = MAP_CONTROL_WINDOW, bytes = 4096;
        accesses_.add(soc_.cycles(), address, value, isWrite);
        if (address - control >= bytes)
            return;
        const uint32_t word = (address - control) / 4;
        ground_.status->registers[word] = value;
        ground_.status->seen[word] = isWrite ? 2 : 1;
        events_.access(soc_.now(), word, value, isWrite);
    };
}

void Flight::startProgram() {
    const std::string status = std::filesystem::absolute(o_.out + "/status");
    const std::string clock =
        fileOfSimulator("libexec/icesoc/libsimclock.so", "../status/libsimclock.so");
    setenv("XBEEAT_CLOCK", (clock + ":" + status).c_str(), 1);
    if (!o_.command.empty())
        child_.start(o_.command, {{"{device}", ground_.pty.path()},
                                  {"{device2}", second_ ? second_->pty.path() : ""},
                                  {"{frame}", o_.out + "/before.png"},
                                  {"{status}", o_.out + "/status"},
                                  {"{guard}", std::to_string(o_.guard)},
                                  {"{out}", o_.out}});
}

bool Flight::isWanted() {
    return !stopSignal && (o_.command.empty() || child_.runs());
}

double Flight::millionsPerSecond() const {
    return static_cast<double>(soc_.cycles()) * 1e3 /
           static_cast<double>(pace_.workedNs() - ground_.step.waitedNs());
}

// Prints a warning, once, if the clock of the chip can hardly ever be stopped. The warning names
// the core that prevents this, and the speed of the flight.
void Flight::adviseOnClock() {
    constexpr uint64_t enough = 2'000'000, slow = 2'000'000;
    if (o_.quiet || o_.every_clock || advised_ || soc_.evaluated() < enough ||
        2 * soc_.evaluated() < soc_.cycles() || soc_.mover().empty())
        return;
    advised_ = true;
    fmt::print(
        "icesoc-sim: '{}' changes in nearly every clock, so almost no clock is skipped: {:.2f} "
        "million clocks/s (real time needs {:.1f}). If its clock may stop between calls, give it "
        "idle_o (docs/hw-mapping.md#idle){}\n",
        soc_.mover(), millionsPerSecond(), SocModel::clkHz / 1e6,
        SocModel::clkHz > slow ? "; otherwise make run CLK_HZ=2000000 is faster" : "");
    std::fflush(stdout);
}

// Records a value of the flight's progress, or compares it with the recording in a replay.
void Flight::mark(const char* what, const nlohmann::json& value) {
    if (ground_.recorded)
        ground_.recorded->note(soc_.now(), what, value);
    // a debugger may change the values, so they are compared only without one
    else if (o_.gdb < 0)
        o_.replayed->compare(soc_.now(), what, value);
}

// Updates the recording. Makes the model evaluate every clock during the time for which a waveform
// is recorded.
void Flight::watch() {
    if (soc_.now() >= nextDigest_) {
        nextDigest_ += digestNs;
        mark("digest", accesses_.text());
    }
    const double seconds = static_cast<double>(soc_.now()) / 1e9, pollSeconds = 1e-3;
    const bool looks = seconds >= o_.from - pollSeconds && seconds <= o_.to;
    if (looks != looks_)
        soc_.evaluateAll(looks || o_.every_clock);
    looks_ = looks;
}

// Does the periodic work of the flight, about once per simulated millisecond.
bool Flight::poll() {
    adviseOnClock();
    watch();
    ground_.status->cycles = soc_.cycles();
    ground_.status->wallNs = pace_.workedNs() - ground_.step.waitedNs();
    if (o_.speed == "viewed" && access((o_.out + "/viewed").c_str(), F_OK) == 0)
        pace_.limit(1, soc_.now());
    pace_.keep(soc_.now());
    bool over = o_.duration > 0 && static_cast<double>(soc_.now()) >= o_.duration * 1e9;
    over = over || (o_.replayed && soc_.now() >= o_.replayed->endNs());
    return !over && isWanted();
}

void Flight::runOnHost() {
    UavMachine machine(
        soc_, [this] { return poll(); }, simulatedFirmware(keyBytes(o_.modem_key), !key_.empty()));
    M3Machine::Config config;
    giveKeys(config, o_.vehicles, o_.key, o_.observer);
    machine.board = SimulatedBoard(o_.seed);
    provideKeys(machine.board, config);
    const Standstill watch([this] { return soc_.now(); });
    machine.run();
}

void Flight::runOnCortexM3() {
    M3Machine::Config config;
    config.firmware = o_.firmware;
    config.guardMs = o_.guard;
    config.flash = flashOf(o_.flash, Stm32Flash::bytes, "the chip's");
    config.fpgaFlash = flashOf(o_.fpga_flash, SpiFlash::bytes, "the FPGA's");
    config.seed = o_.seed;
    config.isWired = o_.wire;
    giveKeys(config, o_.vehicles, o_.key, o_.observer);
    M3Machine machine(soc_, config, [this] { return poll(); });
    if (machine.program)
        machine.program->onTask = [this](const std::string& name) {
            events_.task(soc_.now(), name);
        };
    if (o_.gdb >= 0) {
        GdbStub stub(static_cast<uint16_t>(o_.gdb));
        std::cout << "icesoc-sim: waiting for a debugger: gdb-multiarch " << o_.firmware
                  << " -ex 'target remote 127.0.0.1:" << stub.port() << "'" << std::endl;
        machine.debug(stub, o_.replayed != nullptr);
    } else {
        machine.run();
    }
    if (!o_.flash.empty()) {
        machine.stm32().flash().reset(); // restart after a loss of power
        std::ofstream(o_.flash, std::ios::binary)
            .write(reinterpret_cast<const char*>(machine.cpu().flash()), Stm32Flash::bytes);
    }
    if (!o_.fpga_flash.empty())
        std::ofstream(o_.fpga_flash, std::ios::binary)
            .write(reinterpret_cast<const char*>(machine.fpgaFlash().data()), SpiFlash::bytes);
    if (!o_.quiet)
        machine.report();
}

void Flight::report() {
    fmt::print(
        "icesoc-sim: {:.1f} s simulated; speed without waiting times: {:.2f} million clocks/s "
        "(real time: {:.1f}); {:.2f} % of the clocks were idle and skipped; {} packets on the air, "
        "{} lost\n",
        static_cast<double>(soc_.now()) / 1e9, millionsPerSecond(), SocModel::clkHz / 1e6,
        100 - 100 * static_cast<double>(soc_.evaluated()) / static_cast<double>(soc_.cycles()),
        ground_.status->packets, ground_.status->lost);
    if (!followers_.empty()) {
        fmt::print("icesoc-sim: the vision cores were started {}", starts_[&soc_]);
        for (const auto& follower : followers_)
            fmt::print(", {}", starts_[&follower->soc]);
        fmt::print(" times\n");
    }
    if (o_.replayed && o_.gdb < 0 && !stopSignal)
        std::puts(
            o_.replayed->isWhole()
                ? "icesoc-sim: the replay equals the recorded flight bit by bit"
                : "icesoc-sim: the recording ends here, because its simulator was ended here");
}

int Flight::run() {
    if (!o_.quiet)
        std::cout << "icesoc-sim: UAV is up, frame " << frame_.width << " x " << frame_.height
                  << ", "
                  << (o_.replayed ? "the flight is replayed"
                                  : "the ground's modem is " + ground_.pty.path())
                  << std::endl;
    startProgram();
    o_.cpu == "m3" ? runOnCortexM3() : runOnHost();
    child_.stop();
    events_.flush();
    if (!o_.replayed || !stopSignal)
        mark("end", {{"clocks", soc_.cycles()},
                     {"packets", ground_.status->packets},
                     {"lost", ground_.status->lost},
                     {"accesses", accesses_.text()}});
    if (!o_.quiet)
        report();
    return stopSignal ? 128 + stopSignal : child_.status();
}
