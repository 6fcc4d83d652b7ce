// SPDX-License-Identifier: MIT
//
// ground: models a ground station in the same process: a modem, a link, and IceP messages written
// by hand. Scripts control it; a script is a function that is called repeatedly until it returns
// true.

#pragma once

#include "ice_messages.h"
#include "link_program.h"
#include "random.h"
#include "soc_model.h"
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

extern "C" {
#include "link.h"
#include "uav.h"
}

using Script = std::function<bool()>;

// Returns a script that runs the given scripts one after another.
inline Script inOrder(std::vector<Script> steps) {
    return [steps = std::move(steps), at = size_t(0)]() mutable {
        while (at < steps.size() && steps[at]())
            ++at;
        return at == steps.size();
    };
}

class Ground : private LinkProgram {
public:
    struct Call {
        std::string object, operation;
        int mode = 0;                         // operation mode: 0 normal, 2 idempotent
        std::vector<uint8_t> parameters = {}; // encoded
    };
    // guard time of the modems in tests, ms; short, because tests would only wait during the
    // default of one second
    static constexpr uint16_t guardMs = 20;
    static XBee::Options uavModem(const std::string& profile = "s1") {
        XBee::Options options;
        options.name = "uav";
        options.profile = profile;
        options.set = {{"GT", guardMs}};
        return options;
    }
    // `address` is the address of the station's modem, `profile` is the kind of modem.
    Ground(RfChannel& air, uint64_t seed, uint32_t address = 0, const std::string& profile = "s1")
        : random_(seed), link_(new Link) {
        XBee::Options options;
        options.name = "ground";
        options.profile = profile;
        options.set = {{"BD", 7}, {"MY", address}, {"DL", 1}};
        modem_ = std::make_unique<XBee>(line_, air, options);
        start();
    }
    // Restarts the ground program: the link begins without earlier state.
    void start() {
        const Link_Config config = {linkPort(), linkProgram(), 1440, LINK_USE(*buffers_)};
        Link_init(link_.get(), &config);
        if (!key.empty())
            Link_setKey(link_.get(), 0, key.data(), LINK_GROUND | 1);
        Link_start(link_.get(), us());
        replies.clear();
        backlog_ = 0;
        running = true;
    }
    // Replaces the modems and the air by a cable to a chip (M3Machine::Config::isWired).
    void plugInto(SocModel& soc) {
        constexpr double bitNs = 9000; // 111,111 baud
        cable_ = std::make_unique<Cable>(soc.line(), line_, bitNs, [](const SerialLine&) {});
        soc.plugIn(*cable_);
    }
    uint64_t advance(uint64_t now) {
        clock_ += (now - now_) * hurry;
        now_ = now;
        if (!cable_)
            modem_->advance(now);
        const bool due = now >= nextPoll_;
        if (due)
            nextPoll_ = now + 1'000'000;
        if (due && running) {
            if (!line_.received.empty())
                Link_receive(link_.get(), line_.received.data(),
                             static_cast<U32>(line_.received.size()), us());
            line_.received.clear();
            Link_poll(link_.get(), us());
            if (isUp() && !isOpen_)
                isOpen_ = Link_openChannel(link_.get(), 0) == LINK_OK;
        }
        return std::min(cable_ ? cable_->nextEvent() : modem_->nextEvent(), nextPoll_);
    }
    bool isUp() const { return Link_state(link_.get()) == LINK_STATE_UP; }
    // Returns a request for an operation of an object; `parameters` are already encoded. `mode` is
    // 0 (normal) or 2 (idempotent); with id 0, the request is one-way.
    static std::vector<uint8_t> request(int id, const std::string& object,
                                        const std::string& operation, int mode = 0,
                                        const std::vector<uint8_t>& parameters = {}) {
        return IceMessages::request(static_cast<uint32_t>(id),
                                    IceMessages::requestBody(object, operation, 1, parameters, "",
                                                             static_cast<uint8_t>(mode)));
    }
    void call(int id, const std::string& object, const std::string& operation, int mode = 0,
              const std::vector<uint8_t>& parameters = {}) {
        const auto m = request(id, object, operation, mode, parameters);
        const U32 size = static_cast<U32>(m.size());
        if (Link_send(link_.get(), 0, m.data(), size, size) == LINK_OK)
            backlog_ += size;
    }
    void ping(int id, const std::string& object) { call(id, object, "ice_ping", 2); }
    // Returns a script that makes calls; each call begins after the reply to the previous call.
    // Request ids start at 1.
    Script calling(std::vector<Call> calls) {
        return [this, calls = std::move(calls), sent = size_t(0)]() mutable {
            if (validated && replies.size() == sent && sent < calls.size()) {
                const Call& c = calls[sent++];
                call(static_cast<int>(sent), c.object, c.operation, c.mode, c.parameters);
            }
            return replies.size() == calls.size();
        };
    }
    Script pinging(size_t count, const std::string& object = "hwengine1") {
        return calling(std::vector<Call>(count, {object, "ice_ping", 2}));
    }
    void noise(const std::vector<uint8_t>& bytes) { line_.send(bytes, now_); }

