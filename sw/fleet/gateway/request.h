// SPDX-License-Identifier: MIT
//
// request: a request of a client or of the vehicle that the gateway passes on after its dispatch
// has returned.

#pragma once

#include <Ice/Ice.h>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace gateway {

using Connection = std::shared_ptr<Ice::Connection>;
using Parameters =
    std::pair<const Ice::Byte*, const Ice::Byte*>; // an encapsulation: its first byte, and the end
using Response = std::function<void(bool, const Parameters&)>;
using Failure = std::function<void(std::exception_ptr)>;

struct Client;

// A client's request, which is kept after its dispatch has returned.
struct Request {
    Request(const Parameters& in, Response onResponse, Failure onError, const Ice::Current& current)
        : parameters(in.first, in.second), response(std::move(onResponse)),
          failed(std::move(onError)), current(current) {}
    // Sends the request to `target`, an object of any identity. Throws the exceptions that Ice
    // throws at once.
    void sendTo(const std::shared_ptr<Ice::ObjectPrx>& target, Response onResponse,
                Failure onError) const;
    bool isOneway() const { return current.requestId == 0; }

    std::vector<Ice::Byte> parameters;
    Response response;
    Failure failed;
    Ice::Current current;
    std::chrono::steady_clock::time_point since = std::chrono::steady_clock::now();
    std::string subject;      // subject of the client's certificate; without one, its host
    bool mayMaintain = false; // true if the client may call objects for maintenance
    std::shared_ptr<Client> client;
    int lane = 0;           // lane on which the request was sent
    bool isCounted = false; // true while it counts as in flight on its lane
};

using Requests = std::vector<std::shared_ptr<Request>>;

// Returns an Ice exception with this text and the gateway's name.
std::exception_ptr unknown(const std::string& why);

// Fails requests. Prints the number of one-way requests, because their clients receive no error.
void fail(const Requests& requests, std::exception_ptr why);

} // namespace gateway
