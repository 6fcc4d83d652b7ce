// SPDX-License-Identifier: MIT
//
// xbee: models the data path of the modem's firmware as the manual describes it: serial bytes,
// buffers, packets.

#include "xbee.h"
#include "xbee_crypt.h"
#include <algorithm>
#include <cstddef>

namespace {

constexpr size_t outputBytes = 202;
// payload of a packet in the legacy mode (C8), bytes
constexpr size_t legacyBytes = 100, legacyBytesEncrypted = 95;
constexpr uint64_t msNs = 1'000'000, resetNs = 200;
// Time that the modem's processor needs for each packet: before carrier sense for a packet that it
// sends, and after the end of a packet that it receives. Together with the air time, this
// results in the rates that the manufacturer measured for full packets: 80 kb/s, and 47 kb/s with
// encryption. It is an assumption that short packets and the receiver need the same time
// (docs/simulation.md).
constexpr uint64_t processingNs = 4'688'000, processingEncryptedNs = 10'666'000;
// time within which the three characters of the command sequence must arrive, ns
constexpr uint64_t plusWindowNs = 1000 * msNs;

} // namespace

XBee::Parameters XBee::factory() const {
    Parameters values;
    for (auto& [letters, parameter] : table_)
        values[letters] = parameter.factory;
    return values;
}

XBee::XBee(SerialLine& line, RfChannel& channel, Options options)
    : line_(line), channel_(channel), options_(std::move(options)),
      profile_(xbeeProfile(options_.profile)), table_(xbeeParameters(profile_)),
      written_(factory()), mac_(channel, *this) {
    for (auto& [letters, value] : options_.set)
        written_.at(letters) = value;
    writtenKey_ = options_.key;
    active_ = pending_ = written_;
    line_.attach(this);
    channel_.join(this);
    boot(0);
    line_.setBitTime(1e9 / baud());
    bootDone_ = 0; // a new modem has already booted
}

XBee::~XBee() {
    channel_.leave(this);
}

double XBee::baud() const {
    return xbeeBaud(profile_, active_.at("BD"));
}
uint64_t XBee::serial() const {
    return uint64_t(active_.at("SH")) << 32 | active_.at("SL");
}
uint64_t XBee::charNs() const {
    return static_cast<uint64_t>(10e9 / baud());
}
uint64_t XBee::guardNs() const {
    return active_.at("GT") * msNs;
}

void XBee::boot(uint64_t now) {
    active_ = pending_ = written_;
    key_ = writtenKey_;
    mode_ = Mode::Boot;
    bootDone_ = now + options_.bootNs;
    lastByte_ = now;
    pluses_ = 0;
    flushCount_ = 0;
    input_.clear();
    output_.clear();
    commandLine_.clear();
    apiQueue_.clear();
    inFrame_ = false;
    stopSending();
    busyUntil_ = 0;
    line_.setHeedRts(active_.at("D6") == 1);
    cts_ = true;
    line_.setCts(true);
}

void XBee::resetPin(bool low, uint64_t now) {
    if (low == resetLow_)
        return;
    resetLow_ = low;
    if (low)
        resetLowSince_ = now;
    else if (now - resetLowSince_ >= resetNs && mode_ != Mode::Off)
        boot(now);
}

void XBee::power(bool on, uint64_t now) {
    if (!on) {
        mode_ = Mode::Off;
        input_.clear();
        output_.clear();
        apiQueue_.clear();
        stopSending();
    } else if (mode_ == Mode::Off) {
        boot(now);
    }
}

void XBee::stopSending() {
    mac_.abort();
    inFlight_ = false;
    apiId_ = 0;
}

void XBee::store(uint8_t byte) {
    if (input_.size() >= profile_.inputBytes)
        ++counters_.overflow;
    else
        input_.push_back(byte);
    updateCts();
}

void XBee::updateCts() {
    size_t held = input_.size();
    for (auto& queued : apiQueue_)
        held += queued.packet.bytes.size();
    const uint32_t ctsOff = profile_.hasLegacyMode ? active_.at("FT") : profile_.threshold;
    const uint32_t ctsOn = ctsOff - profile_.release;
    bool cts = cts_ ? held < ctsOff : held <= ctsOn;
    if (active_.at("D7") != 1)
        cts = true;
    if (cts != cts_) {
        cts_ = cts;
        line_.setCts(cts);
    }
}

void XBee::fromHost(uint8_t byte, uint64_t now) {
    if (mode_ == Mode::Off || mode_ == Mode::Boot)
        return;
    ++counters_.bytesFromHost;
    if (mode_ == Mode::Command)
        commandByte(byte, now);
    else if (active_.at("AP"))
        apiByte(byte, now);
    else
        dataByte(byte, now);
    lastByte_ = now;
}

