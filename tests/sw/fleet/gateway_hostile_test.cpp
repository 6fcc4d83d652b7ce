// SPDX-License-Identifier: MIT
//
// gateway_hostile_test: sends bytes to the gateway that no Ice program sends, and leaves
// connections as no Ice program does. The gateway must continue, serve others, bound its memory,
// and end.

#include "gateway_rig.h"
#include <atomic>
#include <thread>

namespace {

using Message = std::vector<unsigned char>;

void append(Message& to, size_t number, int bytes = 4) {
    for (int i = 0; i < bytes; ++i)
        to.push_back(static_cast<unsigned char>(number >> 8 * i));
}

void append(Message& to, const std::string& text) {
    if (text.size() < 255) {
        append(to, text.size(), 1);
    } else {
        append(to, 255, 1);
        append(to, text.size());
    }
    to.insert(to.end(), text.begin(), text.end());
}

// Parts of a request that a test may choose. The size of the encapsulation may be wrong.
struct Parts {
    unsigned id = 1; // 0 for a one-way request
    std::string object = "echo", operation = "ice_ping", context = "";
    size_t encapsulation = 6;
    Message parameters = {};
    size_t facets = 0; // number of facets that the message claims to contain; it contains none
};

Message request(const Parts& parts) {
    Message body;
    append(body, parts.id);
    append(body, parts.object);
    append(body, std::string());
    if (parts.facets)
        append(body, 255, 1);
    append(body, parts.facets, parts.facets ? 4 : 1);
    append(body, parts.operation);
    append(body, 0, 1); // mode: normal
    append(body, !parts.context.empty(), 1);
    if (!parts.context.empty()) {
        append(body, std::string("key"));
        append(body, parts.context);
    }
    append(body, parts.encapsulation + parts.parameters.size());
    append(body, 0x0101, 2);
    body.insert(body.end(), parts.parameters.begin(), parts.parameters.end());
    Message all{'I', 'c', 'e', 'P', 1, 0, 1, 0, 0, 0};
    append(all, 14 + body.size());
    all.insert(all.end(), body.begin(), body.end());
    return all;
}

// RawClient is a connection to the gateway without Ice.
class RawClient {
public:
    explicit RawClient(int port) : fd_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        sockaddr_in to{};
        to.sin_family = AF_INET;
        to.sin_port = htons(static_cast<uint16_t>(port));
        to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        if (connect(fd_, reinterpret_cast<sockaddr*>(&to), sizeof to) != 0)
            throw std::runtime_error("no connection to the gateway");
        const timeval limit{60, 0};
        setsockopt(fd_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
        receive(); // ValidateConnection
    }
    ~RawClient() { close(fd_); }
    RawClient(const RawClient&) = delete;
    RawClient& operator=(const RawClient&) = delete;

