// SPDX-License-Identifier: MIT
//
// reported: which exceptions say, in Ice's words, "this call may not have been executed"; and the
// ground's program that ends and starts again under its callers.

#ifndef REPORTED_H
#define REPORTED_H

#include <Ice/Ice.h>
#include <mutex>
#include <set>
#include <string>

inline bool isReport(const std::string& exceptionId) {
    static const std::set<std::string> reports = {
        "::Ice::ConnectionLostException",    "::Ice::ConnectFailedException",
        "::Ice::ConnectTimeoutException",    "::Ice::InvocationTimeoutException",
        "::Ice::TimeoutException",           "::Ice::CloseConnectionException",
        "::Ice::CloseTimeoutException",      "::Ice::ConnectionTimeoutException",
        "::Ice::ConnectionRefusedException", "::Ice::CommunicatorDestroyedException"};
    return reports.count(exceptionId) != 0;
}

class GroundProgram {
public:
    Ice::CommunicatorPtr get() {
        std::lock_guard<std::mutex> lock(mutex_);
        return current_;
    }
    void start(const Ice::CommunicatorPtr& fresh) {
        std::lock_guard<std::mutex> lock(mutex_);
        current_ = fresh;
    }
    void end() {
        auto old = get();
        {
            std::lock_guard<std::mutex> lock(mutex_);
            ended_.insert(old);
        }
        old->destroy();
    }
    // True if an exception of a call with `used` may be reported so. While a communicator is
    // destroyed, Ice's own parts say in other words that they are gone: "timer destroyed", a null
    // handle.
    bool isReport(const Ice::CommunicatorPtr& used, const std::string& exceptionId) {
        std::lock_guard<std::mutex> lock(mutex_);
        return ::isReport(exceptionId) || ended_.count(used) != 0;
    }

private:
    std::mutex mutex_;
    Ice::CommunicatorPtr current_;
    std::set<Ice::CommunicatorPtr> ended_;
};

#endif
