// SPDX-License-Identifier: MIT
//
// peer: the peer to which programs on the ground connect: one vehicle (VehiclePeer), or all
// vehicles at once (BroadcastPeer). A peer owns the connections of the programs; the derived class
// carries their messages.

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

// number of channels that the ground station can open (channels 0 to 2); the UAV opens channel 3
constexpr int ownChannels = 3;

// The functions for programs acquire the lock. All other functions are called by the engine, which
// holds the lock.
class Peer : public PacketLine::Sender {
public:
    // Data that all peers of an engine share.
    struct Host {
        const std::string device;
        Settings settings; // settings that the next set-up of the modem uses
        Log log;
        const std::unique_ptr<Clock> ownClock;
        Clock& clock;
        PacketLine& line;
        std::mutex mutex;
        bool hasMany = false; // with several peers, log lines contain the name of the peer
        // first link; it holds the list of unanswered packets that all links share
        Link* radio = nullptr;

        Host(const Settings& s, const Log& l, std::unique_ptr<Clock> c, PacketLine& p)
            : device(s.device), settings(s), log(l), ownClock(std::move(c)), clock(*ownClock),
              line(p) {}
        virtual ~Host() = default;
        virtual void wake() = 0; // wakes the engine's thread, because a program needs service
    };

    ~Peer() override;
    Peer(const Peer&) = delete;
    Peer& operator=(const Peer&) = delete;

    // ---- functions for programs ----

    // Opens a connection to the peer on channel 0 to 2, or on any of these (-1). Returns a socket
    // for the program, or -1 if no descriptor is left. Messages are passed on when the link is up
    // and a channel is free; programs get channels in turn. If the serial port was lost, opens it
    // again. If no modem answers, closes the socket. If the peer has not accepted a message within
    // `lateMs`, the message is withdrawn: if the message is already in the link, the session ends;
    // otherwise only the connection ends. A `lateMs` of -1 disables this limit. While another
    // ground station with the same address is connected to the vehicle, returns -1 with EBUSY.
    int connect(int channel, int lateMs = -1);
    size_t waiting() const; // number of programs that wait for a channel
    // Lets the peer open connections. Returns a descriptor that becomes readable for each new
    // connection, even after the serial port was lost and found again. Returns -1 if another
    // program already listens.
    int listen();
    // Accepts a connection that the peer has opened. Returns a socket for the program, or -1 if
    // no such connection exists.
    int accept();
    void stopListening();
    virtual std::string statistics() const = 0; // statistics as one line of text
    const std::string& device() const { return host_.device; }
    virtual U32 mostBytes() const = 0; // size of the longest message, bytes
    // name of the path to this peer for error texts, such as "the radio link"
    virtual const char* carrierName() const = 0;

    // ---- functions of the engine ----

    const LinkKeys& keys() const { return keys_; }
    virtual bool hasLink() const = 0; // true while this station has a session with one vehicle
    // true while the vehicle has a session with any ground station
    virtual bool isHeard() const = 0;
    bool isWanted() const; // true if a program wants a connection
    bool listens() const { return listening_; }
    // Starts the peer when the modem is ready. `longest`: size of the largest frame, bytes.
    // `isApi`: true if the modem reports a result for each packet.
    virtual void start(U32 longest, bool isApi, U32 now) = 0;
    virtual void stop(U32 now) = 0; // stops the peer, and informs the vehicle
    void fail();                    // ends all connections and pending connects
    virtual void receive(const U8* bytes, size_t size, U32 now) = 0;
    // Does the work that is due. Returns the time until the next call, in microseconds.
    U32 poll(U32 now);
    // Adds the descriptors for poll(2), one for each channel.
    void addInterest(std::vector<pollfd>& fds) const;
    void servePrograms(const pollfd* fds, U32 now);

protected:
    Peer(Host& host, int address, const LinkKeys& keys);

    // ---- functions of the derived classes ----

    // Returns true if this station has left the vehicle to another ground station.
    virtual bool isYielded() const { return false; }
    virtual bool isReady() const = 0;          // true if channels can be opened
    virtual bool openChannel(int channel) = 0; // opens a channel for a program
    virtual void opened(ProgramConnection& program, U32 now) = 0;
    virtual void closeChannel(int channel) = 0;
    virtual U32 longestMessage() const = 0; // the caller holds the lock
    // Sends the next message of a connection. Returns whether the message was accepted.
    virtual bool send(int channel, U32 now) = 0;
    // Does the work of the derived class that is due. Returns the time until the next call, in
    // microseconds.
    virtual U32 pollWay(U32 now) = 0;

    // Ends a program's connection and logs this at `level`. `why` is the end of the log line.
    void end(int channel, int level, const std::string& why);
    void refusePrograms();       // ends the connections of programs that do not have a channel yet
    void placePrograms(U32 now); // assigns free channels to waiting programs
    void openWanted(U32 now);
    void waitForRoom(int channel);
    void log(int level, const std::string& text) const;

    Host& host_;
    LinkKeys keys_;
    ProgramConnection programs_[LINK_CHANNELS];
    unsigned full_ = 0; // channels on which a message waits for room, one bit each
    int acceptPipe_[2] = {-1, -1};
    bool listening_ = false;

private:
    struct Waiting { // A program that waits for a channel.
        int fd, channel;
        U32 lateUs;
    };
    int freeChannel(int wanted, U32 now);
    int calledChannel() const;
    bool sendMessage(int channel, U32 now);
    void sendMessages(U32 now);
    U32 endLate(U32 now);

    int nextChannel_ = 0; // channel at which `connect` starts its search
    int turn_ = 0;        // channel of the program that may send next
    std::deque<Waiting> waiting_;
};

// Returns both ends of a non-blocking pipe. Throws std::system_error.
void makePipe(int pipeEnds[2]);

// Returns the time until `at`, or 0 if `at` has passed.
inline U32 untilLate(U32 at, U32 now) {
    return static_cast<int32_t>(at - now) <= 0 ? 0 : at - now;
}

} // namespace XBeeAT