    void write(const Message& message) { send(fd_, message.data(), message.size(), MSG_NOSIGNAL); }
    // Sends a message repeatedly, until nothing was accepted for a second or `limit` bytes were
    // accepted. Returns the number of accepted bytes.
    size_t flood(const Message& message, size_t limit) {
        fcntl(fd_, F_SETFL, O_NONBLOCK);
        size_t sent = 0;
        for (int pauses = 0; sent < limit && pauses < 100;) {
            const size_t at = sent % message.size();
            const ssize_t count = send(fd_, message.data() + at, message.size() - at, MSG_NOSIGNAL);
            if (count > 0) {
                sent += static_cast<size_t>(count);
                pauses = 0;
            } else if (errno == EAGAIN) {
                ++pauses;
                std::this_thread::sleep_for(std::chrono::milliseconds(10));
            } else {
                break; // the gateway has closed the connection
            }
        }
        return sent;
    }
    // Returns the next message, or an empty message if the connection has ended.
    Message receive() {
        Message message(14);
        if (recv(fd_, message.data(), 14, MSG_WAITALL) != 14)
            return {};
        const size_t size = message[10] | size_t{message[11]} << 8 | size_t{message[12]} << 16;
        message.resize(size);
        if (size > 14 && recv(fd_, message.data() + 14, size - 14, MSG_WAITALL) < 0)
            return {};
        return message;
    }

private:
    const int fd_;
};

class HostileClients : public Gateway {
protected:
    void startWithoutVehicle(const std::string& wait, std::vector<std::string> more = {}) {
        world_.rig.with([&] { world_.rig.uav.modem->power(false, world_.rig.ns()); });
        more.insert(more.end(), {"--wait", wait});
        start(more);
    }
    // Checks that a text for users contains no name of a source file or of an exception.
    static void expectWords(const std::string& text) {
        for (const char* internal : {".cpp", ".h:", "::Ice::", "Exception"})
            EXPECT_EQ(text.find(internal), std::string::npos) << text;
    }
    // Stops the gateway. Returns its exit status, or -1 if it was killed because it did not end.
    int stopOrKill() {
        std::atomic<bool> hasEnded{false};
        std::thread killer([&, pid = gateway_->pid()] {
            for (int tenths = 0; !hasEnded && tenths < 600; ++tenths)
                std::this_thread::sleep_for(std::chrono::milliseconds(100));
            if (!hasEnded)
                kill(pid, SIGKILL);
        });
        const int status = stop();
        hasEnded = true;
        killer.join();
        return status;
    }
};

TEST_F(HostileClients, AnAbandonedCallDoesNotKeepTheGatewayFromEnding) {
    startWithoutVehicle("2");
    RawClient(port_).write(request({}));
    // The gateway handles this call after the call of the client that has left.
    expectRefusal([&] { echo_->ice_ping(); }, "waited 2 s for the radio");
    EXPECT_EQ(stopOrKill(), 0) << "the gateway did not end";
}

// Ice has no memory for the facets that this message claims to contain, and never replies to it.
TEST_F(HostileClients, AMessageWithoutAReplyDoesNotKeepTheGatewayFromEnding) {
    startWithoutVehicle("2", {"--end", "1"});
    Parts senseless;
    senseless.facets = 0x7FFFFFFF;
    RawClient client(port_);
    client.write(request(senseless));
    expectRefusal([&] { echo_->ice_ping(); }, "waited 2 s for the radio");
    EXPECT_EQ(stopOrKill(), 0) << "the gateway did not end";
    EXPECT_TRUE(hasPrinted("the connection of a client did not end within 1 s"));
}

// A subject may queue 256 KiB of requests. Names and contexts also count, and each request counts
// more than its bytes. The sockets of a connection hold a few MB.
TEST_F(HostileClients, RequestsWithoutParametersCountAgainstTheQueues) {
    startWithoutVehicle("600");
    constexpr size_t limit = 64 << 20, mostAccepted = 24 << 20;
    EXPECT_LT(RawClient(port_).flood(request({0, "echo", "note", std::string(7000, 'x')}), limit),
              mostAccepted)
        << "contexts do not count";
    EXPECT_LT(RawClient(port_).flood(request({0, "echo", std::string(7000, 'x')}), limit),
              mostAccepted)
        << "names do not count";
    EXPECT_LT(RawClient(port_).flood(request({0}), limit), mostAccepted)
        << "empty requests do not count";
    EXPECT_EQ(stopOrKill(), 0);
}

// The gateway's log, and the reason that a client gets for a failed call, are words.
TEST_F(HostileClients, ErrorsAreReadable) {
    startWithoutVehicle("600");
    RawClient client(port_);
    Parts wrong;
    wrong.encapsulation = 600; // longer than the message
    client.write(request(wrong));
    const Message reply = client.receive();
    ASSERT_GT(reply.size(), 25U);
    EXPECT_EQ(reply[18], 5) << "UnknownLocalException";
    const std::string why(reply.begin() + 19, reply.end());
    EXPECT_NE(why.find("out of bounds"), std::string::npos) << why;
    expectWords(why);
    Parts tooLong;
    tooLong.context = std::string(9000, 'x');
    client.write(request(tooLong));
    const Message refused = client.receive();
    const std::string limit(refused.begin(), refused.end());
    EXPECT_NE(limit.find("too long for the radio link (at most 8192 bytes)"), std::string::npos);
    expectWords(limit);
    // These calls wait when the gateway ends.
    client.write(request({0}));
    client.write(request({7}));
    client.write(request(wrong));
    EXPECT_FALSE(client.receive().empty()) << "the reply to the last call";
    EXPECT_EQ(stopOrKill(), 0);
    const Message waiting = client.receive();
    expectWords({waiting.begin(), waiting.end()});
    EXPECT_TRUE(hasPrinted("one-way calls that were not sent: 1 (the gateway ends)")) << said();
    expectWords(said());
}

// All clients of a datagram endpoint share one connection. A refused datagram must not close it.
TEST_F(HostileClients, ATooLongDatagramIsDroppedAlone) {
    const auto pid = unsigned(getpid()); // an address that no other test uses
    const std::string host = "127." + std::to_string(64 + (pid >> 16) % 64) + "." +
                             std::to_string((pid >> 8) % 256) + "." + std::to_string(pid % 256);
    start({}, "tcp -h 127.0.0.1 -p 0:udp -h " + host + " -p 10000");
    const int client = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(10000);
    ASSERT_EQ(inet_pton(AF_INET, host.c_str(), &to.sin_addr), 1);
    for (const size_t context : {0, 9000, 0}) {
        Parts parts;
        parts.id = 0;
        parts.context = std::string(context, 'x');
        parts.operation = "note";
        parts.parameters = {7, 0, 0, 0};
        const Message datagram = request(parts);
        EXPECT_EQ(sendto(client, datagram.data(), datagram.size(), 0,
                         reinterpret_cast<sockaddr*>(&to), sizeof to),
                  ssize_t(datagram.size()));
    }
    expectNoted(2);
    close(client);
    EXPECT_EQ(stopOrKill(), 0);
    EXPECT_TRUE(hasPrinted("dropped a datagram: a message of 9")) << said();
}

// Ice logs its warnings with the position in its source code and the name of the exception.
TEST_F(HostileClients, WarningsOfIceAreReadable) {
    world_.rig.with([&] { world_.rig.uav.modem->power(false, world_.rig.ns()); });
    start({"--wait", "2", "--Ice.Warn.Connections=1"});
    const Message http{'G', 'E', 'T', ' ', '/', ' ', 'H', 'T', 'T', 'P', '/', '1', '.', '1'};
    RawClient client(port_);
    client.write(http);
    EXPECT_TRUE(client.receive().empty());
    EXPECT_EQ(stopOrKill(), 0);
    EXPECT_TRUE(
        hasPrinted("warning: connection exception:\n   bad magic:\n   unknown magic number"))
        << said();
    expectWords(said());
}

} // namespace
