// SPDX-License-Identifier: MIT
//
// client_queues: stores the waiting requests of each client, and groups the clients by subject.

#include "client_queues.h"

#include <algorithm>

namespace gateway {

namespace {

// number of bytes that is added to the size of each request when turns are computed
constexpr size_t requestCost = 100;

size_t costOf(const Client& client) {
    return client.requests.front()->bytes + requestCost;
}

// Returns the number of bytes of a waiting request that count against the limit of its subject.
size_t queuedBytes(const Request& request) {
    constexpr size_t administration = 500; // estimate of the memory that each request takes
    return request.bytes + administration;
}

} // namespace

std::shared_ptr<Client> ClientQueues::clientOf(const Request& request) {
    const Connection& from = request.current.con;
    std::shared_ptr<Client>& client = clients_[from];
    if (!client) {
        client = std::make_shared<Client>();
        client->connection = from;
        client->subject = request.subject;
        subjects_[request.subject].clients.insert(client);
        from->setCloseCallback([this](const Connection& closed) { onClosed_(closed); });
    }
    return client;
}

// Removes a client from the turns of its subject if the client has no waiting requests. Removes the
// subject from the turns if none of its clients has waiting requests.
void ClientQueues::restIfEmpty(const Client& client) {
    if (!client.requests.empty())
        return;
    Subject& subject = subjects_[client.subject];
    subject.turns.rest(&client);
    if (std::all_of(subject.clients.begin(), subject.clients.end(),
                    [](const auto& each) { return each->requests.empty(); }))
        turns_.rest(client.subject);
}

// Removes a client that has disconnected and has nothing more to send.
void ClientQueues::dropIfOver(const std::shared_ptr<Client>& client) {
    if (!client->hasLeft || !client->requests.empty())
        return;
    const auto subject = subjects_.find(client->subject);
    if (subject == subjects_.end())
        return;
    subject->second.turns.remove(client.get());
    subject->second.clients.erase(client);
    if (subject->second.clients.empty() && subject->second.blocked == 0)
        subjects_.erase(subject);
    clients_.erase(client->connection);
}

Requests ClientQueues::leave(const Connection& connection) {
    Requests dropped;
    const auto found = clients_.find(connection);
    if (found == clients_.end())
        return dropped;
    std::shared_ptr<Client> client = found->second;
    auto& requests = client->requests;
    const auto isDropped = [&](const std::shared_ptr<Request>& request) {
        if (request->isOneway())
            return false;
        subjects_[client->subject].bytes -= queuedBytes(*request);
        dropped.push_back(request);
        return true;
    };
    requests.erase(std::remove_if(requests.begin(), requests.end(), isDropped), requests.end());
    client->hasLeft = true;
    restIfEmpty(*client);
    dropIfOver(client);
    return dropped;
}

bool ClientQueues::hasRoom(const Request& request) {
    const bool isFirst = clientOf(request)->requests.empty();
    const Subject& subject = subjects_[request.subject];
    return (isFirst && subject.clients.size() <= mostClients) ||
           subject.bytes + queuedBytes(request) <= mostBytes;
}

bool ClientQueues::block(const std::string& subject) {
    size_t& blocked = subjects_[subject].blocked;
    if (blocked == mostBlocked)
        return false;
    ++blocked;
    return true;
}

void ClientQueues::add(std::shared_ptr<Request> request) {
    const std::shared_ptr<Client> client = clientOf(*request);
    Subject& subject = subjects_[client->subject];
    request->client = client;
    subject.bytes += queuedBytes(*request);
    client->requests.push_back(std::move(request));
    subject.turns.wait(client.get());
    turns_.wait(client->subject);
}

bool ClientQueues::isAnyWaiting(const MayGo& condition) const {
    return std::any_of(clients_.begin(), clients_.end(), [&](const auto& each) {
        return !each.second->requests.empty() && condition(*each.second);
    });
}

std::shared_ptr<Request> ClientQueues::pop(const std::shared_ptr<Client>& client) {
    std::shared_ptr<Request> request = client->requests.front();
    client->requests.pop_front();
    subjects_[client->subject].bytes -= queuedBytes(*request);
    restIfEmpty(*client);
    dropIfOver(client);
    return request;
}

// Returns the next client in turn among those clients of a subject that may send now; null if
// no client may send.
std::shared_ptr<Client> ClientQueues::firstOf(const Subject& subject, const MayGo& mayGo) const {
    std::shared_ptr<Client> first;
    uint64_t least = 0;
    for (const auto& client : subject.clients) {
        if (client->requests.empty() || !mayGo(*client))
            continue;
        const uint64_t after = subject.turns.after(client.get(), costOf(*client));
        if (!first || after < least) {
            first = client;
            least = after;
        }
    }
    return first;
}

std::shared_ptr<Request> ClientQueues::popNext(const MayGo& mayGo) {
    std::shared_ptr<Client> next;
    uint64_t least = 0;
    for (const auto& [name, subject] : subjects_) {
        const std::shared_ptr<Client> first = firstOf(subject, mayGo);
        if (!first)
            continue;
        const uint64_t after = turns_.after(name, costOf(*first));
        if (!next || after < least) {
            next = first;
            least = after;
        }
    }
    if (!next)
        return nullptr;
    const size_t cost = costOf(*next);
    turns_.take(next->subject, cost);
    subjects_[next->subject].turns.take(next.get(), cost);
    return pop(next);
}

Requests ClientQueues::popOlder(std::chrono::steady_clock::time_point due) {
    Requests out;
    // iterates over a copy, because pop removes disconnected clients from clients_
    const auto clients = clients_;
    for (const auto& [connection, client] : clients)
        while (!client->requests.empty() && client->requests.front()->since < due)
            out.push_back(pop(client));
    return out;
}

} // namespace gateway
