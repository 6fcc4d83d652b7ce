// SPDX-License-Identifier: MIT
//
// chip_world: implements the thread of the simulation, in which simulated time passes.

#include "chip_world.h"
#include <condition_variable>
#include <cstdlib>
#include <unistd.h>

extern "C" {
#include "echo_uav.h"
}

XBee::Options ChipWorld::modem(const char* name, std::map<std::string, uint32_t> set) {
    XBee::Options options;
    options.name = name;
    options.set = std::move(set);
    options.set["GT"] = guardMs_;
    return options;
}

ChipWorld::ChipWorld(uint64_t seed, const EchoUav_Port& port, void* context, bool hasKey)
    : seed_(seed), air(seed),
      groundModem(pty_, air, modem("ground", {{"BD", 7}, {"DL", 1}, {"D6", 1}})),
      soc(air, modem("uav", {{"BD", 7}, {"MY", 1}, {"DL", 0}})),
      step_(*clock_, pty_, [this] { return !stop_; }) {
    uav_guardMs = guardMs_;
    if (hasKey) {
        const std::string digits(2 * LINK_KEY_BYTES, '5');
        key_ = std::make_unique<UnnamedFile>();
        if (write(key_->fd(), digits.data(), digits.size()) < 0)
            throw std::runtime_error("no file for a key");
    }
    EchoUav_setPort(&port, context);
    soc.onTime([this](uint64_t now) { return advance(now); });
    thread_ = std::thread([this] { run(); });
}

ChipWorld::~ChipWorld() {
    stop_ = true;
    thread_.join();
}

uint64_t ChipWorld::advance(uint64_t now) {
    constexpr uint64_t clockStepNs = 100'000;
    groundModem.advance(now);
    clock_.set(now);
    std::vector<std::function<void()>> wanted;
    {
        std::lock_guard<std::mutex> lock(mutex_);
        wanted.swap(wanted_);
    }
    for (auto& f : wanted)
        f();
    step_.wait(now);
    waitForRealTime(now);
    return std::min(
        {groundModem.nextEvent(), std::max(step_.nextEvent(), now + 1), now + clockStepNs});
}

void ChipWorld::waitForRealTime(uint64_t now) {
    const std::chrono::nanoseconds simulated(now);
    if (!isRealTime_)
        origin_.reset();
    else if (!origin_)
        origin_ = std::chrono::steady_clock::now() - simulated;
    else
        std::this_thread::sleep_until(*origin_ + simulated);
}

void ChipWorld::run() {
    UavMachine::Firmware firmware;
    firmware.start = EchoUav_start;
    firmware.irqEnabled = [] { return EchoUav_irqEnabled() != 0; };
    try {
        for (uint64_t boots = 0; !stop_; ++boots) {
            reboot_ = false;
            soc.reset();
            UavMachine machine(soc, [this] { return !stop_ && !reboot_; }, firmware);
            machine.board = SimulatedBoard(1000 * seed_ + boots);
            machine.board.provide(std::vector<uint8_t>(key_ ? LINK_KEY_BYTES : 0, 0x55));
            machine.run();
        }
        // A model has reported an error of the chip, so the test cannot continue.
    } catch (const std::exception& e) {
        std::fprintf(stderr, "chip: error: %s\n", e.what());
        std::_Exit(1);
    }
}

void ChipWorld::with(std::function<void()> f) {
    std::mutex mutex;
    std::condition_variable done;
    bool isDone = false;
    {
        std::lock_guard<std::mutex> lock(mutex_);
        wanted_.push_back([&] {
            f();
            std::lock_guard<std::mutex> inner(mutex);
            isDone = true;
            done.notify_one();
        });
    }
    std::unique_lock<std::mutex> lock(mutex);
    done.wait(lock, [&] { return isDone; });
}

void ChipWorld::sleep(double seconds) const {
    for (const uint64_t end = ns() + static_cast<uint64_t>(seconds * 1e9); ns() < end;)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

Ice::CommunicatorPtr ChipWorld::client(std::map<std::string, std::string> more) const {
    Ice::InitializationData data;
    data.properties = Ice::createProperties();
    std::map<std::string, std::string> all = {
        {"Ice.Plugin.XBeeAT", PLUGIN_FOLDER "/xbeeat:createXBeeAT"},
        {"Ice.Default.InvocationTimeout", "120000"},
        {"Ice.RetryIntervals", "-1"}, // a call is made only once, even if it fails
        {"Ice.ThreadPool.Client.Size", "4"},
        {"Ice.Warn.Connections", "0"},
        {"Ice.ACM.Close", "0"},
        {"XBeeAT.Guard", std::to_string(guardMs_)},
        {"XBeeAT.Down", "2"},
        {"Station.Endpoints", endpoint()},
        // one thread, so that the test sees the order of the calls
        {"Station.ThreadPool.Size", "1"}};
    if (key_)
        all["XBeeAT.KeyFile"] = key_->path();
    for (auto& [name, value] : more)
        all[name] = value;
    for (auto& [name, value] : all)
        data.properties->setProperty(name, value);
    return Ice::initialize(data);
}

std::shared_ptr<RadioTest::EchoPrx> ChipWorld::echo(const Ice::CommunicatorPtr& ic,
                                                    const std::string& connection) const {
    return Ice::uncheckedCast<RadioTest::EchoPrx>(
        ic->stringToProxy("echo:" + endpoint())->ice_connectionId(connection));
}
