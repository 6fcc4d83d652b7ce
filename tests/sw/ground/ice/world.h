// SPDX-License-Identifier: MIT
//
// world: connects stock Ice at both ends of the radio: a client with the plugin, the modems and the
// air of the rig, and a stock Ice server with the UAV's objects.

#pragma once

#include "../rig.h"
#include "Echo.h"
#include <Ice/Ice.h>
#include <arpa/inet.h>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <netinet/tcp.h>
#include <set>
#include <stdexcept>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

// Returns the communicator of a program with these properties.
inline Ice::CommunicatorPtr program(const std::map<std::string, std::string>& properties,
                                    Ice::InitializationData data = {}) {
    data.properties = Ice::createProperties();
    for (const auto& [name, value] : properties)
        data.properties->setProperty(name, value);
    return Ice::initialize(data);
}

// A server process; its output is read when a test asks for it.
class Server {
public:
    explicit Server(std::vector<std::string> arguments) {
        int ends[2];
        if (pipe2(ends, O_CLOEXEC) != 0)
            throw std::runtime_error("no pipe");
        std::vector<char*> argv;
        for (auto& argument : arguments)
            argv.push_back(argument.data());
        argv.push_back(nullptr);
        pid_ = fork();
        if (pid_ == 0) {
            prctl(PR_SET_PDEATHSIG, SIGKILL); // if the test is killed, the server ends too
            dup2(ends[1], 1);
            dup2(ends[1], 2);
            close_range(3, ~0u, 0); // otherwise the server would inherit the sockets of Ice
            execvp(argv[0], argv.data());
            _exit(127);
        }
        close(ends[1]);
        out_ = ends[0];
    }
    ~Server() {
        if (pid_ > 0)
            stop();
        close(out_);
    }
    // Returns the port that the server prints between these words, or -1 if the server ended
    // without printing a port.
    int port(const std::string& before = "gateway: port ", const std::string& after = " leads") {
        if (!hear(before))
            return -1;
        const size_t at = heard_;
        return hear(after) ? std::atoi(said_.c_str() + at) : -1;
    }
    // Ends the server. Returns its exit status; -1 if a signal killed it.
    int stop() {
        kill(pid_, SIGINT);
        return wait();
    }
    int wait() {
        while (read())
            ;
        int status = 0;
        waitpid(pid_, &status, 0);
        pid_ = 0;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    pid_t pid() const { return pid_; }
    const std::string& said() const { return said_; }
    // Reads output until `text` occurs (again). Returns false if the program ends before that.
    bool hear(const std::string& text) {
        size_t at;
        while ((at = said_.find(text, heard_)) == std::string::npos)
            if (!read())
                return false;
        heard_ = at + text.size();
        return true;
    }

private:
    bool read() {
        char bytes[512];
        ssize_t count = ::read(out_, bytes, sizeof bytes);
        if (count > 0)
            said_.append(bytes, static_cast<size_t>(count));
        return count > 0;
    }
    pid_t pid_ = 0;
    int out_ = -1;
    std::string said_;
    size_t heard_ = 0; // position in said_ up to which hear() has read
};

// Connects the link of the rig's UAV to an Ice server on 127.0.0.1. Each channel of the link
// becomes a connection to the server; a connection from the server to the ground uses channel 3.
// This class runs in the rig's thread.
class Relay {
public:
    // `server` is the TCP port of the server with the UAV's objects.
    Relay(Rig& rig, int server) : rig_(rig), server_(server) {
        listener_ = socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
        sockaddr_in any = local(0);
        socklen_t size = sizeof any;
        if (bind(listener_, reinterpret_cast<sockaddr*>(&any), size) != 0 ||
            listen(listener_, 4) != 0 ||
            getsockname(listener_, reinterpret_cast<sockaddr*>(&any), &size) != 0)
            throw std::runtime_error("relay: no TCP port");
        port_ = ntohs(any.sin_port);
        rig_.with([this] {
            rig_.uav.taking = [this](int channel, const U8* data, U32 count) {
                return take(lines_[channel], data, count);
            };
            rig_.uav.opening = [this](int channel, bool isOpen) { opening(channel, isOpen); };
            rig_.step = [this] { step(); };
        });
    }
    ~Relay() {
        rig_.with([this] {
            rig_.uav.taking = nullptr;
            rig_.uav.opening = nullptr;
            rig_.step = nullptr;
        });
        for (Line& line : lines_)
            end(line);
        close(listener_);
    }
    Relay(const Relay&) = delete;
    Relay& operator=(const Relay&) = delete;

