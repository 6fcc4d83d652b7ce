// SPDX-License-Identifier: MIT
//
// relay: stands between a client and a server on 127.0.0.1; can record, slow down and cut.
//
//   relay [--pcap file] [--slow bytes] [--cut bytes] PORT     prints its own port, runs until
//   killed
//
// --pcap  every byte as TCP over IPv4, with openings and ends, as a capture would hold it
// --slow  hands on so many bytes at a time, a millisecond apart, in both directions
// --cut   every connection ends, without a word, when so many bytes have passed

#include <arpa/inet.h>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <list>
#include <netinet/tcp.h>
#include <poll.h>
#include <stdexcept>
#include <string>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>
#include <vector>

namespace {

using Bytes = std::vector<uint8_t>;

void put(Bytes& to, uint64_t value, int bytes) { // big-endian
    while (bytes--)
        to.push_back(static_cast<uint8_t>(value >> (8 * bytes)));
}

// One TCP connection in a pcap file (LINKTYPE_IPV4).
class Capture {
public:
    explicit Capture(const std::string& file) {
        if (file.empty())
            return;
        out_.open(file, std::ios::binary);
        if (!out_)
            throw std::runtime_error("cannot write " + file);
        const uint32_t head[] = {0xA1B2C3D4, 0x00040002, 0, 0, 0xFFFF, 228};
        out_.write(reinterpret_cast<const char*>(head), sizeof head);
    }
    // direction 0: from the client. sequence: of both sides, advanced here.
    void packet(uint16_t client, uint16_t server, uint32_t (&sequence)[2], int direction,
                uint8_t flags, const uint8_t* data, size_t size) {
        enum : uint8_t { FIN = 1, SYN = 2 };
        if (!out_.is_open())
            return;
        Bytes p;
        put(p, 0x4500, 2);
        put(p, 40 + size, 2);
        put(p, 0x0000400040060000, 8); // do not fragment, 64 hops, TCP, no checksum
        put(p, direction ? 0x7F000002 : 0x7F000001, 4);
        put(p, direction ? 0x7F000001 : 0x7F000002, 4);
        put(p, direction ? server : client, 2);
        put(p, direction ? client : server, 2);
        put(p, sequence[direction], 4);
        put(p, sequence[1 - direction], 4);
        put(p, 0x50, 1);
        put(p, flags, 1);
        put(p, 0xFFFF00000000, 6); // window, no checksum, nothing urgent
        p.insert(p.end(), data, data + size);
        sequence[direction] += static_cast<uint32_t>(size) + ((flags & (SYN | FIN)) != 0);
        timeval now;
        gettimeofday(&now, nullptr);
        const uint32_t head[] = {static_cast<uint32_t>(now.tv_sec),
                                 static_cast<uint32_t>(now.tv_usec),
                                 static_cast<uint32_t>(p.size()), static_cast<uint32_t>(p.size())};
        out_.write(reinterpret_cast<const char*>(head), sizeof head);
        out_.write(reinterpret_cast<const char*>(p.data()), static_cast<std::streamsize>(p.size()));
        out_.flush();
    }

private:
    std::ofstream out_;
};

struct Connection {
    int fd[2]; // client's, server's
    uint16_t clientPort, serverPort;
    uint32_t sequence[2] = {1000, 2000};
    size_t passed = 0;
};

int open(uint16_t port, bool listens) {
    int fd = socket(AF_INET, SOCK_STREAM, 0), on = 1;
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    at.sin_port = htons(port);
    auto* address = reinterpret_cast<sockaddr*>(&at);
    setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    if (listens ? bind(fd, address, sizeof at) || listen(fd, 16) : connect(fd, address, sizeof at))
        throw std::runtime_error("port " + std::to_string(port) + " does not answer");
    return fd;
}

uint16_t portOf(int fd) {
    sockaddr_in at{};
    socklen_t size = sizeof at;
    getsockname(fd, reinterpret_cast<sockaddr*>(&at), &size);
    return ntohs(at.sin_port);
}

// Hands on what came. False: this connection is over.
bool handOn(Connection& c, int from, size_t slow, size_t cut, Capture& capture) {
    uint8_t data[4096];
    ssize_t got = recv(c.fd[from], data, slow ? slow : sizeof data, 0);
    if (got <= 0) {
        capture.packet(c.clientPort, c.serverPort, c.sequence, from, 0x11, nullptr, 0);
        return false;
    }
    c.passed += static_cast<size_t>(got);
    if (cut && c.passed > cut)
        return false;
    capture.packet(c.clientPort, c.serverPort, c.sequence, from, 0x18, data,
                   static_cast<size_t>(got));
    if (slow)
        usleep(1000);
    for (ssize_t at = 0, sent; at < got; at += sent) {
        sent = send(c.fd[1 - from], data + at, static_cast<size_t>(got - at), MSG_NOSIGNAL);
        if (sent <= 0)
            return false;
    }
    return true;
}

} // namespace

int main(int argc, char** argv) try {
    std::string file;
    size_t slow = 0, cut = 0;
    uint16_t port = 0;
    for (int i = 1; i < argc; ++i) {
        std::string a = argv[i];
        if (a == "--pcap" && i + 1 < argc)
            file = argv[++i];
        else if (a == "--slow" && i + 1 < argc)
            slow = std::stoul(argv[++i]);
        else if (a == "--cut" && i + 1 < argc)
            cut = std::stoul(argv[++i]);
        else
            port = static_cast<uint16_t>(std::stoul(a));
    }
    if (!port) {
        fprintf(stderr, "usage: relay [--pcap file] [--slow bytes] [--cut bytes] PORT\n");
        return 2;
    }
    Capture capture(file);
    int listener = open(0, true);
    printf("%d\n", portOf(listener));
    fflush(stdout);
    std::list<Connection> connections;
    for (;;) {
        std::vector<pollfd> wait = {{listener, POLLIN, 0}};
        for (auto& c : connections)
            for (int fd : c.fd)
                wait.push_back({fd, POLLIN, 0});
        poll(wait.data(), wait.size(), -1);
        size_t at = 1;
        for (auto c = connections.begin(); c != connections.end();) {
            bool alive = true;
            for (int side = 0; side < 2; ++side)
                if (wait[at++].revents && alive)
                    alive = handOn(*c, side, slow, cut, capture);
            if (!alive) {
                close(c->fd[0]);
                close(c->fd[1]);
                c = connections.erase(c);
            } else {
                ++c;
            }
        }
        if (wait[0].revents) {
            Connection c{{accept(listener, nullptr, nullptr), 0}, 0, port, {1000, 2000}, 0};
            c.fd[1] = open(port, false);
            c.clientPort = portOf(c.fd[1]);
            capture.packet(c.clientPort, port, c.sequence, 0, 0x02, nullptr, 0);
            capture.packet(c.clientPort, port, c.sequence, 1, 0x12, nullptr, 0);
            connections.push_back(c);
        }
    }
} catch (const std::exception& e) {
    fprintf(stderr, "relay: %s\n", e.what());
    return 1;
}
