// SPDX-License-Identifier: MIT
//
// gateway_rig: runs icesoc-gateway between the radio and programs that do not use the plugin.

#pragma once

#include "world.h"
#include <gtest/gtest.h>

class Gateway : public ::testing::Test {
protected:
    // Starts the gateway, and sets `port_` and `echo_`.
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
    bool hasPrinted(const std::string& text) const {
        return said().find(text) != std::string::npos;
    }
    // Returns a communicator without the plugin.
    static Ice::CommunicatorPtr plain() {
        return program(
            {{"Ice.Default.InvocationTimeout", "1800000"}, {"Ice.RetryIntervals", "-1"}});
    }
    std::string endpoint(int port = 0) const {
        return "tcp -h 127.0.0.1 -t 1800000 -p " + std::to_string(port ? port : port_);
    }
    std::shared_ptr<RadioTest::UavPrx> proxy(const Ice::CommunicatorPtr& ic) const {
        return Ice::uncheckedCast<RadioTest::UavPrx>(ic->stringToProxy("echo:" + endpoint()));
    }
    void expectAnswer(int id = 1) {
        EXPECT_EQ(echo_->repeat(id, {1, 2}), (RadioTest::Bytes{1, 2}));
    }
    // Asks the vehicle how many notes it has received, until it has received at least `wanted`.
    // Then the number must be exactly `wanted`.
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

// Returns the reason why a call fails, or an empty string if it succeeds.
inline std::string whyFails(const std::function<void()>& call) {
    try {
        call();
        return "";
    } catch (const Ice::UnknownException& e) {
        return e.unknown;
    } catch (const Ice::Exception& e) {
        return e.ice_id();
    }
}

inline void expectRefusal(const std::function<void()>& call, const std::string& why) {
    const std::string said = whyFails(call);
    EXPECT_NE(said.find(why), std::string::npos) << said;
}