    // port to which the UAV's server connects to reach the ground
    int port() const { return port_; }

private:
    static constexpr int ownChannel = 3;
    struct Line {
        int fd = -1;
        // in: bytes from TCP that do not form a complete message yet; out: bytes that must still be
        // written to TCP
        Rig::Bytes in, out;
    };

    static sockaddr_in local(int port) {
        sockaddr_in a{};
        a.sin_family = AF_INET;
        a.sin_port = htons(static_cast<uint16_t>(port));
        a.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        return a;
    }
    static void end(Line& line) {
        if (line.fd >= 0)
            close(line.fd);
        line = Line();
    }
    static void begin(Line& line, int fd) {
        int yes = 1;
        setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
        fcntl(fd, F_SETFL, O_NONBLOCK);
        line.fd = fd;
    }
    void opening(int channel, bool isOpen) {
        Line& line = lines_[channel];
        end(line);
        if (!isOpen)
            return;
        int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
        sockaddr_in to = local(server_);
        if (connect(fd, reinterpret_cast<sockaddr*>(&to), sizeof to) == 0)
            begin(line, fd);
        else
            close(fd);
    }
    static int take(Line& line, const U8* data, U32 count) {
        if (line.out.size() > 32768)
            return 1; // the server is slow, so the link delivers the message again later
        if (line.fd >= 0)
            line.out.insert(line.out.end(), data, data + count);
        return 0;
    }
    void step() {
        if (lines_[ownChannel].fd < 0) {
            int fd = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
            if (fd >= 0 && Link_openChannel(rig_.uav.link(), ownChannel) == LINK_OK)
                begin(lines_[ownChannel], fd);
            else if (fd >= 0)
                close(fd);
        }
        for (int channel = 0; channel < LINK_CHANNELS; ++channel) {
            Line& line = lines_[channel];
            if (line.fd >= 0 && !(move(line) && sendMessages(channel))) {
                Link_closeChannel(rig_.uav.link(), channel);
                end(line);
            }
        }
    }
    // Reads and writes bytes of the socket. Returns false if the connection has ended.
    static bool move(Line& line) {
        if (!line.out.empty()) {
            ssize_t count = send(line.fd, line.out.data(), line.out.size(), MSG_NOSIGNAL);
            if (count > 0)
                line.out.erase(line.out.begin(), line.out.begin() + count);
        }
        if (line.in.size() > 32768)
            return true;
        U8 bytes[4096];
        ssize_t count = recv(line.fd, bytes, sizeof bytes, 0);
        line.in.insert(line.in.end(), bytes, bytes + std::max<ssize_t>(count, 0));
        return count > 0 || (count < 0 && errno == EAGAIN);
    }
    bool sendMessages(int channel) {
        Rig::Bytes& in = lines_[channel].in;
        while (in.size() >= 14) {
            U32 size = static_cast<U32>(in[10] | in[11] << 8 | in[12] << 16 | in[13] << 24);
            if (in.size() < size)
                return true;
            Link_Status status = Link_send(rig_.uav.link(), channel, in.data(), size, 0);
            if (status != LINK_OK)
                return status == LINK_FULL;
            in.erase(in.begin(), in.begin() + size);
        }
        return true;
    }

