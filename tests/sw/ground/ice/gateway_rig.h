// SPDX-License-Identifier: MIT
//
// gateway_rig: icesoc-gateway between the radio and programs without the plugin.

#ifndef GATEWAY_RIG_H
#define GATEWAY_RIG_H

#include "world.h"
#include <csignal>
#include <cstdlib>
#include <gtest/gtest.h>
#include <sys/wait.h>

// A server program, its output read as far as it is asked for.
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
            dup2(ends[1], 1);
            dup2(ends[1], 2);
            close_range(3, ~0u, 0); // Ice's sockets are inherited otherwise
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
    // Returns the port that it prints between these words; -1: it ended without.
    int port(const std::string& before = "gateway: port ", const std::string& after = " leads") {
        if (!hear(before))
            return -1;
        const size_t at = heard_;
        return hear(after) ? std::atoi(said_.c_str() + at) : -1;
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
    // Runs the gateway; `port_` and `echo_` lead to it.
    void start(std::vector<std::string> more = {}, const std::string& at = "127.0.0.1:0") {
        more.insert(more.begin(), GATEWAY);
        more.insert(more.end(),
                    {"-d", world_.rig.pty.path(), "-g", std::to_string(Rig::guardMs), "-l", at});
        gateway_ = std::make_unique<Server>(more);
        port_ = gateway_->port();
        if (port_ <= 0)
            throw std::runtime_error("the gateway has not started: " + said());
        echo_ = proxy(ic_.communicator());
    }
    int stop() { return gateway_->stop(); }
    const std::string& said() const { return gateway_->said(); }
    bool says(const std::string& text) const { return said().find(text) != std::string::npos; }
    // A program without the plugin.
    static Ice::CommunicatorPtr plain() {
        Ice::InitializationData data;
        data.properties = Ice::createProperties();
        data.properties->setProperty("Ice.Default.InvocationTimeout", "60000");
        data.properties->setProperty("Ice.RetryIntervals", "-1");
        return Ice::initialize(data);
    }
    std::string endpoint(int port = 0) const {
        return "tcp -h 127.0.0.1 -t 60000 -p " + std::to_string(port ? port : port_);
    }
    std::shared_ptr<RadioTest::UavPrx> proxy(const Ice::CommunicatorPtr& ic) const {
        return Ice::uncheckedCast<RadioTest::UavPrx>(ic->stringToProxy("echo:" + endpoint()));
    }
    void expectAnswer(int id = 1) {
        EXPECT_EQ(echo_->repeat(id, {1, 2}), (RadioTest::Bytes{1, 2}));
    }
    // Asks for the number of notes, each time with a turn, until it has come to `wanted`.
    void expectNoted(int wanted) {
        int noted = 0;
        for (int calls = 0; calls < 1000 && noted < wanted; ++calls)
            noted = echo_->noted();
        EXPECT_EQ(noted, wanted);
    }
    World world_{testSeed()};
    std::unique_ptr<Server> gateway_;
    int port_ = 0;
    Ice::CommunicatorHolder ic_{plain()};
    std::shared_ptr<RadioTest::UavPrx> echo_;
};

#endif
