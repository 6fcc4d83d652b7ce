// SPDX-License-Identifier: MIT
//
// forwarder: passes the requests of many clients to the vehicle, and the vehicle's requests back to
// the clients.
//
// The clients' requests wait in queues (client_queues.h), and are sent on two connections to the
// vehicle, called lanes (lane.h). Each request is sent at most once, and the requests of one client
// are sent in order.

#pragma once

#include "addressees.h"
#include "client_queues.h"
#include "lane.h"
#include "object_types.h"

#include <array>
#include <condition_variable>
#include <deque>
#include <mutex>

namespace gateway {

// Passes requests in both directions. Its functions may be called by any thread.
class Forwarder {
public:
    // Creates a forwarder. `vehicle` is a proxy with the vehicle's endpoint. `wait` is the longest
    // time for which a request may wait to be sent; after this time the request fails.
    Forwarder(const std::shared_ptr<Ice::ObjectPrx>& vehicle, std::chrono::seconds wait);

    // Queues a client's request. Blocks while the queues hold 256 KiB of requests of the client's
    // subject. A client's only request does not block, unless the subject has more than 200
    // clients. At most 16 requests of a subject block at a time; any further request fails, and if
    // this request is one-way, the client's connection is closed.
    void take(std::shared_ptr<Request> request);
    // Passes a request of the vehicle to the only client that gave the vehicle a proxy with this
    // identity. If no client has ever given such a proxy, passes the request to the only
    // client with a two-way call in progress. If no client or several clients qualify, replies
    // ObjectNotExistException.
    void takeCallback(std::shared_ptr<Request> request);
    // Sets the adapter that dispatches requests of the vehicle which arrive on the lanes.
    void setCallbacks(std::shared_ptr<Ice::ObjectAdapter> adapter);

    // Connects to the vehicle and keeps the connection; must be called periodically. Before the
    // first call of hold(), requests wait for a connection. After this call, a request that arrives
    // without a connection fails with ObjectNotExistException.
    void hold();
    unsigned session() const; // number of the current connection; 0 without one
    void refuseWaiting();     // fails waiting requests with ObjectNotExistException
    // Fails requests in flight that are older than `age`. It is then unknown whether the vehicle
    // has executed them.
    void giveUp(std::chrono::milliseconds age);
    void failLateRequests(); // fails requests that have waited too long; to be called periodically
    void stop();             // fails all waiting requests

private:
    using Object = ObjectTypes::Object;
    void forget(const Connection& connection);
    int laneOf(const Request& request) const;
    bool mayGo(const Client& client) const;
    int laneToConnect() const;
    std::shared_ptr<Request> nextRequest();
    void send();
    void ask(const Connection& connection, const Object& object);
    void answered(const Object& object, bool isKnown, bool isMaintenance, std::exception_ptr why);
    bool recordProxies(const std::shared_ptr<Request>& request);
    void sendOne(const std::shared_ptr<Request>& request);
    void confirm(int lane, const Ice::Current& of);
    void finish(const std::shared_ptr<Request>& request, bool hasArrived,
                const std::function<void()>& answer);
    void connect(int lane);
    void opened(int lane, const Connection& connection);
    void closed(int lane, const Connection& connection);
    void failWaiting(std::chrono::steady_clock::time_point due, std::exception_ptr why);
    void failAll(std::exception_ptr why);

    const std::shared_ptr<Ice::ObjectPrx> vehicle_;
    const std::chrono::seconds wait_;
    std::shared_ptr<Ice::ObjectAdapter> callbacks_;
    mutable std::mutex mutex_; // guards all members below
    std::condition_variable room_;
    ClientQueues queues_{[this](const Connection& closed) { forget(closed); }};
    Addressees addressees_;
    ObjectTypes types_;
    std::array<Lane, lanes> lanes_{Lane(1536), Lane(8192)}; // limits of the bytes in flight
    std::set<std::shared_ptr<Request>> sent_;               // requests that have no reply yet
    // requests that may be sent now, in the order of sending
    std::deque<std::shared_ptr<Request>> ready_;
    std::set<std::pair<Ice::Identity, std::string>> longReplies_; // operations with long replies
    bool isSending_ = false, stopped_ = false, holds_ = false;
    unsigned connections_ = 0; // number of connections made to the vehicle so far
};

} // namespace gateway