    Rig& rig_;
    int server_, listener_ = -1, port_ = 0;
    Line lines_[LINK_CHANNELS];
};

class EchoServant : public RadioTest::Uav {
public:
    RadioTest::Bytes repeat(int id, RadioTest::Bytes data, const Ice::Current&) override {
        std::lock_guard<std::mutex> lock(mutex_);
        twice_ += !seen_.insert(id).second;
        return data;
    }
    void note(int id, const Ice::Current&) override {
        std::lock_guard<std::mutex> lock(mutex_);
        twice_ += !seen_.insert(id).second;
        ++noted_;
    }
    void take(int id, RadioTest::Bytes, const Ice::Current& current) override { note(id, current); }
    RadioTest::Bytes fetch(int size, const Ice::Current&) override {
        return RadioTest::Bytes(static_cast<size_t>(size));
    }
    int noted(const Ice::Current&) override {
        std::lock_guard<std::mutex> lock(mutex_);
        return noted_;
    }
    int callBack(int times, const Ice::Current& current) override {
        auto listener = Ice::uncheckedCast<RadioTest::ListenerPrx>(
            current.con->createProxy(Ice::stringToIdentity("listener")));
        return sum(listener, times);
    }
    int callStation(int times, const Ice::Current& current) override {
        return sum(Ice::uncheckedCast<RadioTest::ListenerPrx>(
                       current.adapter->getCommunicator()->stringToProxy(station)),
                   times);
    }
    // Returns the number of calls that were executed more than once.
    int twice() {
        std::lock_guard<std::mutex> lock(mutex_);
        return twice_;
    }
    std::string station;

private:
    static int sum(const std::shared_ptr<RadioTest::ListenerPrx>& listener, int times) {
        int total = 0;
        for (int i = 0; i < times; ++i)
            total += listener->heard(i);
        return total;
    }
    std::mutex mutex_;
    std::set<int> seen_;
    int noted_ = 0, twice_ = 0;
};

class ListenerServant : public RadioTest::Listener {
public:
    int heard(int number, const Ice::Current&) override { return 2 * number; }
};

class World {
public:
    explicit World(uint64_t seed) : rig(seed) {
        server_ = program({{"Ice.ThreadPool.Server.Size", "4"}, {"Ice.Warn.Connections", "0"}});
        uav = server_->createObjectAdapterWithEndpoints("Uav", "tcp -h 127.0.0.1");
        uav->add(echo, Ice::stringToIdentity("echo"));
        uav->activate();
        uavPort = std::dynamic_pointer_cast<Ice::TCPEndpointInfo>(uav->getEndpoints()[0]->getInfo())
                      ->port;
        relay = std::make_unique<Relay>(rig, uavPort);
        echo->station = "station:tcp -h 127.0.0.1 -t 1800000 -p " + std::to_string(relay->port());
    }
    ~World() { server_->destroy(); }

    // Returns the communicator of a program on the ground. Several communicators share the engine
    // of the serial port.
    Ice::CommunicatorPtr client(std::map<std::string, std::string> more = {},
                                const Ice::InitializationData& data = {}) {
        more.insert({{"Ice.Plugin.XBeeAT", PLUGIN_FOLDER "/xbeeat:createXBeeAT"},
                     {"Ice.Default.InvocationTimeout", "1800000"},
                     {"Ice.RetryIntervals", "-1"}, // a call is made only once, even if it fails
                     {"Ice.ThreadPool.Client.Size", "4"},
                     {"Ice.Warn.Connections", "0"},
                     {"XBeeAT.Guard", std::to_string(Rig::guardMs)},
                     {"XBeeAT.Down", "1"}});
        return program(more, data);
    }
    std::string endpoint() const { return "xbee-at -t 1800000 -d " + rig.pty.path(); }
    std::shared_ptr<RadioTest::UavPrx> proxy(const Ice::CommunicatorPtr& ic,
                                             const std::string& connection = "") {
        return Ice::uncheckedCast<RadioTest::UavPrx>(
            ic->stringToProxy("echo:" + endpoint())->ice_connectionId(connection));
    }
    static RadioTest::Bytes pattern(int id, size_t size) {
        RadioTest::Bytes bytes(size);
        for (size_t i = 0; i < size; ++i)
            bytes[i] = static_cast<Ice::Byte>(i * 7 + static_cast<size_t>(id) * 31);
        return bytes;
    }

    Rig rig;
    std::shared_ptr<EchoServant> echo = std::make_shared<EchoServant>();
    std::shared_ptr<Ice::ObjectAdapter> uav;
    int uavPort = 0; // TCP port of the UAV's server
    std::unique_ptr<Relay> relay;

private:
    Ice::CommunicatorPtr server_;
};
