// SPDX-License-Identifier: MIT
//
// forwarder: passes the requests of many clients to the vehicle, and the vehicle's requests back to
// them.
//
// Bytes are shared evenly (turns.h) among the subjects (certificates, or hosts without one), and
// the share of each subject evenly among its connections. There are two connections to the vehicle,
// because on one connection a short message waits for the long ones before it: a lane for short
// calls, and a lane for calls that are long or have long replies. Few requests are in flight on
// each. A one-way request counts until a reply to a later request shows that it has arrived. Each
// request is sent at most once, and the requests of one client are sent in order.

#pragma once

#include "turns.h"

#include <Ice/Ice.h>
#include <array>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <set>

namespace gateway {

using Parameters = std::pair<const Ice::Byte*, const Ice::Byte*>; // an encapsulation: its first
                                                                  // byte, and the end
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
    std::string subject;      // subject of the client's certificate; without a certificate, the
                              // client's host
    bool mayMaintain = false; // true if the client may call objects for maintenance
    std::shared_ptr<Client> client;
    int lane = 0;           // lane on which the request was sent
    bool isCounted = false; // true while the request counts as in flight on its lane: until it has
                            // arrived
};

// Holds the clients' requests until their turn.
class Forwarder {
public:
    // Creates a forwarder. `vehicle` is a proxy with the vehicle's endpoint; `wait` is the longest
    // time that a request waits for its turn before it fails.
    Forwarder(const std::shared_ptr<Ice::ObjectPrx>& vehicle, std::chrono::seconds wait);

    // Queues a client's request. Blocks while the queue holds 256 KiB of requests of the client's
    // subject, unless it is the first request of one of the subject's 200 clients. At most 16
    // requests of a subject block at a time; more requests fail, and a one-way request that fails
    // closes its connection.
    void take(std::shared_ptr<Request> request);
    // Passes a request of the vehicle to the only client that gave the vehicle a proxy with this
    // identity; without such a client, to the only client with a two-way call in progress. Replies
    // ObjectNotExistException if no client or several clients qualify.
    void takeCallback(std::shared_ptr<Request> request);
    // Sets the adapter that dispatches the vehicle's requests on the clients' connections.
    void setCallbacks(std::shared_ptr<Ice::ObjectAdapter> adapter);

    // Connects to the vehicle and keeps the connection; to be called periodically. After the first
    // call, requests that arrive while there is no connection fail with ObjectNotExistException;
    // they no longer wait.
    void hold();
    unsigned session() const; // number of the current connection; 0 without one
    void refuseWaiting(); // fails waiting requests with ObjectNotExistException Fails requests in
                          // flight that are older than
                          // `age`: it is unknown whether they were executed.
    void giveUp(std::chrono::milliseconds age);
    void failLateRequests(); // fails requests that have waited too long; to be called periodically
    void stop();             // fails all waiting requests

private:
    using Connection = std::shared_ptr<Ice::Connection>;
    using Requests = std::vector<std::shared_ptr<Request>>;
    using Object = std::pair<Ice::Identity, std::string>; // identity and facet of an object
    enum { shortCalls, longCalls, lanes };
    struct Lane {
        Connection connection;
        bool isConnecting = false, isMissing = false;  // isMissing: the lane has no connection
                                                       // because no channel was free
        std::deque<std::shared_ptr<Request>> underWay; // requests that were sent, oldest first
        size_t requests = 0, bytes = 0;                // number and bytes of requests that are
                                                       // chosen or in flight
        bool isConfirming = false;
    };
    struct Subject {
        Turns<const Client*> turns;
        std::set<std::shared_ptr<Client>> clients;
        size_t bytes = 0, blocked = 0; // queued bytes of a subject; its blocked threads
    };
    std::shared_ptr<Client> clientOf(const Request& request);
    void forget(const Connection& connection);
    void dropIfOver(const std::shared_ptr<Client>& client);
    void restIfEmpty(const Client& client);
    bool hasRoom(const Request& request);
    int laneOf(const Request& request) const;
    bool mayGo(const Client& client) const;
    int laneToConnect() const;
    std::shared_ptr<Request> nextRequest();
    std::shared_ptr<Request> pop(const std::shared_ptr<Client>& client);
    void release(Request& request);
    void send();
    enum class Verdict { Goes, Waits, IsAsked, IsRefused };
    Verdict verdictOn(const std::shared_ptr<Request>& request);
    void ask(const Connection& connection, const Object& object);
    void answered(const Object& object, bool isKnown, bool isMaintenance, std::exception_ptr why);
    void recordProxies(const Request& request);
    void sendOne(const std::shared_ptr<Request>& request);
    void confirm(int lane, const Ice::Current& of);
    void finish(const std::shared_ptr<Request>& request, bool hasArrived,
                const std::function<void()>& answer);
    void connect(int lane);
    void opened(int lane, const Connection& connection);
    void closed(int lane, const Connection& connection);
    void failWaiting(std::chrono::steady_clock::time_point due, std::exception_ptr why);
    static void fail(const Requests& requests, std::exception_ptr why);
    void failAll(std::exception_ptr why);

    const std::shared_ptr<Ice::ObjectPrx> vehicle_;
    const std::chrono::seconds wait_;
    std::shared_ptr<Ice::ObjectAdapter> callbacks_;
    mutable std::mutex mutex_; // guards all members below
    std::condition_variable room_;
    Turns<std::string> turns_; // order in which subjects are served
    std::map<std::string, Subject> subjects_;
    std::map<Connection, std::shared_ptr<Client>> clients_;
    std::map<Ice::Identity, std::set<Connection>> owners_; // clients that own each object that the
                                                           // vehicle may call
    std::array<Lane, lanes> lanes_;
    std::set<std::shared_ptr<Request>> sent_;    // requests without a reply so far
    std::deque<std::shared_ptr<Request>> ready_; // requests that were chosen and may be
                                                 // sent
    std::map<Object, Requests> asked_;           // requests that wait until their object's
                                                 // type is known
    std::map<Object, bool> isMaintenance_;       // whether an object is for maintenance;
                                                 // valid for this session
    std::set<std::pair<Ice::Identity, std::string>> longReplies_; // objects and operations that had
                                                                  // long replies
    bool isSending_ = false, stopped_ = false, holds_ = false;
    unsigned connections_ = 0; // number of connections that were made to the vehicle so far
};

} // namespace gateway
