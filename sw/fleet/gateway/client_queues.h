// SPDX-License-Identifier: MIT
//
// client_queues: the requests of all clients that wait for their turn.
//
// Bytes are shared evenly (turns.h) among the subjects (certificates, or hosts without one), and
// the share of each subject evenly among its connections. The requests of one client keep their
// order. The queues have no lock: the forwarder calls them under its own.

#pragma once

#include "request.h"
#include "turns.h"

#include <deque>
#include <map>
#include <set>

namespace gateway {

struct Client {
    Connection connection;
    std::string subject;
    std::deque<std::shared_ptr<Request>> requests; // waiting, oldest first
    size_t underWay = 0;  // number of requests that may not have reached the vehicle yet
    int lane = 0;         // lane on which these requests were sent
    size_t objects = 0;   // number of objects that it has passed to the vehicle
    bool hasLeft = false; // true if the client has disconnected; its one-way requests remain
};

class ClientQueues {
public:
    static constexpr size_t mostBytes = size_t{1} << 18; // queued bytes of one subject
    static constexpr size_t mostClients = 200; // clients of one subject; each may queue one request
    static constexpr size_t mostBlocked = 16;  // threads that wait for room for one subject

    // `onClosed`: called when a client's connection has closed, without the caller's lock.
    explicit ClientQueues(std::function<void(const Connection&)> onClosed)
        : onClosed_(std::move(onClosed)) {}

    // Returns whether a request may wait here. The first request of a client always may, unless its
    // subject has too many clients. These include disconnected clients with waiting one-way
    // requests, so that a subject gains nothing by reconnecting.
    bool hasRoom(const Request& request);
    // Counts a thread that waits for room. Returns false if the subject has too many of them.
    bool block(const std::string& subject);
    void unblock(const std::string& subject) { --subjects_[subject].blocked; }
    void add(std::shared_ptr<Request> request);
    // Drops the two-way requests of a client that has disconnected; its one-way requests remain.
    // Returns the client, or null if the connection has none.
    std::shared_ptr<Client> leave(const Connection& connection);

    using MayGo = std::function<bool(const Client&)>;
    // Returns whether any client with waiting requests satisfies a condition.
    bool isAnyWaiting(const MayGo& condition) const;
    // Removes and returns the next request by turn of the clients that may send theirs now; null if
    // there is none.
    std::shared_ptr<Request> popNext(const MayGo& mayGo);
    // Removes and returns the requests that arrived before `due`.
    Requests popOlder(std::chrono::steady_clock::time_point due);

private:
    struct Subject {
        Turns<const Client*> turns;
        std::set<std::shared_ptr<Client>> clients;
        size_t bytes = 0, blocked = 0; // queued bytes of a subject; its blocked threads
    };
    std::shared_ptr<Client> clientOf(const Request& request);
    std::shared_ptr<Client> firstOf(const Subject& subject, const MayGo& mayGo) const;
    std::shared_ptr<Request> pop(const std::shared_ptr<Client>& client);
    void restIfEmpty(const Client& client);
    void dropIfOver(const std::shared_ptr<Client>& client);

    const std::function<void(const Connection&)> onClosed_;
    Turns<std::string> turns_; // order in which subjects are served
    std::map<std::string, Subject> subjects_;
    std::map<Connection, std::shared_ptr<Client>> clients_;
};

} // namespace gateway
