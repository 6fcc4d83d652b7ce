// SPDX-License-Identifier: MIT
//
// vehicle_peer: connects the programs with the link to one vehicle. It handles the link's callbacks
// and passes the programs' messages to the link.

#include "vehicle_peer.h"

#include "clock.h"

#include <algorithm>
#include <cstdio>
#include <unistd.h>

namespace XBeeAT {

namespace {

// largest message that fits into one fragment with a compressed header
constexpr U32 briefBytes = 128;

} // namespace

VehiclePeer::VehiclePeer(Host& host, int address, const LinkKeys& keys)
    : Peer(host, address, keys), link_(new Link), buffers_(new Link_Buffers) {
    static const Link_Port port = {onTransmit, onRandom,  onMessage, onChannel,
                                   onState,    onOutcome, onWritable};
    const Link_Config config = {&port, this, static_cast<U32>(host.settings.characterUs() * 16),
                                LINK_USE(*buffers_)};
    Link_init(link_.get(), &config);
    if (!host.radio)
        host.radio = link_.get();
    Link_shareRadio(link_.get(), host.radio);
    for (size_t slot = 0; slot < keys_.size(); ++slot)
        Link_setKey(link_.get(), static_cast<int>(slot), keys_[slot].data(),
                    LINK_GROUND | static_cast<U32>(address));
}

VehiclePeer::~VehiclePeer() {
    for (size_t slot = 0; slot < keys_.size(); ++slot)
        Link_setKey(link_.get(), static_cast<int>(slot), nullptr, LINK_GROUND);
}

// ---- callbacks of the link, called by the engine's thread while it holds the mutex ----

int VehiclePeer::onTransmit(void* context, const U8* frame, U32 size) {
    VehiclePeer& e = self(context);
    return e.host_.line.send(e, frame, size, e.host_.clock.nowUs()) ? 0 : 1;
}

U32 VehiclePeer::onRandom(void* context) {
    return self(context).host_.settings.random();
}

int VehiclePeer::onMessage(void* context, int channel, const U8* data, U32 size) {
    VehiclePeer& e = self(context);
    ProgramConnection& program = e.programs_[channel];
    U32 now = e.host_.clock.nowUs();
    bool isWanted =
        program.is(ProgramConnection::State::Open) || program.is(ProgramConnection::State::Called);
    // A program that does not read its messages loses its connection. The link delivers messages in
    // order, so waiting for this program would delay the messages of all programs.
    if (isWanted && !program.give(data, size, now))
        e.end(channel, 0,
              "does not read; more than " + std::to_string(ProgramConnection::mostUnread) +
                  " bytes are waiting");
    return 0;
}

// Records that the link has closed a program's channel.
void VehiclePeer::leave(ProgramConnection& program) {
    if (!program.is(ProgramConnection::State::Wanted))
        lost_ += program.leave(host_.clock.nowUs());
}

void VehiclePeer::onChannel(void* context, int channel, int isOpen) {
    VehiclePeer& e = self(context);
    ProgramConnection& program = e.programs_[channel];
    if (!isOpen)
        return e.leave(program);
    if (channel < ownChannels || !e.listening_) {
        e.log(1, "the peer opened channel " + std::to_string(channel) +
                     ", but no program accepts calls");
        Link_closeChannel(e.link_.get(), channel);
        return;
    }
    program.call();
    char byte = 0;
    (void)!write(e.acceptPipe_[1], &byte, 1);
}

void VehiclePeer::onState(void* context, Link_State state) {
    VehiclePeer& e = self(context);
    static const char* const names[] = {"idle", "connecting", "up"};
    const bool isSecure = Link_keyInUse(e.link_.get()) >= 0;
    e.log(1, "link " + std::string(names[state]) +
                 (state != LINK_STATE_UP ? ""
                  : isSecure             ? ", secure"
                                         : ", not encrypted"));
    e.rival_.sessionIs(state == LINK_STATE_UP, e.host_.clock.nowUs());
    if (state == LINK_STATE_UP)
        return;
    for (ProgramConnection& program : e.programs_)
        e.leave(program);
}

void VehiclePeer::onOutcome(void* context, int channel, U32 isCall, Link_Outcome outcome) {
    VehiclePeer& e = self(context);
    const ProgramConnection& program = e.programs_[channel];
    e.late_[channel].pop_front();
    bool hasLeft = !program.is(ProgramConnection::State::Open) || program.ended();
    e.lost_ += hasLeft && isCall && outcome == LINK_UNKNOWN;
}

void VehiclePeer::onWritable(void* context) {
    self(context).full_ = 0;
}

// ---- programs to link ----

bool VehiclePeer::send(int channel, U32 now) {
    ProgramConnection& program = programs_[channel];
    const bool mustWait = full_ && program.size() > briefBytes;
    const Link_Status status = mustWait ? LINK_FULL
                                        : Link_send(link_.get(), channel, program.data(),
                                                    program.size(), program.isCall());
    if (status == LINK_FULL) {
        waitForRoom(channel);
    } else if (status == LINK_OK) {
        late_[channel].push_back(program.lateAt());
        program.taken(now);
    } else
        end(channel, 1, "has no channel any more");
    return status == LINK_OK;
}

// Logs the unconfirmed calls of programs that have disconnected, because these programs cannot be
// informed.
void VehiclePeer::reportLost() {
    if (lost_)
        log(0, "calls of disconnected programs that may not have reached the UAV: " +
                   std::to_string(lost_));
    lost_ = 0;
}

// Ends the session if a message in the link is late. Otherwise the vehicle could execute a call
// that its caller has already abandoned. Returns the time until the next check, in microseconds.
U32 VehiclePeer::withdrawLate(U32 now) {
    U32 wait = 0xFFFFFFFFu;
    for (int channel = 0; channel < LINK_CHANNELS; ++channel) {
        if (late_[channel].empty())
            continue;
        wait = std::min(wait, untilLate(late_[channel].front(), now));
        if (wait == 0) {
            log(0, programs_[channel].name() +
                       " has a message that was not sent in time: the session ends");
            Link_stop(link_.get(), now);
            Link_start(link_.get(), now);
            return 0;
        }
    }
    return wait;
}

void VehiclePeer::start(U32 longest, bool isApi, U32 now) {
    rival_.reset();
    Link_limitFrame(link_.get(), longest);
    Link_expectAnswers(link_.get(), isApi ? host_.settings.mostWaiting() : 0);
    Link_start(link_.get(), now);
}

void VehiclePeer::stop(U32 now) {
    Link_stop(link_.get(), now);
    reportLost();
}

// Passes received bytes to the link.
void VehiclePeer::receive(const U8* bytes, size_t size, U32 now) {
    if (!rival_.admits(bytes, size, now))
        return;
    if (rival_.isYielded()) { // an admitted HELLO shows that the vehicle has no session
        resume(now);
        Link_receive(link_.get(), rival_.hello(), LINK_HEADER, now);
    }
    const Link_Statistics& s = *Link_statistics(link_.get());
    const U32 frames = s.framesReceived, skipped = s.bytesSkipped;
    Link_receive(link_.get(), bytes, static_cast<U32>(size), now);
    if (s.framesReceived != frames || s.bytesSkipped != skipped)
        rival_.heard(s.framesReceived != frames);
}

// Yields the vehicle to another ground station, or resumes. A station with an address other than 0
// resumes after a minute, because a vehicle without a session calls only the ground station with
// address 0.
void VehiclePeer::yieldOrResume(U32 now) {
    const bool connects = Link_state(link_.get()) == LINK_STATE_CONNECTING;
    switch (rival_.poll(connects, host_.settings.source != 0, now)) {
    case RivalStation::Step::Yield:
        Link_stop(link_.get(), now);
        log(0, "another ground station with the same address has connected to the vehicle: this "
               "station waits until the vehicle calls it; restart this station to take the vehicle "
               "back now");
        refusePrograms();
        break;
    case RivalStation::Step::Resume:
        resume(now);
        break;
    case RivalStation::Step::None:
        break;
    }
}

void VehiclePeer::resume(U32 now) {
    rival_.resume();
    Link_start(link_.get(), now);
}

U32 VehiclePeer::pollWay(U32 now) {
    reportLost();
    yieldOrResume(now);
    placePrograms(now);
    Link_poll(link_.get(), now);
    const U32 due = Link_deadline(link_.get(), now);
    return std::min(withdrawLate(now), due);
}

std::string VehiclePeer::statistics() const {
    std::lock_guard<std::mutex> lock(host_.mutex);
    const Link_Statistics& s = *Link_statistics(link_.get());
    char text[320];
    std::snprintf(
        text, sizeof text,
        "%s 0x%04X: %u bytes in %u frames sent (%u sent again), %u bytes in %u frames received, "
        "%u messages out, %u in, round trip %.1f ms, %u sessions, %u bytes skipped, %u saved",
        host_.device.c_str(), static_cast<unsigned>(address()), s.bytesSent, s.framesSent,
        s.fragmentsResent, s.bytesReceived, s.framesReceived, s.messagesSent, s.messagesReceived,
        s.roundTripUs / 1000.0, s.sessions, s.bytesSkipped, s.headBytesSaved);
    return text;
}

} // namespace XBeeAT