void XBee::framingError(uint64_t now) {
    ++counters_.framingErrors;
    lastByte_ = now;
}

void XBee::dataByte(uint8_t byte, uint64_t now) {
    bool silentBefore = now - lastByte_ >= guardNs();
    if (byte == active_.at("CC") &&
        ((pluses_ == 0 && silentBefore) ||
         (pluses_ > 0 && pluses_ < 3 && now - firstPlus_ < plusWindowNs))) {
        if (pluses_++ == 0)
            firstPlus_ = now;
        return;
    }
    for (; pluses_; --pluses_)
        // the characters that were held back are data instead of the command sequence
        store(static_cast<uint8_t>(active_.at("CC")));
    store(byte);
    sendPackets(now);
}

// At the end of the guard time, decides whether the characters that were held back are the command
// sequence or data.
void XBee::silence(uint64_t now) {
    if (pluses_ && now - lastByte_ >= guardNs()) {
        if (pluses_ == 3)
            enterCommandMode(now);
        else
            for (unsigned i = 0; i < pluses_; ++i)
                store(static_cast<uint8_t>(active_.at("CC")));
        pluses_ = 0;
        sendPackets(now);
    }
    if (mode_ == Mode::Data && flushCount_ < input_.size() &&
        now - lastByte_ >= active_.at("RO") * charNs()) {
        flushCount_ = input_.size();
        sendPackets(now);
    }
}

RfPacket XBee::addressed() const {
    RfPacket packet;
    uint32_t mm = active_.at("MM"), dh = active_.at("DH"), dl = active_.at("DL");
    packet.from = static_cast<uint16_t>(active_.at("MY"));
    packet.wide = dh != 0 || dl > 0xFFFF;
    packet.to = static_cast<uint16_t>(dl);
    packet.to64 = uint64_t(dh) << 32 | dl;
    packet.pan = static_cast<uint16_t>(active_.at("ID"));
    packet.channel = static_cast<uint8_t>(active_.at("CH"));
    packet.header = mm == 0 || mm == 3;
    packet.tries = mm == 0 || mm == 2 ? 4 : 1;
    packet.acknowledged = (mm == 0 || mm == 2) && !packet.isBroadcast();
    packet.sequenced = packet.header && active_.at("RR") > 0;
    packet.from64 = packet.from >= 0xFFFE;
    packet.backoff = active_.at("RN");
    setRounds(packet);
    return packet;
}

void XBee::setRounds(RfPacket& packet) const {
    unsigned rr = packet.header ? active_.at("RR") : 0;
    packet.rounds = packet.acknowledged ? rr : 0;
    packet.copies = packet.isBroadcast() && rr ? rr + 2 : 1;
}

// Returns the largest payload of a packet, bytes.
size_t XBee::packetBytes() const {
    const bool encrypts = active_.at("EE");
    if (profile_.hasLegacyMode && active_.at("C8") & 1)
        return encrypts ? legacyBytesEncrypted : legacyBytes;
    return encrypts ? profile_.encryptedBytes : profile_.packetBytes;
}

void XBee::sendPackets(uint64_t now) {
    if (inFlight_ || mode_ == Mode::Off)
        return;
    if (!apiQueue_.empty())
        return sendApiPacket(now);
    const size_t most = packetBytes();
    size_t count = 0;
    if (input_.size() >= most)
        count = most;
    else if (active_.at("RO") == 0)
        count = input_.size();
    else if (flushCount_)
        count = std::min(flushCount_, input_.size());
    if (count == 0)
        return;
    RfPacket packet = addressed();
    packet.bytes.assign(input_.begin(), input_.begin() + static_cast<std::ptrdiff_t>(count));
    input_.erase(input_.begin(), input_.begin() + static_cast<std::ptrdiff_t>(count));
    flushCount_ -= std::min(flushCount_, count);
    updateCts();
    launch(std::move(packet), now);
}

void XBee::launch(RfPacket packet, uint64_t now) {
    packet.sequence = ++sequence_;
    packet.serial = serial();
    packet.encrypted = active_.at("EE") != 0;
    if (packet.encrypted)
        packet.bytes = XBeeCrypt::encrypt(key_, packet.serial, ++frameCounter_, packet.bytes);
    inFlight_ = true;
    ++counters_.packetsSent;
    work(now, packet.encrypted);
    mac_.send(std::move(packet), now);
}

// Occupies the modem's processor for the time of one packet. The processor handles one packet at a
// time, sent or received.
void XBee::work(uint64_t now, bool encrypted) {
    uint64_t needed = encrypted ? processingEncryptedNs : processingNs;
    busyUntil_ = std::max(busyUntil_, now) + channel_.jittered(needed);
}