    std::map<int, int> replies;                   // status of each reply; the key is the request id
    std::map<int, std::vector<uint8_t>> messages; // bytes of each reply; the key is the request id
    // number of messages that were delivered, and of messages with unknown delivery
    int delivered = 0, unknown = 0;
    uint64_t deliveredBytes = 0; // number of bytes in acknowledged messages
    // Returns the number of bytes in undelivered messages.
    size_t backlog() const { return backlog_; }
    // key of the link; takes effect at the next start(). If it is empty, the link is not encrypted.
    std::vector<uint8_t> key;
    const Link_Statistics& statistics() const { return *Link_statistics(link_.get()); }
    bool validated = false, running = true;
    // factor by which the link clock is faster than simulated time (UavMachine::hurry)
    unsigned hurry = 1;

private:
    U32 us() const { return static_cast<U32>(clock_ / 1000); }
    bool transmit(const U8* frame, U32 size) override {
        line_.send({frame, frame + size}, now_);
        return true;
    }
    U32 random() override { return random_.next(); }
    bool take(int, const U8* data, U32 size) override {
        if (size >= 14 && data[8] == 3)
            validated = true;
        if (size >= 19 && data[8] == 2) {
            replies[data[14] | data[15] << 8] = data[18];
            messages[data[14] | data[15] << 8].assign(data, data + size);
        }
        return true;
    }
    void onOutcome(int, U32 size, Link_Outcome what) override {
        backlog_ -= size;
        if (what == LINK_DELIVERED)
            deliveredBytes += size;
        ++(what == LINK_DELIVERED ? delivered : unknown);
    }
    void onState(Link_State) override { validated = isOpen_ = false; }

    Random random_;
    HostLine line_;
    std::unique_ptr<XBee> modem_;
    std::unique_ptr<Cable> cable_;
    std::unique_ptr<Link> link_;
    std::unique_ptr<Link_Buffers> buffers_{new Link_Buffers};
    uint64_t now_ = 0, clock_ = 0, nextPoll_ = 0;
    size_t backlog_ = 0;
    bool isOpen_ = false; // true if the channel for the station's calls is open
};

// A vehicle's chip, a ground station, and the air between them.
struct GroundAndChip {
    explicit GroundAndChip(uint64_t seed = testSeed(), const std::string& modem = "s1")
        : air(seed), ground(air, seed + 5, 0, modem), soc(air, Ground::uavModem(modem)) {
        uav_guardMs = Ground::guardMs; // variable of the firmware that is built for the host
        soc.onTime([this](uint64_t now) { return ground.advance(now); });
    }
    bool within(double seconds) const { return static_cast<double>(soc.now()) < seconds * 1e9; }
    // Gives the vehicle a picture; `pixel` computes its pixels. If `pixel` is empty, sets only the
    // size of the picture.
    void provide(uint32_t width, uint32_t height, const std::function<uint8_t(uint32_t)>& pixel) {
        const uint32_t size[2] = {width, height};
        std::memcpy(soc.memory().data() + UAV_FRAME_HEADER, size, sizeof size);
        for (uint32_t i = 0; pixel && i < width * height; ++i)
            soc.memory().data()[UAV_FRAME + i] = pixel(i);
    }

    RfChannel air;
    Ground ground;
    SocModel soc;
};
