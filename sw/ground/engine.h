// SPDX-License-Identifier: MIT
//
// engine: one serial port with a modem on it, set up by AT commands, and the link layer over it. It
// knows nothing of Ice but the 14 bytes before each message. One thread an engine; engines are
// shared by all communicators of the process that name the same device.

#ifndef GROUND_ENGINE_H
#define GROUND_ENGINE_H

#include "clock.h"
#include "frame_pacer.h"

#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

extern "C" {
#include "link.h"
}

namespace XBeeAT {

struct Settings {
    std::string device;
    int baud = 115200;    // target; 115200 is the modem's BD 7, really 111,111
    int source = 0x0000;  // MY
    int target = 0x0001;  // DL
    int rfChannel = 0x0C; // CH
    int pan = 0x3332;     // ID
    std::string key;      // AES key, up to 32 hexadecimal digits; empty: the modem's setting stays
    int guardMs = 1000;   // of the modem as it is
    bool setUp = true;    // by AT commands
    int downMs =
        15000; // the link was down for so long: set the modem up again, it may have been reset
};

// Levels: 0 error, 1 link and connections, 2 AT commands.
using Log = std::function<void(int level, const std::string& text)>;

class Engine {
public:
    // The engine of a device: the one that runs, or a new one. Throws std::system_error if the
    // device cannot be opened. An empty device means the only one that is open.
    static std::shared_ptr<Engine> get(const Settings& settings, const Log& log);

    ~Engine();
    Engine(const Engine&) = delete;
    Engine& operator=(const Engine&) = delete;

    // A connection to the peer, on a channel of 0..2 or (-1) any free one. Returns the file
    // descriptor of a stream; -1 if no channel is free. The peer speaks as soon as the link is up.
    int connect(int channel);
    // The peer may open connections: each makes the returned descriptor readable. -1: taken
    // already.
    int listen();
    int accept(); // descriptor of the stream, -1: none
    void stopListening();

    bool hasFailed() const;         // the port is lost, or no modem answered
    std::string statistics() const; // one line of text
    const std::string& device() const { return settings_.device; }

private:
    struct Channel {
        int fd = -1;          // the engine's end
        bool wanted = false;  // to be opened when the link is up
        std::vector<U8> out;  // from the program, not yet a whole message
        std::vector<U8> in;   // to the program, not yet written
        bool greeted = false; // the program's first ValidateConnection has passed
        unsigned pending = 0; // two-way requests of the program that are not answered yet
        U32 heardAt = 0;      // when it got its last message
        bool stuck = false;   // the link's queue was full
    };

    Engine(const Settings& settings, const Log& log);
    void run();
    bool prepareModem();
    void loop(std::unique_lock<std::mutex>& lock);
    bool downTooLong(U32 now);
    bool setUpModem();
    bool findModem();
    bool enterCommandMode(int guardMs);
    bool command(const std::string& text);
    std::string readReply(int timeoutMs);
    void setSpeed(int baud);
    void closeChannel(int channel);
    void fail(const std::string& text);
    bool waitMs(int ms); // false: the engine is to stop
    void readSerial(U32 now);
    void writeSerial(U32 now);
    void readProgram(int channel, U32 now);
    bool sendMessages(int channel, U32 now);
    void writeProgram(int channel);
    void openWanted(U32 now);
    bool isHeartbeat(int channel);
    void noteSent(Channel& c);
    U32 beat(U32 now);
    int newPair(int& programEnd);
    void wake();

    static Engine& self(void* context) { return *static_cast<Engine*>(context); }
    static int onTransmit(void* context, const U8* frame, U32 size);
    static U32 onRandom(void* context);
    static int onMessage(void* context, int channel, const U8* data, U32 size);
    static void onChannel(void* context, int channel, int isOpen);
    static void onState(void* context, Link_State state);
    static void onWritable(void* context);

    Settings settings_;
    Log log_;
    Clock clock_;
    int serial_ = -1, wakePipe_[2] = {-1, -1}, acceptPipe_[2] = {-1, -1};
    bool stop_ = false, listening_ = false, failed_ = false;
    std::deque<int> accepted_;
    int nextChannel_ = 0;
    Channel channels_[LINK_CHANNELS];
    std::unique_ptr<Link> link_;
    std::vector<U8> serialOut_; // of a frame, not yet taken by the port
    FramePacer pacer_;
    U32 upAt_ = 0, patienceUs_ = 0; // when the link was up last; how long it may be down
    mutable std::mutex mutex_;
    std::thread thread_;
};

} // namespace XBeeAT

#endif
