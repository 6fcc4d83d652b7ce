// SPDX-License-Identifier: MIT
//
// gateway: TCP to radio. Ice programs in any language and of any version reach the UAV's objects at
// this machine's TCP port, several at a time, and the UAV reaches a server here. It links to no
// Ice.

#include "engine.h"

#include <CLI/CLI.hpp>
#include <arpa/inet.h>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <iostream>
#include <list>
#include <netdb.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <system_error>
#include <unistd.h>

namespace {

volatile sig_atomic_t stopSignal = 0;

struct Options {
    XBeeAT::Settings serial;
    std::string listen = "127.0.0.1:10000", station;
    int trace = 0, statistics = 0;
};

struct Address {
    sockaddr_storage bytes{};
    socklen_t size = 0;
};

Address resolve(const std::string& text) {
    size_t colon = text.rfind(':');
    if (colon == std::string::npos)
        throw std::runtime_error("'" + text + "': give HOST:PORT");
    addrinfo hints{}, *found = nullptr;
    hints.ai_socktype = SOCK_STREAM;
    int error =
        getaddrinfo(text.substr(0, colon).c_str(), text.substr(colon + 1).c_str(), &hints, &found);
    if (error != 0)
        throw std::runtime_error("'" + text + "': " + gai_strerror(error));
    Address address;
    std::memcpy(&address.bytes, found->ai_addr, found->ai_addrlen);
    address.size = found->ai_addrlen;
    freeaddrinfo(found);
    return address;
}

int listenAt(const std::string& where) {
    Address address = resolve(where);
    int fd = socket(address.bytes.ss_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    int yes = 1;
    setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    if (fd < 0 || bind(fd, reinterpret_cast<sockaddr*>(&address.bytes), address.size) != 0 ||
        listen(fd, 16) != 0)
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

// Bytes in one direction, at most a buffer of them under way: back-pressure reaches the writer.
class Pipe {
public:
    Pipe(int from, int to) : from_(from), to_(to) {}
    bool wantsIn() const { return !ended_ && count_ == 0; }
    bool wantsOut() const { return count_ > 0; }
    // False: the connection is over.
    bool move() {
        if (wantsIn()) {
            ssize_t got = recv(from_, bytes_, sizeof bytes_, 0);
            if (got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR))
                ended_ = true;
            begin_ = 0;
            count_ = got > 0 ? static_cast<size_t>(got) : 0;
        }
        if (wantsOut()) {
            ssize_t put = send(to_, bytes_ + begin_, count_, MSG_NOSIGNAL);
            if (put < 0 && errno != EAGAIN && errno != EINTR)
                return false;
            begin_ += put > 0 ? static_cast<size_t>(put) : 0;
            count_ -= put > 0 ? static_cast<size_t>(put) : 0;
        }
        return !(ended_ && count_ == 0);
    }

private:
    int from_, to_;
    bool ended_ = false;
    char bytes_[4096];
    size_t begin_ = 0, count_ = 0;
};

// A TCP connection and a channel of the link.
struct Session {
    Session(int client, int channel, std::string who)
        : tcp(client), radio(channel), name(std::move(who)) {}
    ~Session() {
        close(tcp);
        close(radio);
    }
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;
    int tcp, radio;
    std::string name;
    Pipe up{tcp, radio}, down{radio, tcp};
};

class Gateway {
public:
    explicit Gateway(const Options& options) : options_(options) {
        tcp_ = listenAt(options.listen);
        if (!options.station.empty())
            station_ = resolve(options.station);
        openRadio();
        std::cout << "gateway: port " << portOf(tcp_) << " leads to the UAV behind "
                  << engine_->device() << std::endl;
    }
    ~Gateway() {
        sessions_.clear();
        close(tcp_);
        std::cout << "gateway: " << engine_->statistics() << std::endl;
    }
    Gateway(const Gateway&) = delete;
    Gateway& operator=(const Gateway&) = delete;

    void run() {
        int said = 0;
        while (!stopSignal) {
            wait();
            acceptClient();
            acceptUav();
            for (auto it = sessions_.begin(); it != sessions_.end();) {
                bool up = it->up.move(), down = it->down.move();
                if (!up || !down)
                    say(it->name + " has ended");
                it = up && down ? std::next(it) : sessions_.erase(it);
            }
            if (options_.statistics > 0 && ++said >= options_.statistics) {
                said = 0;
                std::cout << "gateway: " << engine_->statistics() << std::endl;
            }
        }
    }

private:
    void openRadio() {
        engine_ = XBeeAT::Engine::get(options_.serial, [this](int level, const std::string& text) {
            if (level <= options_.trace)
                std::cerr << "gateway: " << text << std::endl;
        });
        if (!options_.station.empty())
            radioCalls_ = engine_->listen();
    }
    void say(const std::string& text) {
        if (options_.trace > 0)
            std::cerr << "gateway: " << text << std::endl;
    }
    void wait() {
        // A client that finds all channels taken waits in the listener's queue.
        bool room = !lastRefused_; // else look again in a second
        std::vector<pollfd> fds = {{room ? tcp_ : -1, POLLIN, 0}, {radioCalls_, POLLIN, 0}};
        for (Session& s : sessions_) {
            fds.push_back({s.tcp, events(s.up, s.down), 0});
            fds.push_back({s.radio, events(s.down, s.up), 0});
        }
        if (poll(fds.data(), fds.size(), 1000) == 0 || sessions_.size() < 3)
            lastRefused_ = false;
    }
    static short events(const Pipe& from, const Pipe& to) {
        return static_cast<short>((from.wantsIn() ? POLLIN : 0) | (to.wantsOut() ? POLLOUT : 0));
    }
    void acceptClient() {
        pollfd ready{tcp_, POLLIN, 0};
        if (poll(&ready, 1, 0) <= 0)
            return;
        int radio = engine_->connect(-1);
        lastRefused_ = radio < 0;
        if (lastRefused_)
            return;
        sockaddr_storage peer{};
        socklen_t size = sizeof peer;
        int fd =
            accept4(tcp_, reinterpret_cast<sockaddr*>(&peer), &size, SOCK_NONBLOCK | SOCK_CLOEXEC);
        if (fd < 0) {
            close(radio);
            return;
        }
        add(fd, radio, "client " + std::to_string(++count_));
    }
    void acceptUav() {
        pollfd ready{radioCalls_, POLLIN, 0};
        if (radioCalls_ < 0 || poll(&ready, 1, 0) <= 0)
            return;
        int radio = engine_->accept();
        if (radio < 0)
            return;
        int fd = socket(station_.bytes.ss_family, SOCK_STREAM | SOCK_CLOEXEC, 0);
        if (fd < 0 ||
            connect(fd, reinterpret_cast<sockaddr*>(&station_.bytes), station_.size) != 0) {
            std::cerr << "gateway: the UAV calls, and nobody listens at " << options_.station
                      << ": " << std::strerror(errno) << std::endl;
            close(fd);
            close(radio);
            return;
        }
        fcntl(fd, F_SETFL, O_NONBLOCK);
        add(fd, radio, "the UAV");
    }
    void add(int fd, int radio, const std::string& name) {
        int yes = 1;
        setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
        sessions_.emplace_back(fd, radio, name);
        say(name + " is connected");
    }

    Options options_;
    std::shared_ptr<XBeeAT::Engine> engine_;
    Address station_;
    int tcp_ = -1, radioCalls_ = -1;
    bool lastRefused_ = false;
    unsigned count_ = 0;
    std::list<Session> sessions_;
};

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
    app.add_option("-k,--key", s.key, "AES key, up to 32 hexadecimal digits");
    app.add_option("-g,--guard", s.guardMs, "guard time of the modem as it is, ms")
        ->check(CLI::Range(2, 3300));
    app.add_flag("!--no-setup", s.setUp, "the modem is set up already");
    app.add_option("-l,--listen", o.listen, "HOST:PORT for clients; port 0: any, it is printed");
    app.add_option("--station", o.station, "HOST:PORT of the Ice server that the UAV calls");
    app.add_option("-t,--trace", o.trace, "0 errors, 1 link and connections, 2 AT commands")
        ->check(CLI::Range(0, 2));
    app.add_option("--statistics", o.statistics, "print a line about every so many seconds");
    CLI11_PARSE(app, argc, argv);
    struct sigaction action {};
    action.sa_handler = [](int signal) { stopSignal = signal; };
    for (int signal : {SIGINT, SIGTERM, SIGHUP})
        sigaction(signal, &action, nullptr);
    try {
        Gateway(o).run();
    } catch (const std::exception& e) {
        std::cerr << "gateway: error: " << e.what() << "\n";
        return 1;
    }
    return 0;
}
