// SPDX-License-Identifier: MIT
//
// peer: the destination of programs on the ground: one vehicle (VehiclePeer), or all vehicles at
// once (BroadcastPeer). A peer owns the connections of the programs; the derived class knows the
// way to the vehicle.

#pragma once

#include "clock.h"
#include "packet_line.h"
#include "program_connection.h"
#include "settings.h"

#include <deque>
#include <memory>
#include <mutex>

extern "C" {
#include "link.h"
}

namespace XBeeAT {

constexpr int ownChannels = 3; // 0..2 are opened by the ground, 3 by the UAV

// Functions called by programs take the lock; the engine holds it when it calls the others.
class Peer : public PacketLine::Sender {
public:
    // What all peers of an engine share.
    struct Host {
        const std::string device;
        Settings settings; // settings of the next set-up
        Log log;
        const std::unique_ptr<Clock> ownClock;
        Clock& clock;
        PacketLine& line;
        std::mutex mutex;
        bool hasMany = false;  // several peers: log lines name the peer
        Link* radio = nullptr; // the first link; all links share the modem's answers

        Host(const Settings& s, const Log& l, std::unique_ptr<Clock> c, PacketLine& p)
            : device(s.device), settings(s), log(l), ownClock(std::move(c)), clock(*ownClock),
              line(p) {}
        virtual ~Host() = default;
        virtual void wake() = 0; // a program needs service
    };

    ~Peer() override;
    Peer(const Peer&) = delete;
    Peer& operator=(const Peer&) = delete;

    // ---- functions of programs ----

    // Opens a connection to the peer, on channel 0..2 or any (-1). Returns a socket for the
    // program, or -1 if no descriptor is left. The peer speaks once the link is up and a channel is
    // free; programs wait their turn. A lost port is opened again. Without a modem the socket is
    // closed. A message that the peer has not taken in `lateMs` is withdrawn by ending the session;
    // a message for which the link has no room, by ending the connection; -1 disables both.
    // Returns -1 with EBUSY while another ground station with the same address has the vehicle.
    int connect(int channel, int lateMs = -1);
    size_t waiting() const; // programs without a channel
    // Lets the peer open connections. Each makes the returned descriptor readable, also after the
    // port was lost and found again. Returns -1 if another program listens.
    int listen();
    // Takes a connection that the peer opened. Returns a socket for the program, or -1 if the peer
    // has not opened a connection.
    int accept();
    void stopListening();
    virtual std::string statistics() const = 0; // one line of text
    const std::string& device() const { return host_.device; }
    virtual U32 mostBytes() const = 0;           // bytes of the longest message
    virtual const char* carrierName() const = 0; // carrier of a message, for error texts

    // ---- functions of the engine ----

    const LinkKeys& keys() const { return keys_; }
    virtual bool hasLink() const = 0; // a session with one vehicle
    virtual bool isHeard() const = 0; // the vehicle is there
    bool isWanted() const;            // a program connects
    bool listens() const { return listening_; }
    // The modem is ready: frames have `longest` bytes at most; `isApi`: it answers for each packet.
    virtual void start(U32 longest, bool isApi, U32 now) = 0;
    virtual void stop(U32 now) = 0; // also informs the vehicle
    void fail();                    // ends all connections and pending connects
    virtual void receive(const U8* bytes, size_t size, U32 now) = 0;
    // Does the work that is due. Returns the time of the next call, in microseconds.
    U32 poll(U32 now);
    // Adds the descriptors for poll(2): one per channel.
    void addInterest(std::vector<pollfd>& fds) const;
    void servePrograms(const pollfd* fds, U32 now);

protected:
    Peer(Host& host, int address, const LinkKeys& keys);

    // What the kinds of peers implement:
    virtual bool isYielded() const { return false; } // another ground has the vehicle
    virtual bool isReady() const = 0;                // channels can be opened
    virtual bool openChannel(int channel) = 0;       // on behalf of a program
    virtual void opened(ProgramConnection& program, U32 now) = 0;
    virtual void closeChannel(int channel) = 0;
    virtual U32 longestMessage() const = 0; // lock held
    // Sends the next message of a connection. Returns whether it was taken.
    virtual bool send(int channel, U32 now) = 0;
    // Does the work due for the way to the vehicle. Returns the time of the next call, in
    // microseconds.
    virtual U32 pollWay(U32 now) = 0;

    // Ends a program's connection; `why` completes a sentence about it.
    void end(int channel, int level, const std::string& why);
    void refusePrograms();       // ends the connections of programs that have no channel yet
    void placePrograms(U32 now); // gives waiting programs a channel
    void openWanted(U32 now);
    void waitForRoom(int channel);
    void log(int level, const std::string& text) const;

    Host& host_;
    LinkKeys keys_;
    ProgramConnection programs_[LINK_CHANNELS];
    unsigned full_ = 0; // a bit per channel: its message waits for room
    int acceptPipe_[2] = {-1, -1};
    bool listening_ = false;

private:
    struct Waiting { // a program without a channel
        int fd, channel;
        U32 lateUs;
    };
    int freeChannel(int wanted, U32 now);
    int calledChannel() const;
    bool sendMessage(int channel, U32 now);
    void sendMessages(U32 now);
    U32 endLate(U32 now);

    int nextChannel_ = 0; // channel at which `connect` starts its search
    int turn_ = 0;        // channel of the program that sends next
    std::deque<Waiting> waiting_;
};

// Returns both ends of a non-blocking pipe. Throws std::system_error.
void makePipe(int pipeEnds[2]);

// Returns the time until `at`, 0 if it has passed.
inline U32 untilLate(U32 at, U32 now) {
    return static_cast<int32_t>(at - now) <= 0 ? 0 : at - now;
}

} // namespace XBeeAT
