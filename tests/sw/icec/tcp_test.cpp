// SPDX-License-Identifier: MIT
//
// tcp_test: tests IceC's tcp transport with many peers at the same time, with silent, dead or
// greedy peers, and with peers that close a silent connection (Ice 3.8).

#include "icec_pair.h"

#include <arpa/inet.h>
#include <atomic>
#include <chrono>
#include <deque>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>

extern "C" {
#include "tcp_private.h"
}

namespace {

using Clock = std::chrono::steady_clock;

int msSince(Clock::time_point begin) {
    return static_cast<int>(
        std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - begin).count());
}

sockaddr_in local(int port) {
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_port = htons(static_cast<uint16_t>(port));
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return at;
}

// A peer that is not an Ice program: a socket, with functions that write and read bytes.
class RawSocket {
public:
    explicit RawSocket(int port) : fd_(socket(AF_INET, SOCK_STREAM, 0)) {
        sockaddr_in at = local(port);
        fcntl(fd_, F_SETFL, O_NONBLOCK);
        (void)!connect(fd_, reinterpret_cast<sockaddr*>(&at), sizeof at);
    }
    explicit RawSocket(int listener, bool) : fd_(accept(listener, nullptr, nullptr)) {
        fcntl(fd_, F_SETFL, O_NONBLOCK);
    }
    RawSocket(const RawSocket&) = delete;
    ~RawSocket() { close(fd_); }
    bool isConnected(int ms) {
        pollfd wait{fd_, POLLOUT, 0};
        int error = 1;
        socklen_t size = sizeof error;
        return poll(&wait, 1, ms) == 1 &&
               getsockopt(fd_, SOL_SOCKET, SO_ERROR, &error, &size) == 0 && error == 0;
    }
    bool send(const Bytes& m) {
        return ::send(fd_, m.data(), m.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(m.size());
    }
    // Returns the next message, or an empty message if none arrives within `ms` or the connection
    // ends.
    Bytes receive(int ms) {
        Bytes m(14);
        if (!read(m.data(), 14, ms))
            return {};
        m.resize(static_cast<size_t>(m[10] | m[11] << 8));
        if (!read(m.data() + 14, m.size() - 14, ms))
            return {};
        return m;
    }

private:
    bool read(Ice_Byte* to, size_t size, int ms) {
        Clock::time_point begin = Clock::now();
        while (size > 0) {
            pollfd wait{fd_, POLLIN, 0};
            if (poll(&wait, 1, std::max(0, ms - msSince(begin))) != 1)
                return false;
            ssize_t got = recv(fd_, to, size, 0);
            if (got <= 0)
                return false;
            to += got;
            size -= static_cast<size_t>(got);
        }
        return true;
    }
    const int fd_;
};

// A server that is not an Ice program: it only listens for connections.
struct Listener {
    Listener() {
        sockaddr_in at = local(0);
        socklen_t size = sizeof at;
        EXPECT_EQ(bind(fd, reinterpret_cast<sockaddr*>(&at), size), 0);
        EXPECT_EQ(listen(fd, 1), 0);
        getsockname(fd, reinterpret_cast<sockaddr*>(&at), &size);
        proxy = "thing:tcp -p " + std::to_string(ntohs(at.sin_port));
    }
    ~Listener() { close(fd); }
    const int fd = socket(AF_INET, SOCK_STREAM, 0);
    std::string proxy;
};

Bytes replyTo(const Bytes& m) {
    return message(2, {m[14], m[15], m[16], m[17], 0, 6, 0, 0, 0, 1, 1});
}

class Tcp : public ::testing::Test {
protected:
    Tcp() : ic_(std::make_unique<Ice_Communicator>()), tcp_(std::make_unique<TcpEndpoint>()) {
        Ice_initialize(ic_.get());
        EXPECT_EQ(TcpEndpoint_init(ic_.get(), tcp_.get()), ICE_OK);
        EXPECT_EQ(
            Ice_Communicator_createObjectAdapterWithEndpoints(ic_.get(), "A", "tcp", &adapter_),
            ICE_OK);
        EXPECT_EQ(Ice_ObjectAdapter_add(&adapter_, &servant_.base, "thing"), ICE_OK);
        Ice_ObjectAdapter_activate(&adapter_);
    }
    ~Tcp() override {
        stop();
        TcpEndpoint_destroy(tcp_.get());
    }
    void stop() {
        stop_ = true;
        if (task_.joinable())
            task_.join();
    }
    void serve() {
        task_ = std::thread([this] {
            while (!stop_)
                (void)Ice_Communicator_poll(ic_.get(), 20);
        });
    }
    // Sends a ping and waits for the reply; heartbeats before the reply are skipped. Returns false
    // after a time-out.
    static bool ping(RawSocket& peer, int ms = 3000) {
        if (!peer.isConnected(ms) || !peer.send(request(7, requestBody("thing", "ice_ping"))))
            return false;
        for (;;) {
            Bytes m = peer.receive(ms);
            if (m.empty() || m[8] == 2)
                return !m.empty();
        }
    }
    int port() const { return tcp_->port; }
    Ice_ObjectPrx proxy(const Listener& to) {
        Ice_ObjectPrx prx;
        EXPECT_EQ(Ice_Communicator_stringToProxy(ic_.get(), to.proxy.c_str(), &prx), ICE_OK);
        return prx;
    }

