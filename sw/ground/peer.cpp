// SPDX-License-Identifier: MIT
//
// peer: callbacks of the link, calls of the engine, and what goes between them and programs.

#include "peer.h"

#include "clock.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <fcntl.h>
#include <system_error>
#include <unistd.h>

namespace XBeeAT {

namespace {

constexpr U32 lookUs = 50000;          // interval of looking for a channel while programs wait
constexpr U32 briefBytes = 128;        // of a message that one fragment takes, its head compressed
constexpr U32 quietUs = LINK_AGE_LAST; // of a vehicle that has left whoever took it
constexpr U32 longestUs = 60'000'000;  // a vehicle does not call a second ground, which calls again
// A vehicle with a session speaks at least this often, for it is asked when it is silent. What was
// heard before is of a frame that a reset has cut.
constexpr U32 speaksWithinUs = LINK_PING_AFTER + 4 * LINK_PING_EVERY;

} // namespace

void makePipe(int pipeEnds[2]) {
    if (pipe2(pipeEnds, O_CLOEXEC | O_NONBLOCK) != 0)
        throw std::system_error(errno, std::generic_category(), "pipe");
}

Peer::Peer(Host& host, int address, const LinkKeys& keys)
    : host_(host), address_(address), keys_(keys), link_(new Link), buffers_(new Link_Buffers) {
    makePipe(acceptPipe_);
    static const Link_Port port = {onTransmit, onRandom,  onMessage, onChannel,
                                   onState,    onOutcome, onWritable};
    const Link_Config config = {&port, this, static_cast<U32>(host.settings.characterUs() * 16),
                                LINK_USE(*buffers_)};
    Link_init(link_.get(), &config);
    if (!host.radio)
        host.radio = link_.get();
    Link_shareRadio(link_.get(), host.radio);
    if (address == everybody)
        broadcast_ = std::make_unique<Broadcast>(host.settings, keys_);
    for (size_t slot = 0; !isAll() && slot < keys_.size(); ++slot)
        Link_setKey(link_.get(), static_cast<int>(slot), keys_[slot].data(),
                    LINK_GROUND | static_cast<U32>(address_));
}

Peer::~Peer() {
    for (size_t slot = 0; slot < keys_.size(); ++slot) {
        Link_setKey(link_.get(), static_cast<int>(slot), nullptr, LINK_GROUND);
        explicit_bzero(keys_[slot].data(), keys_[slot].size());
    }
    for (const Waiting& program : waiting_)
        close(program.fd);
    for (int fd : acceptPipe_)
        close(fd);
}

void Peer::log(int level, const std::string& text) const {
    char vehicle[16] = "";
    if (host_.hasMany)
        std::snprintf(vehicle, sizeof vehicle, "0x%04X: ", static_cast<unsigned>(address_));
    host_.log(level, vehicle + text);
}

// ---- callbacks of the link, in the engine's thread, mutex held ----

int Peer::onTransmit(void* context, const U8* frame, U32 size) {
    return self(context).host_.transmit(self(context), frame, size) ? 0 : 1;
}

U32 Peer::onRandom(void* context) {
    return self(context).host_.settings.random();
}

int Peer::onMessage(void* context, int channel, const U8* data, U32 size) {
    Peer& e = self(context);
    Stream& s = e.streams_[channel];
    U32 now = e.host_.clock.nowUs();
    bool isWanted = s.is(Stream::State::Open) || s.is(Stream::State::Called);
    // The link delivers in order, so a message held back would hold all other programs' back.
    if (isWanted && !s.give(data, size, now))
        e.end(channel, 0,
              "does not read: " + std::to_string(Stream::mostUnread) + " bytes wait for it");
    return 0;
}

void Peer::onChannel(void* context, int channel, int isOpen) {
    Peer& e = self(context);
    Stream& s = e.streams_[channel];
    if (!isOpen) {
        if (!s.is(Stream::State::Wanted))
            e.lost_ += s.leave(e.host_.clock.nowUs());
        return;
    }
    if (channel < ownChannels || !e.listening_) {
        e.log(1, "the peer opened channel " + std::to_string(channel) + ", and nobody listens");
        Link_closeChannel(e.link_.get(), channel);
        return;
    }
    s.call();
    char byte = 0;
    (void)!write(e.acceptPipe_[1], &byte, 1);
}

void Peer::onState(void* context, Link_State state) {
    Peer& e = self(context);
    static const char* const names[] = {"idle", "connecting", "up"};
    const bool isSecure = Link_keyInUse(e.link_.get()) >= 0;
    e.log(1, "link " + std::string(names[state]) +
                 (state != LINK_STATE_UP ? ""
                  : isSecure             ? ", secure"
                                         : ", in the clear"));
    e.isLost_ = state != LINK_STATE_UP && e.hearsOther_ &&
                e.host_.clock.nowUs() - e.heardAt_ < speaksWithinUs;
    if (state == LINK_STATE_UP)
        return;
    for (Stream& s : e.streams_)
        if (!s.is(Stream::State::Wanted))
            e.lost_ += s.leave(e.host_.clock.nowUs());
}

void Peer::onOutcome(void* context, int channel, U32 isCall, Link_Outcome outcome) {
    const Stream& s = self(context).streams_[channel];
    self(context).late_[channel].pop_front();
    bool hasLeft = !s.is(Stream::State::Open) || s.ended();
    self(context).lost_ += hasLeft && isCall && outcome == LINK_UNKNOWN;
}

void Peer::onWritable(void* context) {
    self(context).full_ = 0;
}

// Ends a program's connection: `why` completes a sentence about it.
void Peer::end(int channel, int level, const std::string& why) {
    Stream& s = streams_[channel];
    log(level, s.name() + " " + why + ": connection closed");
    s.close();
    Link_closeChannel(link_.get(), channel);
}

// Notes that a program's message waits for room.
void Peer::waitForRoom(int channel) {
    if (!full_)
        turn_ = channel;
    full_ |= 1u << channel;
}

// Sends the next message of a program to all vehicles. True: it was taken. A program that closes
// waits until its calls are on the air.
bool Peer::sendToAll(int channel, U32 now) {
    Stream& s = streams_[channel];
    if (s.kind() == Stream::Kind::Twoway) {
        s.refuse("xbee-at: a call to all vehicles (-a 0xFFFF) has no answer: use a oneway proxy",
                 now);
        return true;
    }
    if (broadcast_->isBusy())
        waitForRoom(channel);
    else if (s.kind() == Stream::Kind::Goodbye)
        end(channel, 1, "has ended");
    else if (s.kind() != Stream::Kind::Oneway)
        end(channel, 0, "sent a batch, and one call at a time goes to all vehicles");
    else if (!broadcast_->take(s.data(), s.size(), now))
        end(channel, 0, "calls all vehicles, and the clock of this machine is not set");
    else {
        s.taken(now);
        return true;
    }
    return false;
}

// Sends the next message of a program. True: it went to the link.
bool Peer::sendMessage(int channel, U32 now) {
    Stream& s = streams_[channel];
    if (!s.is(Stream::State::Open))
        return false;
    const U32 most = isAll() ? broadcast_->most() : LINK_MAX_MESSAGE;
    switch (s.next(most)) {
    case Stream::Next::Senseless:
        end(channel, 0,
            "sent a message of " + std::to_string(s.size()) + " bytes, which does not fit the " +
                (isAll() ? "packet to all vehicles" : "radio link") + " (at most " +
                std::to_string(most) + ")");
        return false;
    case Stream::Next::None:
        if (s.ended())
            end(channel, 1, "has ended");
        return false;
    case Stream::Next::Message:
        break;
    }
    if (isAll())
        return sendToAll(channel, now);
    const bool mustWait = full_ && s.size() > briefBytes;
    const Link_Status status =
        mustWait ? LINK_FULL : Link_send(link_.get(), channel, s.data(), s.size(), s.isCall());
    if (status == LINK_FULL) {
        waitForRoom(channel);
    } else if (status == LINK_OK) {
        late_[channel].push_back(s.lateAt());
        s.taken(now);
    } else
        end(channel, 1, "has no channel any more");
    return status == LINK_OK;
}

// Sends what the programs have written. They take turns, a message each, so that a flood leaves
// room for others. While one waits for room the others send only short ones, for which the link has
// a reserve.
void Peer::sendMessages(U32 now) {
    for (int idle = 0, channel = turn_; idle < LINK_CHANNELS; ++idle) {
        if (!full_)
            turn_ = (channel + 1) % LINK_CHANNELS;
        if (!(full_ >> channel & 1) && sendMessage(channel, now))
            idle = -1;
        channel = (channel + 1) % LINK_CHANNELS;
    }
}

void Peer::openWanted(U32 now) {
    if (isAll() ? broadcast_->most() == 0 : !isUp())
        return;
    for (int channel = 0; channel < ownChannels; ++channel)
        if (streams_[channel].is(Stream::State::Wanted) &&
            (isAll() || Link_openChannel(link_.get(), channel) == LINK_OK)) {
            streams_[channel].open(now);
            if (isAll())
                streams_[channel].greet(now);
        }
}

// Logs the calls of programs that have left: nobody else can be told.
void Peer::reportLost() {
    if (lost_)
        log(0, "calls of programs that have left, and may not have reached the UAV: " +
                   std::to_string(lost_));
    lost_ = 0;
}

// Withdraws what is late, so that nobody carries out what its caller has given up. Returns when to
// look again, in microseconds.
U32 Peer::withdrawLate(U32 now) {
    U32 wait = 0xFFFFFFFFu;
    const auto isLate = [&wait, now](U32 at) {
        const bool is = static_cast<int32_t>(at - now) <= 0;
        wait = std::min(wait, is ? 0 : at - now);
        return is;
    };
    for (int channel = 0; channel < LINK_CHANNELS; ++channel) {
        const Stream& s = streams_[channel];
        if (!late_[channel].empty() && isLate(late_[channel].front())) {
            log(0, s.name() + " has a message that nobody took in time: the session ends");
            Link_stop(link_.get(), now);
            Link_start(link_.get(), now);
            return 0;
        }
        if (s.is(Stream::State::Open) && (full_ >> channel & 1) && isLate(s.lateAt()))
            end(channel, 0, "waits for room longer than its time-out");
    }
    return wait;
}

// ---- calls of the engine, mutex held ----

void Peer::start(U32 longest, bool isApi, U32 now) {
    isTaken_ = isLost_ = hearsOther_ = false;
    if (isAll()) {
        broadcast_->limitPacket(longest);
        return;
    }
    Link_limitFrame(link_.get(), longest);
    Link_expectAnswers(link_.get(), isApi ? host_.settings.mostWaiting() : 0);
    Link_start(link_.get(), now);
}

void Peer::stop(U32 now) {
    if (isAll())
        broadcast_->stop();
    else
        Link_stop(link_.get(), now);
    reportLost();
}

void Peer::fail() {
    stop(host_.clock.nowUs());
    for (Stream& s : streams_)
        s.close();
    refuse();
}

// Ends the connections of programs that have not yet got one.
void Peer::refuse() {
    for (Stream& s : streams_)
        if (s.is(Stream::State::Wanted))
            s.close();
    for (const Waiting& program : waiting_)
        close(program.fd);
    waiting_.clear();
}

// Gives bytes to the link, which come as the line brings them. While another ground has the vehicle
// the link gets none, for it would call: only the vehicle's own call, at the beginning of a packet,
// which says that it has no session any more.
void Peer::receive(const U8* bytes, size_t size, U32 now) {
    if (!hasLink())
        return;
    if (now - heardAt_ >= LINK_FRAME_GAP)
        headSize_ = 0;
    heardAt_ = now;
    if (isTaken_) {
        for (; size && headSize_ < LINK_HEADER; --size)
            head_[headSize_++] = *bytes++;
        if (headSize_ < LINK_HEADER || LINK_KIND_OF(head_) != LINK_KIND_HELLO ||
            head_[1] != LINK_VERSION)
            return;
        seekAgain(now);
        Link_receive(link_.get(), head_, LINK_HEADER, now);
    }
    const Link_Statistics& s = *Link_statistics(link_.get());
    const U32 frames = s.framesReceived, skipped = s.bytesSkipped;
    Link_receive(link_.get(), bytes, static_cast<U32>(size), now);
    if (s.framesReceived != frames || s.bytesSkipped != skipped)
        hearsOther_ = s.framesReceived == frames;
}

// Leaves the vehicle to another ground with this address, which has it: the session ended while the
// vehicle went on speaking, and not to this side. Two that called would take it from each other
// for ever.
void Peer::standBy(U32 now) {
    if (isLost_ && Link_state(link_.get()) == LINK_STATE_CONNECTING) {
        Link_stop(link_.get(), now);
        isTaken_ = true;
        heardAt_ = takenAt_ = now;
        headSize_ = LINK_HEADER; // of a packet under way, which is no call
        head_[0] = 0;
        log(0,
            "another ground with this one's address has the vehicle now: this one waits until it "
            "calls; who wants it sooner starts this one again");
        refuse();
    }
    isLost_ = false;
    if (isTaken_ &&
        (now - heardAt_ >= quietUs || (host_.settings.source && now - takenAt_ >= longestUs)))
        seekAgain(now);
}

void Peer::seekAgain(U32 now) {
    isTaken_ = hearsOther_ = false;
    Link_start(link_.get(), now);
}

U32 Peer::pollBroadcast(U32 now) {
    openWanted(now);
    const U32 due = broadcast_->poll(
        now, [this](const U8* packet, U32 size) { return host_.transmit(*this, packet, size); });
    if (broadcast_->isBusy() || !full_)
        return due;
    full_ = 0;
    return 0;
}

U32 Peer::poll(U32 now) {
    reportLost();
    standBy(now);
    placePrograms(now);
    Link_poll(link_.get(), now);
    const U32 due = isAll() ? pollBroadcast(now) : Link_deadline(link_.get(), now);
    U32 wait =
        std::min({withdrawLate(now), due, waiting_.empty() && !isTaken_ ? 0xFFFFFFFFu : lookUs});
    for (Stream& s : streams_)
        wait = std::min(wait, s.beat(now));
    return wait;
}

void Peer::addInterest(std::vector<pollfd>& fds) const {
    for (const Stream& s : streams_)
        fds.push_back(s.interest(!(full_ >> (&s - streams_) & 1)));
}

void Peer::servePrograms(const pollfd* fds, U32 now) {
    for (Stream& s : streams_) {
        s.write(now);
        const pollfd& p = *fds++;
        if (p.fd >= 0 && p.fd == s.fd() && (p.events & POLLIN) && p.revents)
            s.read(now);
    }
    openWanted(now);
    sendMessages(now);
}

} // namespace XBeeAT
