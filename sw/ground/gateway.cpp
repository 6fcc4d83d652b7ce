// SPDX-License-Identifier: MIT
//
// gateway: TCP to radio. Ice programs in any language and of any version reach the UAV's objects at
// this machine's TCP port, several at a time, and the UAV reaches a server here. It links to no
// Ice.
//
// It handles the sockets; the engine moves the bytes.

#include "engine.h"

#include <CLI/CLI.hpp>
#include <arpa/inet.h>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <iostream>
#include <netdb.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <system_error>
#include <unistd.h>

namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::seconds;

volatile sig_atomic_t stopSignal = 0;

constexpr size_t mostWaiting = 256;   // clients without a channel
constexpr seconds stationPatience{5}; // how long the UAV waits for the station to accept

struct Options {
    XBeeAT::Settings serial;
    std::string listen = "127.0.0.1:10000", station, keyFile, modemKeyFile;
    int trace = 0, statistics = 0, idle = 60, wait = 30, vanished = 30;
};

struct Address {
    sockaddr_storage bytes{};
    socklen_t size = 0;
};

Address resolve(const std::string& text) {
    const size_t colon = text.rfind(':');
    if (colon == std::string::npos)
        throw std::runtime_error("'" + text + "': give HOST:PORT");
    const std::string port = text.substr(colon + 1);
    const bool isNumber = port.find_first_not_of("0123456789") == std::string::npos;
    // getaddrinfo would take it modulo 65536.
    if (isNumber && (port.empty() || port.size() > 5 || std::stoul(port) > 65535))
        throw std::runtime_error("'" + text + "': a port is 0 to 65535");
    addrinfo hints{}, *found = nullptr;
    hints.ai_socktype = SOCK_STREAM;
    std::string host = text.substr(0, colon);
    if (host.size() > 2 && host.front() == '[' && host.back() == ']') // as in URLs: [::1]:10000
        host = host.substr(1, host.size() - 2);
    int error = getaddrinfo(host.c_str(), port.c_str(), &hints, &found);
    if (error != 0)
        throw std::runtime_error("'" + text + "': " + gai_strerror(error));
    Address address;
    std::memcpy(&address.bytes, found->ai_addr, found->ai_addrlen);
    address.size = found->ai_addrlen;
    freeaddrinfo(found);
    return address;
}

// Small buffers let back-pressure reach the program. Keep-alive or missing acknowledgements reveal
// after these seconds a peer that has vanished.
void prepare(int fd, int vanished) {
    auto set = [fd](int level, int name, int value) {
        setsockopt(fd, level, name, &value, sizeof value);
    };
    set(SOL_SOCKET, SO_SNDBUF, 8192);
    set(SOL_SOCKET, SO_RCVBUF, 8192);
    set(IPPROTO_TCP, TCP_NODELAY, 1);
    set(SOL_SOCKET, SO_KEEPALIVE, 1);
    set(IPPROTO_TCP, TCP_KEEPIDLE, vanished / 2);
    set(IPPROTO_TCP, TCP_KEEPINTVL, vanished / 6);
    set(IPPROTO_TCP, TCP_KEEPCNT, 3);
    set(IPPROTO_TCP, TCP_USER_TIMEOUT, 1000 * vanished);
}