    std::unique_ptr<Ice_Communicator> ic_;
    std::unique_ptr<TcpEndpoint> tcp_;
    Ice_ObjectAdapter adapter_;
    Servant servant_;
    std::atomic<bool> stop_{false};
    std::thread task_;
};

TEST_F(Tcp, AHundredClientsAtOnceAreServed) {
    std::deque<RawSocket> peers;
    for (int i = 0; i < 100; ++i)
        peers.emplace_back(port());
    for (RawSocket& peer : peers)
        ASSERT_TRUE(peer.isConnected(100))
            << "the operating system must keep connections until they are accepted";
    serve();
    while (!peers.empty()) { // peers that have been served disconnect, so that others can connect
        ASSERT_TRUE(ping(peers.front())) << peers.size() << " connections are still waiting";
        peers.pop_front();
    }
}

TEST_F(Tcp, AMessageMayArriveByteByByte) {
    RawSocket peer(port());
    ASSERT_TRUE(peer.isConnected(1000));
    for (int turn = 0; turn < 2; ++turn)
        for (Ice_Byte byte : request(7, requestBody("thing", "ice_ping"))) {
            ASSERT_TRUE(peer.send({byte}));
            (void)Ice_Communicator_poll(ic_.get(), 1000);
        }
    serve(); // this call of serve() reads the last byte; the call before it accepted the connection
    EXPECT_EQ(peer.receive(20000), message(3, {}));
    for (int turn = 0; turn < 2; ++turn)
        EXPECT_EQ(peer.receive(20000), message(2, {7, 0, 0, 0, 0, 6, 0, 0, 0, 1, 1}));
}

TEST_F(Tcp, AClientThatNeverReadsDelaysOthersOnlyBriefly) {
    servant_.run = [](const Ice_Current&, Ice_InputStreamPtr, Ice_OutputStreamPtr os) {
        static const Ice_Byte much[8000] = {0};
        Ice_OutputStream_writeBlob(os, much, sizeof much);
        return ICE_OK;
    };
    tcp_->sendMs = 200;
    serve();
    RawSocket greedy(port()), other(port());
    ASSERT_TRUE(greedy.isConnected(1000));
    Clock::time_point begin = Clock::now();
    while (greedy.send(request(1, requestBody("thing", "much"))) && msSince(begin) < 3000)
        ;
    EXPECT_TRUE(ping(other, 3000));
}

TEST_F(Tcp, ANewPeerReplacesThePeerThatWasIdleLongest) {
    tcp_->idleMs = 100;
    serve();
    std::deque<RawSocket> idle;
    for (int i = 0; i < ICE_CONNECTIONS; ++i) {
        idle.emplace_back(port());
        ASSERT_TRUE(ping(idle.back()));
    }
    RawSocket other(port());
    EXPECT_TRUE(ping(other, 2000));
    EXPECT_EQ(idle[0].receive(1000), message(4, {}))
        << "the server must close the connection by CloseConnection, after which the client may "
           "connect again";
    EXPECT_TRUE(ping(idle[1])) << "no other connection was closed";
}

TEST_F(Tcp, AServedPeerFreesItsSlotAtOnce) {
    tcp_->idleMs = 3600000;
    serve();
    std::deque<RawSocket> peers;
    for (int i = 0; i < 5 * ICE_CONNECTIONS; ++i) {
        peers.emplace_back(port());
        ASSERT_TRUE(ping(peers.back(), 20000)) << i;
    }
}

// Returns a request to "thing" that is longer than the largest message.
Bytes tooLong(Ice_Int id) {
    Bytes body = requestBody("thing", "ice_ping");
    body.resize(9000);
    return request(id, body);
}

TEST_F(Tcp, ATooLongRequestIsAnsweredWithTheNameOfTheLimit) {
    serve();
    RawSocket peer(port());
    ASSERT_TRUE(ping(peer));
    ASSERT_TRUE(peer.send(tooLong(9)));
    Bytes reply = peer.receive(20000);
    ASSERT_GT(reply.size(), 20u);
    EXPECT_EQ(Bytes(reply.begin() + 14, reply.begin() + 19), Bytes({9, 0, 0, 0, 5}))
        << "UnknownLocalException";
    EXPECT_EQ(std::string(reply.begin() + 20, reply.end()),
              "::Ice::MemoryLimitException: over ICE_MESSAGE_MAX (8192)");
    EXPECT_TRUE(ping(peer)) << "the connection must remain open";
}

// If a message exceeds a limit and cannot be answered, its sender notices this because the
// connection is closed, as with stock Ice.
TEST_F(Tcp, MessagesRefusedWithoutAReplyAreLoggedAndEndTheConnection) {
    ::testing::internal::CaptureStderr();
    serve();
    RawSocket oneway(port()), batch(port()), compressed(port());
    Bytes calls = {200, 0, 0, 0}, one = requestBody("thing", "ice_ping");
    while (calls.size() < 9000)
        calls.insert(calls.end(), one.begin(), one.end());
    const std::pair<RawSocket*, Bytes> cases[] = {{&oneway, tooLong(0)},
                                                  {&batch, message(1, calls)}};
    for (const auto& [peer, bytes] : cases) {
        ASSERT_TRUE(ping(*peer));
        ASSERT_TRUE(peer->send(bytes));
        EXPECT_TRUE(peer->receive(20000).empty());
        EXPECT_FALSE(ping(*peer, 500)) << "the connection must have ended";
    }
    ASSERT_TRUE(ping(compressed));
    ASSERT_TRUE(compressed.send(message(1, Bytes(100, 1), 2)));
    EXPECT_EQ(compressed.receive(20000), message(4, {}));
    stop();
    const std::string size = std::to_string(calls.size() + 14);
    EXPECT_EQ(::testing::internal::GetCapturedStderr(),
              "icec: refused a request of 9018 bytes: "
              "::Ice::MemoryLimitException: over ICE_MESSAGE_MAX (8192)\n"
              "icec: refused a batch of " +
                  size +
                  " bytes: ::Ice::MemoryLimitException: over ICE_MESSAGE_MAX (8192)\n"
                  "icec: refused a compressed batch: IceC has no bzip2\n");
}

TEST_F(Tcp, APeerWithAPendingOperationIsNotReplaced) {
    tcp_->idleMs = 50;
    Ice_Reply later{};
    std::atomic<bool> asked{false};
    servant_.run = [&](const Ice_Current& current, Ice_InputStreamPtr, Ice_OutputStreamPtr) {
        Ice_Current_later(&current, &later);
        asked = true;
        return ICE_LATER;
    };
    serve();
    std::deque<RawSocket> peers;
    peers.emplace_back(port());
    ASSERT_TRUE(peers[0].isConnected(1000));
    ASSERT_TRUE(peers[0].send(request(3, requestBody("thing", "slow"))));
    while (!asked)
        std::this_thread::yield();
    for (int i = 1; i <= ICE_CONNECTIONS; ++i) {
        peers.emplace_back(port());
        ASSERT_TRUE(ping(peers.back())) << i;
    }
    EXPECT_EQ(peers[1].receive(1000), message(4, {}))
        << "the longest idle of the other connections must be closed";
    EXPECT_EQ(peers[0].receive(1000), message(3, {}));
    EXPECT_TRUE(peers[0].receive(100).empty())
        << "a client that waits for an answer must stay connected";
}

// Ice 3.8 would close a connection without heartbeats
TEST_F(Tcp, AnIdleConnectionCarriesHeartbeats) {
    tcp_->heartbeatMs = 50;
    serve();
    RawSocket peer(port());
    ASSERT_TRUE(ping(peer));
    for (int i = 0; i < 10; ++i)
        ASSERT_EQ(peer.receive(20000), message(3, {})) << i;
    EXPECT_TRUE(ping(peer));
}

// A server that behaves as documented for Ice 3.8: it closes a connection on which nothing arrives.
TEST_F(Tcp, HeartbeatsKeepAConnectionToAServerThatClosesSilentOnes) {
    tcp_->heartbeatMs = 50;
    Listener listener;
    Ice_ObjectPrx prx = proxy(listener);
    const auto ping = [&] { EXPECT_EQ(Ice_ObjectPrx_ice_ping(&prx), ICE_OK); };
    std::thread first(ping);
    RawSocket peer(listener.fd, true);
    peer.send(message(3, {}));
    peer.send(replyTo(peer.receive(20000)));
    first.join();
    const int connection = prx.connection;
    serve();
    for (int i = 0; i < 6; ++i)
        EXPECT_EQ(peer.receive(20000), message(3, {})) << i; // idle time-out of the server, ms
    std::thread second(ping);
    Bytes asked;
    while ((asked = peer.receive(20000)) == message(3, {}))
        continue;
    peer.send(replyTo(asked));
    second.join();
    EXPECT_EQ(prx.connection, connection);
}

TEST_F(Tcp, ATruncatedReplyFailsTheCallAndTheNextCallReconnects) {
    constexpr int calls = 20;
    Listener listener;
    std::thread server([&] {
        // sends only the first 6 to 24 bytes of the reply, at last all 25 bytes, and disconnects
        for (int i = 0; i < calls; ++i) {
            RawSocket peer(listener.fd, true);
            peer.send(message(3, {}));
            const Bytes reply = replyTo(peer.receive(20000));
            peer.send({reply.begin(), reply.begin() + 6 + i});
        }
    });
    Ice_ObjectPrx prx = proxy(listener);
    for (int i = 0; i < calls; ++i) {
        EXPECT_EQ(Ice_ObjectPrx_ice_ping(&prx), i == calls - 1 ? ICE_OK : ICE_CONNECTION_LOST) << i;
    }
    server.join();
}

TEST_F(Tcp, APeerThatVanishedIsProbed) {
    serve();
    RawSocket peer(port());
    ASSERT_TRUE(ping(peer));
    stop();
    int on = 0;
    socklen_t size = sizeof on;
    for (const auto& c : tcp_->connections)
        if (c.fd >= 0)
            (void)getsockopt(c.fd, SOL_SOCKET, SO_KEEPALIVE, &on, &size);
    EXPECT_EQ(on, 1);
}

} // namespace
