// SPDX-License-Identifier: MIT
//
// ends: the vehicles and ground stations of the soak test, and the messages between them. A
// receiver can check a message by its content.

#pragma once

#include "../support/delivery_check.h"
#include "ice_messages.h"
#include "modem_pair.h"
#include <array>
#include <fmt/format.h>

using Bytes = std::vector<uint8_t>;

constexpr uint64_t msNs = 1'000'000, secondNs = 1000 * msNs;

class Fault : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

struct Totals {
    uint64_t sent = 0, delivered = 0, unknown = 0, received = 0;
    uint64_t reboots = 0, modemResets = 0, absences = 0, twins = 0, keys = 0;
    uint64_t babbles = 0, rivals = 0;
};

// Messages from one end to another. They are numbered and use the four channels in turn, so each
// channel carries every fourth message.
class Mail {
public:
    Mail(int from, int to, Totals& totals) : from_(from), to_(to), totals_(totals) {}
    // Returns the message that must be sent next; it does not change until `sent` is called.
    Bytes next() const { return message(next_); }
    U32 number() const { return next_; }
    int channel() const { return static_cast<int>(next_ % LINK_CHANNELS); }
    void sent() {
        check_.sent(channel(), next_, next());
        ++next_;
        ++totals_.sent;
    }
    void report(uint32_t id, Link_Outcome outcome) {
        throwFault(check_.reported(id, outcome == LINK_DELIVERED));
        ++(outcome == LINK_DELIVERED ? totals_.delivered : totals_.unknown);
    }
    // Discards the messages that are in transit when the power fails, because the program cannot
    // know whether they arrive.
    void forget() {
        for (int channel = 0; channel < LINK_CHANNELS; ++channel)
            totals_.unknown += check_.forget(channel);
    }
    // Checks a message that has arrived. Returns an empty string if the message is correct,
    // otherwise an error text. If two stations share an address, the message may be from either of
    // them; after an error, the caller therefore tries the Mail of the other one.
    std::string arrived(int channel, const Bytes& bytes, bool isRival) {
        const std::string fault = check_.arrived(channel, bytes, isRival);
        totals_.received += fault.empty();
        return fault;
    }
    bool isQuiet() const { return check_.isQuiet(); }

private:
    void throwFault(const std::string& fault) const {
        if (!fault.empty())
            throw Fault(fmt::format("from 0x{:04x} to 0x{:04x}: {}", from_, to_, fault));
    }
    // Returns a message; its bytes depend only on sender, receiver and number.
    Bytes message(uint32_t id) const {
        Random r(uint64_t(from_) << 48 | uint64_t(to_) << 32 | uint64_t(from_ >> 16) << 31 | id);
        uint32_t kind = r.below(10);
        uint32_t size = r.below(40) ? r.below(60) : r.below(LINK_MAX_MESSAGE - 100);
        Bytes body;
        IceMessages::put32(body, id);
        for (uint32_t i = 0; i < size; ++i)
            body.push_back(static_cast<uint8_t>(r.next()));
        std::string object = "object" + std::to_string(r.below(20));
        if (kind < 5)
            return IceMessages::request(kind < 2 ? 0 : id, object, "operation", body);
        if (kind < 8)
            return IceMessages::reply(id, body, kind == 7);
        body.push_back(body[0]);
        body[0] = static_cast<uint8_t>(r.next()); // the first byte can have any value
        return body;
    }

    const int from_, to_;
    Totals& totals_;
    uint32_t next_ = 0; // number of the next message
    DeliveryCheck check_;
};

