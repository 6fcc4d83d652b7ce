// SPDX-License-Identifier: MIT
//
// engine: one serial port with a modem, which it sets up by AT commands, and the link layer over
// it. An engine has one thread. All communicators of the process that name one device share its
// engine.

#ifndef GROUND_ENGINE_H
#define GROUND_ENGINE_H

#include "api_modem.h"
#include "clock.h"
#include "frame_pacer.h"
#include "serial_port.h"
#include "settings.h"
#include "stream.h"

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>

extern "C" {
#include "link.h"
}

namespace XBeeAT {

constexpr int ownChannels = 3; // 0..2 are opened by the ground, 3 by the UAV

class Engine {
public:
    // Returns the device's engine, existing or new. Throws std::system_error if the device cannot
    // be opened. An empty device means the only one that is open.
    static std::shared_ptr<Engine> get(const Settings& settings, const Log& log);

    ~Engine();
    Engine(const Engine&) = delete;
    Engine& operator=(const Engine&) = delete;

    // Opens a connection to the peer, on a channel of 0..2 or (-1) any one. Returns the program's
    // end of it, a socket; -1 where no descriptor is left. The peer speaks once the link is up and
    // a channel is free; programs wait their turn. A lost port is opened again. The socket ends if
    // there is no modem. A message that the peer has not taken in `lateMs` is withdrawn by the end
    // of the session; one that the link had no room for, by that of the connection. -1: never.
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
    const std::string& device() const { return device_; }

private:
    Engine(const Settings& settings, const Log& log);
    void run();
    std::string prepareModem(const Settings& settings);
    void fly(std::unique_lock<std::mutex>& lock);
    void waitForReason(std::unique_lock<std::mutex>& lock);
    void loop(std::unique_lock<std::mutex>& lock);
    bool downTooLong(U32 now);
    void fail(const std::string& text);
    // Waits as ModemSetup::Wait does; negative: the engine must stop, or the port is lost.
    int waitMs(int ms, bool forBytes);
    bool isWanted() const;
    void readSerial(U32 now);
    void writeSerial(U32 now);
    struct Waiting { // a program without a channel
        int fd, channel;
        U32 lateUs;
    };
    int freeChannel(int wanted, U32 now);
    void placePrograms(U32 now);
    int calledChannel() const;
    void servePrograms(const std::vector<pollfd>& fds, U32 now);
    void sendMessages(U32 now);
    bool sendMessage(int channel, U32 now);
    void end(int channel, int level, const std::string& why);
    void openWanted(U32 now);
    U32 withdrawLate(U32 now);
    void reportLost();
    U32 beat(U32 now);
    void wake();

    static Engine& self(void* context) { return *static_cast<Engine*>(context); }
    static int onTransmit(void* context, const U8* frame, U32 size);
    static U32 onRandom(void* context);
    static int onMessage(void* context, int channel, const U8* data, U32 size);
    static void onChannel(void* context, int channel, int isOpen);
    static void onState(void* context, Link_State state);
    static void onOutcome(void* context, int channel, U32 isCall, Link_Outcome outcome);
    static void onWritable(void* context);

    const std::string device_;
    Settings settings_; // for the next set-up
    Log log_;
    Clock clock_;
    SerialPort serial_{clock_};
    int wakePipe_[2] = {-1, -1}, acceptPipe_[2] = {-1, -1};
    // failed_: the port is lost, or no modem answered; complained_: that was logged as an error.
    bool stop_ = false, listening_ = false, failed_ = false, complained_ = false;
    int nextChannel_ = 0; // where `connect` begins to search
    int turn_ = 0;        // the channel whose program sends next
    unsigned full_ = 0;   // a bit a channel: the link has no room for its message
    unsigned lost_ = 0;   // unconfirmed calls of programs that have left
    Stream streams_[LINK_CHANNELS];
    std::deque<U32> late_[LINK_CHANNELS]; // when each message of the link's will be late
    std::deque<Waiting> waiting_;
    std::unique_ptr<Link> link_;
    std::vector<U8> serialOut_; // the frame's bytes that the port has not taken yet
    FramePacer pacer_;
    std::unique_ptr<ApiModem> api_; // in API mode; else the pacer makes packets
    U32 upAt_ = 0, patienceUs_ = 0; // when the link was last up; how long it may be down
    mutable std::mutex mutex_;
    std::condition_variable changed_; // of stop_, listening_, requests for streams
    std::thread thread_;
};

} // namespace XBeeAT

#endif