int newSocket(const Address& address, int vanished) {
    int fd = socket(address.bytes.ss_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (fd >= 0)
        prepare(fd, vanished);
    return fd;
}

int listenAt(const std::string& where, int vanished) {
    Address address = resolve(where);
    int fd = newSocket(address, vanished), yes = 1;
    setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    if (fd < 0 || bind(fd, reinterpret_cast<sockaddr*>(&address.bytes), address.size) != 0 ||
        listen(fd, SOMAXCONN) != 0)
        throw std::system_error(errno, std::generic_category(), "cannot listen at " + where);
    return fd;
}

unsigned portOf(int fd) {
    sockaddr_storage name{};
    socklen_t size = sizeof name;
    getsockname(fd, reinterpret_cast<sockaddr*>(&name), &size);
    return ntohs(name.ss_family == AF_INET6 ? reinterpret_cast<sockaddr_in6&>(name).sin6_port
                                            : reinterpret_cast<sockaddr_in&>(name).sin_port);
}

class Gateway {
public:
    explicit Gateway(const Options& options) : options_(options) {
        listener_ = listenAt(options.listen, options.vanished);
        if (!options.station.empty())
            station_ = resolve(options.station);
        engine_ = XBeeAT::Engine::get(options.serial, [this](int level, const std::string& text) {
            if (level <= options_.trace)
                std::cerr << "gateway: " + text + "\n";
        });
        if (!options_.station.empty())
            radioCalls_ = engine_->listen();
        std::cout << "gateway: port " << portOf(listener_) << " leads to the UAV behind "
                  << engine_->device() << std::endl;
    }
    ~Gateway() {
        close(listener_);
        close(toStation_);
        sayStatistics();
    }
    Gateway(const Gateway&) = delete;
    Gateway& operator=(const Gateway&) = delete;

    void run() {
        for (auto due = Clock::now() + seconds(options_.statistics); !stopSignal;) {
            wait();
            acceptClients();
            callStation();
            if (options_.statistics > 0 && Clock::now() >= due) {
                due += seconds(options_.statistics);
                sayStatistics();
            }
        }
    }

private:
    void sayStatistics() { std::cout << "gateway: " + engine_->statistics() + "\n" << std::flush; }
    void complain(const std::string& text) { std::cerr << "gateway: " + text + "\n"; }

    void wait() {
        const bool isFull = engine_->waiting() >= mostWaiting;
        pollfd fds[] = {{isFull ? -1 : listener_, POLLIN, 0},
                        {toStation_ < 0 ? radioCalls_ : -1, POLLIN, 0},
                        {toStation_, POLLOUT, 0}};
        poll(fds, 3, isFull || toStation_ >= 0 ? 50 : 1000);
        isCalled_ = fds[1].revents != 0;
        isAnswered_ = fds[2].revents != 0;
    }
    void acceptClients() {
        while (engine_->waiting() < mostWaiting) {
            int fd = accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
            if (fd < 0) {
                noteFull(errno);
                return;
            }
            prepare(fd, options_.vanished);
            engine_->connect(fd, "client " + std::to_string(++count_));
        }
    }
    // Records that descriptors are used up: the listener stays readable without them.
    void noteFull(int error) {
        if (error == EAGAIN || error == EINTR || error == ECONNABORTED)
            return;
        complain(std::string("cannot accept a client: ") + std::strerror(error));
        poll(nullptr, 0, 500);
    }
    // The UAV's call, in two steps: the station may be far away.
    void callStation() {
        if (isCalled_) {
            toStation_ = newSocket(station_, options_.vanished);
            stationDue_ = Clock::now() + stationPatience;
            if (toStation_ < 0 || (connect(toStation_, reinterpret_cast<sockaddr*>(&station_.bytes),
                                           station_.size) != 0 &&
                                   errno != EINPROGRESS))
                return refuse(errno);
        } else if (isAnswered_) {
            int error = 0;
            socklen_t size = sizeof error;
            getsockopt(toStation_, SOL_SOCKET, SO_ERROR, &error, &size);
            if (error != 0)
                return refuse(error);
            engine_->accept(toStation_, "the UAV");
            toStation_ = -1;
        } else if (toStation_ >= 0 && Clock::now() >= stationDue_) {
            refuse(ETIMEDOUT);
        }
    }
    void refuse(int error) {
        complain("the UAV calls, and nobody listens at " + options_.station + ": " +
                 std::strerror(error));
        if (toStation_ >= 0)
            close(toStation_);
        toStation_ = -1;
        engine_->refuse();
    }

    Options options_;
    std::shared_ptr<XBeeAT::Engine> engine_;
    Address station_;
    int listener_ = -1, radioCalls_ = -1, toStation_ = -1;
    bool isCalled_ = false, isAnswered_ = false;
    Clock::time_point stationDue_;
    unsigned count_ = 0;
};

// Reads the modem's key from a file, since every user of the machine can read the command line.
std::string readModemKey(const std::string& path) {
    std::string key = XBeeAT::readSecret(path);
    key.erase(key.find_last_not_of(" \n") + 1);
    if (key.empty() || key.size() > 32 ||
        key.find_first_not_of("0123456789abcdefABCDEF") != std::string::npos)
        throw std::runtime_error("the modem's AES key in '" + path +
                                 "' must be 1 to 32 hexadecimal digits");
    return key;
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app{
        "TCP to radio: Ice programs reach the UAV's objects at a TCP port, e.g. by the proxy\n"
        "\"hwengine1:tcp -h 127.0.0.1 -p 10000\". Three connections at a time; more wait."};
    Options o;
    XBeeAT::Settings& s = o.serial;
    app.add_option("-d,--device", s.device, "serial port of the modem")->required();
    app.add_option("-b,--baud", s.baud, "baud rate (115200 is the modem's BD 7)")
        ->check(CLI::IsMember({1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200}));
    app.add_option("-a,--address", s.target, "the UAV's 16-bit address")
        ->check(CLI::Range(0, 0xFFFF));
    app.add_option("-s,--source", s.source, "own 16-bit address")->check(CLI::Range(0, 0xFFFF));
    app.add_option("-c,--channel", s.rfChannel, "RF channel")->check(CLI::Range(0x0B, 0x1A));
    app.add_option("-i,--pan", s.pan, "network id")->check(CLI::Range(0, 0xFFFF));
    app.add_option(
        "--key", o.keyFile,
        "file (mode 0600) with the vehicle's key, 32 hexadecimal digits, or a line "
        "\"0x0001 KEY\" for each vehicle; /dev/fd/3: a descriptor. Without: in the clear");
    app.add_option("--modem-key", o.modemKeyFile,
                   "file (mode 0600) with the modems' AES key, up to 32 hexadecimal digits");
    app.add_option("-g,--guard", s.guardMs, "guard time of the modem as it is, ms")
        ->check(CLI::Range(2, 3300));
    app.add_flag("!--no-setup", s.setUp, "the modem is set up already");
    app.add_option("-l,--listen", o.listen,
                   "HOST:PORT for clients, [::1]:PORT too; port 0: any, it is printed");
    app.add_option("--station", o.station, "HOST:PORT of the Ice server that the UAV calls");
    app.add_option("--idle", o.idle,
                   "seconds of silence after which a client makes room for one that waits")
        ->check(CLI::Range(1, 3600));
    app.add_option("--wait", o.wait,
                   "seconds that a client waits for one of the three channels, then is turned away")
        ->check(CLI::Range(1, 3600));
    app.add_option("--vanished", o.vanished,
                   "seconds after which a client that has vanished without a word is given up")
        ->check(CLI::Range(6, 3600));
    app.add_option("-t,--trace", o.trace, "0 errors, 1 link and connections, 2 AT commands")
        ->check(CLI::Range(0, 2));
    app.add_option("--statistics", o.statistics, "print a line about every so many seconds")
        ->check(CLI::Range(0, 86400));
    CLI11_PARSE(app, argc, argv);
    struct sigaction action{};
    action.sa_handler = [](int signal) { stopSignal = signal; };
    for (int signal : {SIGINT, SIGTERM, SIGHUP})
        sigaction(signal, &action, nullptr);
    try {
        s.idleMs = o.idle * 1000;
        s.waitMs = o.wait * 1000;
        if (!o.keyFile.empty())
            s.keys = XBeeAT::KeyFile(o.keyFile).of(s.target);
        if (!o.modemKeyFile.empty())
            s.modemKey = readModemKey(o.modemKeyFile);
        Gateway(o).run();
    } catch (const std::exception& e) {
        std::cerr << "gateway: error: " << e.what() << "\n";
        return 1;
    }
    return 0;
}