// A vehicle or a ground station, with its program. It knows the messages of the other ends only to
// check them.
class End : public ModemEnd {
public:
    // returns the messages from one end to another; null if these ends do not communicate
    using MailOf = std::function<Mail*(int from, int to)>;
    End(RfChannel& air, Random& random, int name, bool isGround, const std::vector<int>& targets,
        const MailOf& mailOf)
        : ModemEnd(air, options(name & 0xFFFF), random.next(), targets), random_(random),
          isGround_(isGround), isRival_(name == rival), address_(name & 0xFFFF),
          keys_(targets.size(), 0) {
        for (int target : targets) {
            in_.push_back({mailOf(target, address_), mailOf(target | rival, address_)});
            out_.push_back(mailOf(name, target));
        }
    }
    // number of the rival within this test; its address on the air is 0, like the address of
    // the first ground station
    static constexpr int rival = 0x10000;
    // Restarts the program. `hasKeys` is true if each pair of vehicle and ground station has a key.
    // A key depends only on the pair, and on the number of the pair's key changes.
    void boot(uint64_t now, bool hasKeys) {
        now_ = now;
        begin();
        for (size_t peer = 0; peer < peers(); ++peer) {
            if (out_[peer])
                out_[peer]->forget();
            if (hasKeys)
                setKey(peer, keys_[peer], true);
            if (hasKeys && isGround_ && keys_[peer])
                setKey(peer, keys_[peer] - 1, true);
            Link_start(link(peer), us());
        }
    }
    unsigned keyOf(size_t peer) const { return keys_[peer]; } // number of the current key
    // Takes the next key of this peer. A ground station also keeps the current key. A vehicle
    // discards the current key, so its session ends.
    void takeNextKey(size_t peer) {
        setKey(peer, ++keys_[peer], true);
        if (!isGround_)
            setKey(peer, keys_[peer] - 1, false);
    }
    // Runs one step of the program: sends a message to each peer with the probability `rate`, and
    // now and then becomes busy or stops being busy.
    void work(double rate) {
        for (size_t peer = 0; peer < peers(); ++peer)
            if (out_[peer] && isUp(peer) && random_.chance(rate))
                offer(peer);
        if (random_.chance(0.002))
            isBusy_ = random_.chance(0.1); // a busy program accepts no messages
    }
    bool isWell() const {
        for (size_t peer = 0; peer < peers(); ++peer)
            if (!isUp(peer) || !out_[peer]->isQuiet())
                return false;
        return true;
    }
    void wakeUp() { isBusy_ = false; }
    bool isGone() const { return awayUntil == never; }
    uint64_t awayUntil = 0;

private:
    static XBee::Options options(int address) {
        XBee::Options o = modemOptions(static_cast<unsigned>(address), false, 2, true);
        o.name = fmt::format("0x{:04x}", address);
        o.set["DL"] = 0;
        return o;
    }
    void setKey(size_t peer, unsigned number, bool isGiven) {
        const int vehicle = isGround_ ? target(peer) : address_;
        const int ground = isGround_ ? address_ : target(peer);
        const U8 key[LINK_KEY_BYTES] = {static_cast<U8>(vehicle), static_cast<U8>(ground),
                                        static_cast<U8>(number), static_cast<U8>(!out_[peer])};
        Link_setKey(link(peer), number % 2, isGiven ? key : nullptr,
                    static_cast<U32>(vehicle) | (isGround_ ? LINK_GROUND : 0));
    }
    void offer(size_t peer) {
        Mail& mail = *out_[peer];
        const Bytes m = mail.next();
        const auto status = Link_send(link(peer), mail.channel(), m.data(),
                                      static_cast<U32>(m.size()), mail.number());
        if (status == LINK_CLOSED)
            Link_openChannel(link(peer), mail.channel());
        else if (status == LINK_OK)
            mail.sent();
    }
    void onOutcome(size_t peer, U32 id, Link_Outcome outcome) override {
        out_[peer]->report(id, outcome);
    }
    // Checks a message and accepts it (0), unless the program is busy (1).
    int onMessage(size_t peer, int channel, const U8* data, U32 size) override {
        if (isBusy_)
            return 1;
        std::string faults;
        for (Mail* mail : in_[peer]) {
            if (!mail)
                continue;
            const std::string fault = mail->arrived(channel, Bytes(data, data + size), isRival_);
            if (fault.empty())
                return 0;
            faults += (faults.empty() ? "" : "; from the rival: ") + fault;
        }
        throw Fault(
            fmt::format("{}, from 0x{:04x}: {}", modem.name(), target(peer),
                        faults.empty() ? "it is for another vehicle with this address" : faults));
    }

    Random& random_;
    const bool isGround_, isRival_;
    const int address_;
    // the messages from each peer to this end, and the messages from the peer's rival
    std::vector<std::array<Mail*, 2>> in_;
    std::vector<Mail*> out_;
    std::vector<unsigned> keys_; // number of key changes with each peer
    bool isBusy_ = false;
};
