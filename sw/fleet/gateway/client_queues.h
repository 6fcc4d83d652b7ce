// SPDX-License-Identifier: MIT
//
// client_queues: holds the waiting requests of all clients, and picks the next one to send.
//
// A client is a connection to the gateway. Its subject is the subject of its certificate, or its
// host if it has no certificate. The bytes that the link can carry are shared evenly among the
// subjects (turns.h), and the share of a subject evenly among its clients. The requests of one
// client keep their order. ClientQueues has no lock: the forwarder holds a lock whenever it calls
// ClientQueues.

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
    std::deque<std::shared_ptr<Request>> requests; // waiting requests, oldest first
    size_t underWay = 0;  // number of sent requests that may not have reached the vehicle yet
    int lane = 0;         // lane on which the client's latest request was sent
    size_t objects = 0;   // number of objects that this client has passed to the vehicle
    bool hasLeft = false; // true if the client has disconnected; its one-way requests remain
};

class ClientQueues {
public:
    static constexpr size_t mostBytes = size_t{1} << 18; // limit of the queued bytes of one subject
    // limit of the clients of a subject that may each queue one request even if the subject has
    // reached mostBytes
    static constexpr size_t mostClients = 200;
    // limit of the threads of a subject that may wait for room in the queues
    static constexpr size_t mostBlocked = 16;

    // `onClosed` is called when a client's connection has closed, and must acquire the forwarder's
    // lock itself.
    explicit ClientQueues(std::function<void(const Connection&)> onClosed)
        : onClosed_(std::move(onClosed)) {}

    // Returns whether there is room for a request in the queues. The first request of a client
    // always has room, unless the subject has too many clients. A disconnected client still counts
    // while its one-way requests wait, so a subject cannot get more room by reconnecting.
    bool hasRoom(const Request& request);
    // Counts a thread that waits for room. Returns false if too many threads of the subject already
    // wait.
    bool block(const std::string& subject);
    void unblock(const std::string& subject) { --subjects_[subject].blocked; }
    void add(std::shared_ptr<Request> request);
    // Removes and returns the two-way requests of a client that has disconnected; the client's
    // one-way requests remain. The caller must fail the returned requests: Ice considers a
    // connection ended only when each of its two-way requests has a reply.
    Requests leave(const Connection& connection);

    using MayGo = std::function<bool(const Client&)>;
    // Returns whether the condition is true for at least one client that has waiting requests.
    bool isAnyWaiting(const MayGo& condition) const;
    // Among the clients that may send now, chooses the next client in turn; removes and
    // returns this client's oldest request. Returns null if no client may send.
    std::shared_ptr<Request> popNext(const MayGo& mayGo);
    // Removes and returns the requests that arrived before `due`.
    Requests popOlder(std::chrono::steady_clock::time_point due);

private:
    struct Subject {
        Turns<const Client*> turns;
        std::set<std::shared_ptr<Client>> clients;
        // bytes of the subject's queued requests; number of its blocked threads
        size_t bytes = 0, blocked = 0;
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
