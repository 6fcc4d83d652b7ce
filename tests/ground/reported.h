// SPDX-License-Identifier: MIT
//
// reported: which exceptions say, in Ice's words, "this call may not have been executed".

#ifndef REPORTED_H
#define REPORTED_H

#include <set>
#include <string>

inline bool isReport(const std::string& exceptionId) {
    static const std::set<std::string> reports = {
        "::Ice::ConnectionLostException",
        "::Ice::ConnectFailedException",
        "::Ice::ConnectTimeoutException",
        "::Ice::InvocationTimeoutException",
        "::Ice::TimeoutException",
        "::Ice::CloseConnectionException",
        "::Ice::CloseTimeoutException",
        "::Ice::ConnectionTimeoutException",
        "::Ice::ConnectionRefusedException",
        "::Ice::CommunicatorDestroyedException",
        "::IceUtil::IllegalArgumentException"}; // "timer destroyed": of a communicator, too
    return reports.count(exceptionId) != 0;
}

#endif
