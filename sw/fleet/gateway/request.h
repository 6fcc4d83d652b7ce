// SPDX-License-Identifier: MIT
//
// request: a copy of a request of a client or of the vehicle. Ice's dispatch returns before the
// gateway forwards the copy.

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
    // pointers to the first byte of an encapsulation and to the byte after its last byte
    std::pair<const Ice::Byte*, const Ice::Byte*>;
using Response = std::function<void(bool, const Parameters&)>;
using Failure = std::function<void(std::exception_ptr)>;

struct Client;

// A request of a client or of the vehicle, which the gateway forwards later.
struct Request {
    Request(const Parameters& in, Response onResponse, Failure onError, const Ice::Current& current)
        : parameters(in.first, in.second), bytes(messageBytes(current) + parameters.size()),
          response(std::move(onResponse)), failed(std::move(onError)), current(current) {}
    // Returns the size of a request without parameters as an Ice message.
    static size_t messageBytes(const Ice::Current& current);
    // Sends the request with the connection or endpoints of the proxy `target`, and the identity of
    // the called object. Throws the exceptions that ice_invokeAsync throws.
    void sendTo(const std::shared_ptr<Ice::ObjectPrx>& target, Response onResponse,
                Failure onError) const;
    bool isOneway() const { return current.requestId == 0; }

    std::vector<Ice::Byte> parameters;
    size_t bytes; // size of the request as an Ice message
    Response response;
    Failure failed;
    Ice::Current current;
    std::chrono::steady_clock::time_point since = std::chrono::steady_clock::now();
    // subject of the client's certificate; the host of a client without a certificate
    std::string subject;
    bool mayMaintain = false; // true if the client may call maintenance objects
    std::shared_ptr<Client> client;
    int lane = 0;           // lane on which the request was sent
    bool isCounted = false; // true while the request is counted as in flight on its lane
};

using Requests = std::vector<std::shared_ptr<Request>>;

// Returns an Ice UnknownException with the text "icesoc-gateway: " and `why`.
std::exception_ptr unknown(const std::string& why);

// Fails the requests with this exception. Logs how many of them are one-way, because the senders of
// one-way requests receive no error.
void fail(const Requests& requests, std::exception_ptr why);

} // namespace gateway
