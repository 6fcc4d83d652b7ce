// SPDX-License-Identifier: MIT
//
// forwarder: passes the requests of many clients to the vehicle over one connection, and the
// vehicle's requests back to them.
//
// The clients take turns, a request each, and a few requests are under way at a time: so a client
// that sends much, or never reads, delays the others only a little. A request goes at most once.

#pragma once

#include <Ice/Ice.h>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <set>

namespace gateway {

using Parameters = std::pair<const Ice::Byte*, const Ice::Byte*>; // an encapsulation
using Response = std::function<void(bool, const Parameters&)>;
using Failure = std::function<void(std::exception_ptr)>;

// A request that outlives its dispatch.
struct Request {
    Request(const Parameters& in, Response onResponse, Failure onError, const Ice::Current& current)
        : parameters(in.first, in.second), response(std::move(onResponse)),
          failed(std::move(onError)), current(current) {}
    // Sends it to `target`, an object of any identity; throws Ice's immediate exceptions.
    void sendTo(const std::shared_ptr<Ice::ObjectPrx>& target, Response onResponse,
                Failure onError) const;
    bool isOneway() const { return current.requestId == 0; }

    std::vector<Ice::Byte> parameters;
    Response response;
    Failure failed;
    Ice::Current current;
    std::chrono::steady_clock::time_point since = std::chrono::steady_clock::now();
};

// Forwarder holds the clients' requests until their turn comes.
class Forwarder {
public:
    // `vehicle`: a proxy with the vehicle's endpoint. `wait`: a request fails if its turn does not
    // come within this time.
    Forwarder(const std::shared_ptr<Ice::ObjectPrx>& vehicle, std::chrono::seconds wait);

    // Takes a client's request. Blocks while that client has 256 KiB waiting here.
    void take(std::shared_ptr<Request> request);
    // Passes a request of the vehicle to the client that has the object: the last one that answered
    // for this identity, else each in turn.
    void takeCallback(std::shared_ptr<Request> request);
    // This adapter dispatches the vehicle's requests on the clients' connection.
    void setCallbacks(std::shared_ptr<Ice::ObjectAdapter> adapter);

    // Holds a connection to the vehicle from now on; the caller calls it now and then. While there
    // is none no request waits: the object does not exist here.
    void hold();
    unsigned session() const; // which connection is held; 0: none is
    void refuseWaiting();     // as for an object that does not exist: they were not sent
    // Fails requests under way that are older: it is unknown whether they were carried out.
    void giveUp(std::chrono::milliseconds age);
    void failLateRequests(); // the caller calls it now and then
    void stop();             // ends the waiting

private:
    struct Client {
        std::deque<std::shared_ptr<Request>> requests;
        size_t bytes = 0;
        bool hasLeft = false; // only one-way requests are left
    };
    using Connection = std::shared_ptr<Ice::Connection>;
    using Requests = std::vector<std::shared_ptr<Request>>;
    Client& clientAt(const Connection& connection);
    void forget(const Connection& connection);
    std::shared_ptr<Request> nextRequest();
    void send();
    void sendOne(const Connection& connection, const std::shared_ptr<Request>& request);
    void connect();
    void failWaiting(std::chrono::steady_clock::time_point due, std::exception_ptr why);
    static void fail(const Requests& requests, std::exception_ptr why);
    void failAll(std::exception_ptr why);
    void tryClients(std::shared_ptr<Request> request, std::vector<Connection> clients);

    const std::shared_ptr<Ice::ObjectPrx> vehicle_;
    const std::chrono::seconds wait_;
    std::shared_ptr<Ice::ObjectAdapter> callbacks_;
    mutable std::mutex mutex_; // guards all members below
    std::condition_variable room_;
    std::map<Connection, Client> clients_;
    std::map<Ice::Identity, Connection> owners_; // of objects that the vehicle calls
    Connection lastServed_, connection_;         // of a client; to the vehicle
    std::set<std::shared_ptr<Request>> sent_;    // without an answer
    bool isConnecting_ = false, isSending_ = false, stopped_ = false, holds_ = false;
    unsigned connections_ = 0; // to the vehicle, so far
    size_t underWay_ = 0, bytesUnderWay_ = 0;
};

} // namespace gateway