void XBee::transmitted(uint64_t now, Mac::Fate fate) {
    inFlight_ = false;
    auto count = [this](const char* letters) {
        active_[letters] = pending_[letters] = std::min(active_[letters] + 1, 0xFFFFu);
    };
    if (fate == Mac::Fate::NoAck)
        count("EA");
    else if (fate == Mac::Fate::NoClearChannel)
        count("EC");
    if (apiId_) {
        auto status = static_cast<uint8_t>(fate);
        if (fate == Mac::Fate::NoAck && active_.at("RR"))
            status = 0x21; // status: no acknowledgement in any round
        apiReply({0x89, apiId_, status});
        apiId_ = 0;
        line_.wake(now);
    }
    sendPackets(now);
}

bool XBee::hears(const RfPacket& packet) const {
    if (active_.at("CH") != packet.channel ||
        (active_.at("ID") != packet.pan && packet.pan != RfPacket::allPans))
        return false;
    if (packet.wide)
        return packet.to64 == serial();
    return packet.isBroadcast() || (active_.at("MY") == packet.to && packet.to < 0xFFFE);
}

XBee::Reception XBee::receive(const RfPacket& onAir, uint64_t now) {
    if (mode_ == Mode::Off || mode_ == Mode::Boot)
        return Reception::Absent;
    RfPacket packet = onAir;
    work(now, packet.encrypted);
    active_["DB"] = pending_["DB"] = static_cast<uint32_t>(std::clamp(-packet.rssi, 23.0, 92.0));
    bool wantsHeader = active_.at("MM") == 0 || active_.at("MM") == 3;
    if (wantsHeader && !packet.header)
        // the packet is acknowledged, but with this value of MM the modem ignores it
        return Reception::Taken;
    if (packet.encrypted != (active_.at("EE") != 0)) {
        ++counters_.packetsUnreadable;
        return Reception::Taken;
    }
    if (packet.encrypted)
        packet.bytes = XBeeCrypt::decrypt(key_, packet.serial, packet.bytes);
    size_t size = packet.bytes.size() + (active_.at("AP") ? (packet.from64 ? 15 : 9) : 0) +
                  (wantsHeader || !packet.header ? 0 : 2);
    if (output_.size() + size > outputBytes) {
        ++counters_.packetsDropped;
        return Reception::NoRoom;
    }
    if (packet.sequenced) {
        auto [last, isNew] = lastSequence_.emplace(packet.from, packet.sequence);
        if (!isNew && last->second == packet.sequence) {
            ++counters_.duplicatesDropped;
            return Reception::Taken;
        }
        last->second = packet.sequence;
    }
    ++counters_.packetsReceived;
    if (packet.header && !wantsHeader)
        packet.bytes.insert(packet.bytes.begin(), {static_cast<uint8_t>(packet.sequence), 0x00});
    if (active_.at("AP"))
        apiReceived(packet);
    else
        output_.insert(output_.end(), packet.bytes.begin(), packet.bytes.end());
    line_.wake(now);
    return Reception::Taken;
}

bool XBee::nextToHost(uint8_t& byte) {
    if (output_.empty())
        return false;
    byte = output_.front();
    output_.pop_front();
    atOldRate_ -= atOldRate_ > 0;
    ++counters_.bytesToHost;
    return true;
}

uint64_t XBee::nextEvent() const {
    uint64_t at = line_.nextEvent();
    if (mode_ == Mode::Boot)
        at = std::min(at, bootDone_);
    if (mode_ == Mode::Command)
        at = std::min(at, commandUntil_);
    if (mode_ == Mode::Data && pluses_)
        at = std::min(at, lastByte_ + guardNs());
    if (mode_ == Mode::Data && flushCount_ < input_.size())
        at = std::min(at, lastByte_ + active_.at("RO") * charNs());
    return at;
}

void XBee::advance(uint64_t now) {
    line_.advance(now);
    if (mode_ == Mode::Boot && now >= bootDone_) {
        mode_ = Mode::Data;
        lastByte_ = now;
        if (active_.at("AP")) {
            apiReply({0x8A, 0x00}); // modem status: hardware reset
            line_.wake(now);
        }
    }
    if (mode_ == Mode::Command && now >= commandUntil_)
        leaveCommandMode();
    if (mode_ == Mode::Data)
        silence(now);
    if (baud() != nextBaud_) {
        nextBaud_ = baud();
        atOldRate_ = output_.size();
    }
    if (!atOldRate_ || output_.empty())
        line_.setBitTime(1e9 / nextBaud_);
}
