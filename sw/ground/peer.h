// SPDX-License-Identifier: MIT
//
// peer: one vehicle, as programs of the ground see it: the link with it, and their connections; or
// all vehicles, by one-way calls without a link.

#pragma once

#include "broadcast.h"
#include "stream.h"

#include <deque>
#include <memory>
#include <mutex>

extern "C" {
#include "link.h"
}

namespace XBeeAT {

class Clock;

constexpr int ownChannels = 3; // 0..2 are opened by the ground, 3 by the UAV

// Functions of programs take the lock themselves; the engine holds it when it calls the others.
class Peer {
public:
    // Host is what all peers of an engine share.
    struct Host {
        const std::string device;
        Settings settings; // for the next set-up
        Log log;
        Clock& clock;
        std::mutex mutex;
        bool hasMany = false;  // peers: log lines say which
        Link* radio = nullptr; // one of the links, which share the modem's answers

        Host(const Settings& s, const Log& l, Clock& c)
            : device(s.device), settings(s), log(l), clock(c) {}
        virtual ~Host() = default;
        // Hands a frame to the radio. False: it has no room.
        virtual bool transmit(Peer& peer, const U8* frame, U32 size) = 0;
        virtual void wake() = 0; // a program wants something
    };

    Peer(Host& host, int address, const LinkKeys& keys);
    ~Peer();
    Peer(const Peer&) = delete;
    Peer& operator=(const Peer&) = delete;

    // ---- of programs ----

    // Opens a connection to the peer, on a channel of 0..2 or (-1) any one. Returns the program's
    // end of it, a socket; -1 where no descriptor is left. The peer speaks once the link is up and
    // a channel is free; programs wait their turn. A lost port is opened again. The socket ends if
    // there is no modem. A message that the peer has not taken in `lateMs` is withdrawn by the end
    // of the session; one that the link had no room for, by that of the connection. -1: never.
    // Returns -1 with EBUSY while another ground with this one's address has the vehicle.
    int connect(int channel, int lateMs = -1);
    size_t waiting() const; // programs without a channel
    // Lets the peer open connections. Each makes the returned descriptor readable, also after the
    // port was lost and found again. -1: another has called this.
    int listen();
    // Takes a connection that the peer opened. Returns the program's end of it, a socket; -1 if
    // there is none.
    int accept();
    void stopListening();
    std::string statistics() const; // one line of text
    const std::string& device() const { return host_.device; }
    bool isAll() const { return broadcast_ != nullptr; }
    bool hasLink() const { return !isAll(); }
    U32 mostBytes() const; // of a message

    // ---- of the engine ----

    int address() const { return address_; }
    const LinkKeys& keys() const { return keys_; }
    bool isUp() const { return Link_state(link_.get()) == LINK_STATE_UP; }
    bool isHeard() const { return isUp() || isTaken_; }
    bool isWanted() const; // by a program that connects
    bool listens() const { return listening_; }
    // The modem is ready: frames have `longest` bytes at most; `isApi`: it answers for each packet.
    void start(U32 longest, bool isApi, U32 now);
    void stop(U32 now); // tells the vehicle
    void fail();        // ends all connections and those that wait for one
    U32 randomWait() { return isAll() ? LINK_WAIT_SHARED : Link_randomWait(link_.get()); }
    void receive(const U8* bytes, size_t size, U32 now);
    // Does what is due. Returns when to call again, in microseconds.
    U32 poll(U32 now);
    // Adds what poll(2) must wait for: a descriptor for each channel.
    void addInterest(std::vector<pollfd>& fds) const;
    void servePrograms(const pollfd* fds, U32 now);
    void reportLost();

    uint64_t airUs = 0; // time on the air that it has had

private:
    struct Waiting { // a program without a channel
        int fd, channel;
        U32 lateUs;
    };
    int freeChannel(int wanted, U32 now);
    void placePrograms(U32 now);
    int calledChannel() const;
    void sendMessages(U32 now);
    bool sendMessage(int channel, U32 now);
    bool sendToAll(int channel, U32 now);
    void waitForRoom(int channel);
    U32 pollBroadcast(U32 now);
    void end(int channel, int level, const std::string& why);
    void openWanted(U32 now);
    U32 withdrawLate(U32 now);
    void standBy(U32 now);
    void refuse();
    void seekAgain(U32 now);
    void log(int level, const std::string& text) const;

    static Peer& self(void* context) { return *static_cast<Peer*>(context); }
    static int onTransmit(void* context, const U8* frame, U32 size);
    static U32 onRandom(void* context);
    static int onMessage(void* context, int channel, const U8* data, U32 size);
    static void onChannel(void* context, int channel, int isOpen);
    static void onState(void* context, Link_State state);
    static void onOutcome(void* context, int channel, U32 isCall, Link_Outcome outcome);
    static void onWritable(void* context);

    Host& host_;
    const int address_;
    LinkKeys keys_;
    int acceptPipe_[2] = {-1, -1};
    bool listening_ = false;
    int nextChannel_ = 0;     // where `connect` begins to search
    int turn_ = 0;            // the channel whose program sends next
    unsigned full_ = 0;       // a bit a channel: the link has no room for its message
    unsigned lost_ = 0;       // unconfirmed calls of programs that have left
    bool hearsOther_ = false; // what was heard last is of a session that this side has not
    bool isLost_ = false;     // the own session ended meanwhile,
    bool isTaken_ = false;    // and another ground has the vehicle
    U32 heardAt_ = 0, takenAt_ = 0;
    U8 head_[LINK_HEADER]; // of the packet under way, while isTaken_
    U32 headSize_ = 0;
    Stream streams_[LINK_CHANNELS];
    std::deque<U32> late_[LINK_CHANNELS]; // when each message of the link's will be late
    std::deque<Waiting> waiting_;
    std::unique_ptr<Link> link_;
    std::unique_ptr<Link_Buffers> buffers_; // of link_
    std::unique_ptr<Broadcast> broadcast_;  // in its place, to all vehicles
};

// Returns both ends of a pipe that does not block. Throws std::system_error.
void makePipe(int pipeEnds[2]);

} // namespace XBeeAT
