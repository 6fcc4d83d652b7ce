// SPDX-License-Identifier: MIT
//
// gateway_test: icesoc-gateway between the radio and stock Ice programs without the plugin.

#include "world.h"
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <linux/filter.h>
#include <map>
#include <poll.h>
#include <sys/wait.h>
#include <utility>

namespace {

// The program, its output read until it says its port.
class GatewayProgram {
public:
    explicit GatewayProgram(std::vector<std::string> arguments) {
        int ends[2];
        if (pipe2(ends, O_CLOEXEC) != 0)
            throw std::runtime_error("no pipe");
        arguments.insert(arguments.begin(), GATEWAY);
        std::vector<char*> argv;
        for (auto& argument : arguments)
            argv.push_back(argument.data());
        argv.push_back(nullptr);
        pid_ = fork();
        if (pid_ == 0) {
            dup2(ends[1], 1);
            dup2(ends[1], 2);
            close_range(3, ~0u, 0); // Ice's sockets are inherited otherwise
            execv(argv[0], argv.data());
            _exit(127);
        }
        close(ends[1]);
        out_ = ends[0];
    }
    ~GatewayProgram() {
        if (pid_ > 0)
            stop();
        close(out_);
    }
    // Returns the gateway's printed port; -1: it ended without one.
    int port() {
        size_t at;
        while ((at = said_.find("port ")) == std::string::npos ||
               said_.find(" leads") == std::string::npos)
            if (!read())
                return -1;
        return std::atoi(said_.c_str() + at + 5);
    }
    // Ends it; its exit status.
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
    const std::string& said() const { return said_; }
    // Reads until it prints `text` once more. Returns false where it ends without.
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
    size_t heard_ = 0; // of said_, by hear
};

class Gateway : public ::testing::Test {
protected:
    GatewayProgram start(std::vector<std::string> more = {},
                         const std::string& at = "127.0.0.1:0") {
        std::vector<std::string> arguments = {
            "-d", world_.rig.pty.path(), "-g", std::to_string(Rig::guardMs), "-l", at};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return GatewayProgram(arguments);
    }
    // A program without the plugin.
    static Ice::CommunicatorPtr plain() {
        Ice::InitializationData data;
        data.properties = Ice::createProperties();
        data.properties->setProperty("Ice.Default.InvocationTimeout", "60000");
        data.properties->setProperty("Ice.RetryIntervals", "-1");
        return Ice::initialize(data);
    }
    static std::string endpoint(int port) {
        return "tcp -h 127.0.0.1 -t 60000 -p " + std::to_string(port);
    }
    static std::shared_ptr<RadioTest::EchoPrx> proxy(const Ice::CommunicatorPtr& ic, int port) {
        return Ice::uncheckedCast<RadioTest::EchoPrx>(ic->stringToProxy("echo:" + endpoint(port)));
    }
    World world_{testSeed()};
};

// Three have a channel of the radio each; the others wait for one.
TEST_F(Gateway, FiveProgramsAtOnceShareThreeChannels) {
    GatewayProgram gateway = start();
    int port = gateway.port();
    ASSERT_GT(port, 0) << gateway.said();
    std::vector<std::thread> programs;
    for (int p = 0; p < 5; ++p)
        programs.emplace_back([&, p] {
            try {
                Ice::CommunicatorHolder ic(plain());
                auto echo = proxy(ic.communicator(), port);
                for (int i = 0; i < 5; ++i)
                    EXPECT_EQ(echo->repeat(10 * p + i, World::pattern(p, 100)),
                              World::pattern(p, 100));
            } catch (const std::exception& e) {
                ADD_FAILURE() << "program " << p << ": " << e.what();
            }
        });
    for (auto& program : programs)
        program.join();
    EXPECT_EQ(gateway.stop(), 0);
    EXPECT_NE(gateway.said().find("messages out"), std::string::npos) << gateway.said();
}

TEST_F(Gateway, TheUavCallsTheStationBehindIt) {
    Ice::CommunicatorHolder ic(plain());
    auto adapter = ic->createObjectAdapterWithEndpoints("Station", "tcp -h 127.0.0.1");
    adapter->add(std::make_shared<ListenerServant>(), Ice::stringToIdentity("station"));
    adapter->activate();
    auto info =
        std::dynamic_pointer_cast<Ice::TCPEndpointInfo>(adapter->getEndpoints()[0]->getInfo());
    GatewayProgram gateway =
        start({"-t", "1", "--station", "127.0.0.1:" + std::to_string(info->port)});
    int port = gateway.port();
    ASSERT_GT(port, 0) << gateway.said();
    EXPECT_EQ(proxy(ic.communicator(), port)->callStation(10), 90);
    // Nobody at --station: the UAV is told so, and the gateway goes on.
    adapter->destroy();
    EXPECT_ANY_THROW(proxy(ic.communicator(), port)->callStation(1));
    EXPECT_EQ(proxy(ic.communicator(), port)->repeat(1, {1, 2}), (RadioTest::Bytes{1, 2}));
    EXPECT_EQ(gateway.stop(), 0);
    EXPECT_NE(gateway.said().find("nobody listens at 127.0.0.1"), std::string::npos);
}

TEST_F(Gateway, PythonWithoutThePlugin) {
    GatewayProgram gateway = start();
    int port = gateway.port();
    ASSERT_GT(port, 0) << gateway.said();
    std::string command = PYTHON " '" CLIENT "' '" SLICE "' '' '" + endpoint(port) + "' 0";
    EXPECT_EQ(std::system(command.c_str()), 0) << "the gateway said:\n" << gateway.said();
}

TEST_F(Gateway, AModemThatComesBackIsUsedAgain) {
    GatewayProgram gateway = start({"-t", "1"});
    int port = gateway.port();
    ASSERT_GT(port, 0) << gateway.said();
    Ice::CommunicatorHolder ic(plain());
    world_.rig.with([&] { world_.rig.ground->power(false, world_.rig.ns()); });
    EXPECT_ANY_THROW(proxy(ic.communicator(), port)->ice_ping()); // no modem: the connection ends
    world_.rig.with([&] { world_.rig.ground->power(true, world_.rig.ns()); });
    bool back = false;
    for (int tries = 0; tries < 10 && !back; ++tries) // a busy machine may miss guard times
        try {
            proxy(ic.communicator(), port)->ice_ping();
            back = true;
        } catch (const Ice::LocalException&) {
        }
    EXPECT_TRUE(back);
}

TEST_F(Gateway, ListensAtAnIPv6Address) {
    if (std::ifstream("/proc/net/if_inet6").peek() == EOF)
        GTEST_SKIP() << "this machine has no IPv6";
    GatewayProgram gateway = start({}, "[::1]:0");
    const int port = gateway.port();
    ASSERT_GT(port, 0) << gateway.said();
    Ice::CommunicatorHolder ic(plain());
    auto echo = Ice::uncheckedCast<RadioTest::EchoPrx>(
        ic->stringToProxy("echo:tcp -h \"::1\" -t 60000 -p " + std::to_string(port)));
    EXPECT_EQ(echo->repeat(1, {1, 2}), (RadioTest::Bytes{1, 2}));
}

// A TCP connection that says nothing.
class SilentClient {
public:
    explicit SilentClient(int port) : fd_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        sockaddr_in to{};
        to.sin_family = AF_INET;
        to.sin_port = htons(static_cast<uint16_t>(port));
        to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        EXPECT_EQ(connect(fd_, reinterpret_cast<sockaddr*>(&to), sizeof to), 0);
    }
    SilentClient(SilentClient&& other) : fd_(std::exchange(other.fd_, -1)) {}
    ~SilentClient() {
        if (fd_ >= 0)
            close(fd_);
    }
    // Bytes until the connection ends; or -1, after ten seconds.
    int untilTheEnd() {
        for (int got = 0;;) {
            pollfd p{fd_, POLLIN, 0};
            char bytes[64];
            if (poll(&p, 1, 10'000) <= 0)
                return -1;
            ssize_t count = recv(fd_, bytes, sizeof bytes, 0);
            if (count <= 0)
                return got;
            got += static_cast<int>(count);
        }
    }
    // The UAV's server has greeted it: so it has a channel.
    bool isGreeted() {
        char bytes[14];
        return recv(fd_, bytes, sizeof bytes, MSG_WAITALL) == sizeof bytes;
    }

    // From here on no packet reaches it, as if its machine were off: the kernel drops them. False:
    // it lets this user have no filter.
    bool vanish() {
        sock_filter none = BPF_STMT(BPF_RET | BPF_K, 0);
        const sock_fprog filter = {1, &none};
        const bool has = setsockopt(fd_, SOL_SOCKET, SO_ATTACH_FILTER, &filter, sizeof filter) == 0;
        EXPECT_TRUE(has || errno == EPERM);
        return has;
    }
    // Calls ice_ping of echo.
    void ping() {
        const std::string parameters("\1\0\0\0\4echo\0\0\10ice_ping\1\0\6\0\0\0\1\1", 29);
        const std::string head("IceP\1\0\1\0\0\0\53\0\0\0", 14);
        ASSERT_EQ(send(fd_, (head + parameters).data(), 43, MSG_NOSIGNAL), 43);
    }

private:
    int fd_;
};

// Three have the channels and vanish, with a reply under way and without.
TEST_F(Gateway, AClientThatVanishesWithoutAWordIsGivenUp) {
    GatewayProgram gateway = start({"--idle", "3600", "--wait", "100", "--vanished", "6"});
    const int port = gateway.port();
    ASSERT_GT(port, 0) << gateway.said();
    std::vector<SilentClient> vanished, others;
    for (int i = 0; i < 3; ++i) {
        vanished.emplace_back(port);
        ASSERT_TRUE(vanished.back().isGreeted());
    }
    for (SilentClient& client : vanished) {
        if (!client.vanish())
            GTEST_SKIP() << "this machine's kernel lets the user attach no filter to a socket";
        if (&client != &vanished[0])
            client.ping();
    }
    for (int i = 0; i < 3; ++i)
        others.emplace_back(port);
    for (SilentClient& client : others)
        EXPECT_TRUE(client.isGreeted());
    gateway.stop();
}

TEST_F(Gateway, ASilentClientMakesRoomForOneThatWaits) {
    GatewayProgram gateway = start({"--idle", "1"});
    const int port = gateway.port();
    ASSERT_GT(port, 0) << gateway.said();
    std::vector<SilentClient> silent;
    for (int i = 0; i < 3; ++i) {
        silent.emplace_back(port);
        ASSERT_TRUE(silent.back().isGreeted());
    }
    Ice::CommunicatorHolder ic(plain());
    EXPECT_EQ(proxy(ic.communicator(), port)->repeat(1, {1, 2}), (RadioTest::Bytes{1, 2}));
    EXPECT_EQ(silent[0].untilTheEnd(), 14) << "Ice's own good-bye";
}

TEST_F(Gateway, WhoWaitsForAChannelIsTurnedAwayAfterAWhile) {
    GatewayProgram gateway = start({"--idle", "3600", "--wait", "1"});
    const int port = gateway.port();
    ASSERT_GT(port, 0) << gateway.said();
    std::vector<SilentClient> silent;
    for (int i = 0; i < 3; ++i) {
        silent.emplace_back(port);
        ASSERT_TRUE(silent.back().isGreeted());
    }
    EXPECT_EQ(SilentClient(port).untilTheEnd(), 0);
    gateway.stop();
    EXPECT_NE(gateway.said().find("client 4 has waited 1 s"), std::string::npos) << gateway.said();
}

TEST_F(Gateway, StatisticsComeEverySoManySeconds) {
    const std::string line = "messages out";
    GatewayProgram often = start({"--statistics", "1"});
    for (int lines = 0; lines < 3; ++lines)
        ASSERT_TRUE(often.hear(line)) << often.said();
    often.stop();
    GatewayProgram seldom = start({"--statistics", "86400"});
    const int port = seldom.port();
    ASSERT_GT(port, 0) << seldom.said();
    for (int i = 0; i < 100; ++i)
        SilentClient{port}; // each wakes it up
    seldom.stop();
    EXPECT_EQ(seldom.said().find(line), seldom.said().rfind(line)) << "one at the end";
}

TEST(GatewayOptions, WrongOnesAreRefusedByName) {
    const std::pair<std::map<std::string, std::string>, std::string> cases[] = {
        {{}, "it is no terminal"},
        {{{"-d", "/dev/no-such-port"}}, "No such file"},
        {{{"-l", "nonsense"}}, "give HOST:PORT"},
        {{{"-l", "127.0.0.1:70000"}}, "a port is 0 to 65535"},
        {{{"-l", "[::1"}}, "[::1"},
        {{{"-a", "65536"}}, "--address"},
        {{{"--key", "/no/such/file"}}, "openssl rand -hex 16"},
        {{{"--modem-key", "/no/such/file"}}, "No such file"},
        {{{"--statistics", "-5"}}, "--statistics"},
        {{{"--station", "x"}}, "give HOST:PORT"}};
    for (auto [options, said] : cases) {
        options.insert({{"-d", "/dev/null"}, {"-l", "127.0.0.1:0"}});
        std::vector<std::string> words;
        for (const auto& [name, value] : options)
            words.insert(words.end(), {name, value});
        GatewayProgram gateway(words);
        EXPECT_GT(gateway.wait(), 0) << said;
        EXPECT_NE(gateway.said().find(said), std::string::npos) << gateway.said();
    }
}

} // namespace
