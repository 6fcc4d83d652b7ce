// SPDX-License-Identifier: MIT
//
// forwarder: the clients' queues and their turns.

#include "forwarder.h"

#include <algorithm>
#include <iostream>
#include <iterator>

namespace gateway {

namespace {

constexpr size_t mostUnderWay = 8;             // requests without an answer
constexpr size_t mostBytesUnderWay = 8192;     // of these together; a single longer one may go
constexpr size_t mostQueued = size_t{1} << 18; // bytes per client

} // namespace

void Request::sendTo(const std::shared_ptr<Ice::ObjectPrx>& target, Response onResponse,
                     Failure onError) const {
    auto object = target->ice_identity(current.id)->ice_facet(current.facet);
    object = object->ice_encodingVersion(current.encoding);
    object = isOneway() ? object->ice_oneway() : object->ice_twoway();
    const Parameters in{parameters.data(), parameters.data() + parameters.size()};
    std::function<void(bool)> sent; // Ice's only report about a one-way request
    if (isOneway())
        sent = [onResponse](bool) { onResponse(true, {}); };
    object->ice_invokeAsync(current.operation, current.mode, in, std::move(onResponse),
                            std::move(onError), std::move(sent), current.ctx);
}

Forwarder::Forwarder(const std::shared_ptr<Ice::ObjectPrx>& vehicle, std::chrono::seconds wait)
    : vehicle_(vehicle->ice_connectionCached(false)), wait_(wait) {} // else it gives a lost one

void Forwarder::setCallbacks(std::shared_ptr<Ice::ObjectAdapter> adapter) {
    callbacks_ = std::move(adapter);
}

// ---- from the clients to the vehicle ----

Forwarder::Client& Forwarder::clientAt(const Connection& connection) {
    const auto [client, isNew] = clients_.try_emplace(connection);
    if (isNew)
        connection->setCloseCallback([this](const Connection& closed) { forget(closed); });
    return client->second;
}

// Drops a client that has left, and its two-way requests; its one-way requests still go.
void Forwarder::forget(const Connection& connection) {
    std::lock_guard<std::mutex> lock(mutex_);
    const auto client = clients_.find(connection);
    if (client == clients_.end())
        return;
    auto& [requests, bytes, hasLeft] = client->second;
    const auto goes = [&bytes = bytes](const std::shared_ptr<Request>& request) {
        bytes -= request->isOneway() ? 0 : request->parameters.size();
        return !request->isOneway();
    };
    requests.erase(std::remove_if(requests.begin(), requests.end(), goes), requests.end());
    hasLeft = true;
    if (requests.empty())
        clients_.erase(client);
    for (auto owner = owners_.begin(); owner != owners_.end();)
        owner = owner->second == connection ? owners_.erase(owner) : std::next(owner);
    room_.notify_all();
}

void Forwarder::take(std::shared_ptr<Request> request) {
    const Connection& from = request->current.con;
    {
        std::unique_lock<std::mutex> lock(mutex_);
        room_.wait(lock, [&] { return stopped_ || clientAt(from).bytes < mostQueued; });
        if (stopped_)
            throw Ice::CommunicatorDestroyedException(__FILE__, __LINE__);
        if (holds_ && !connection_)
            throw Ice::ObjectNotExistException(__FILE__, __LINE__);
        Client& client = clientAt(from);
        client.bytes += request->parameters.size();
        client.requests.push_back(std::move(request));
    }
    send();
}

// Returns the next request by turn, if one may go now; the mutex is held.
std::shared_ptr<Request> Forwarder::nextRequest() {
    auto client = clients_.upper_bound(lastServed_);
    for (size_t i = 0; i < clients_.size(); ++i, ++client) {
        if (client == clients_.end())
            client = clients_.begin();
        auto& [requests, bytes, hasLeft] = client->second;
        if (requests.empty())
            continue;
        const size_t size = requests.front()->parameters.size();
        if (underWay_ > 0 &&
            (underWay_ >= mostUnderWay || bytesUnderWay_ + size > mostBytesUnderWay))
            return nullptr;
        auto request = std::move(requests.front());
        requests.pop_front();
        bytes -= size;
        lastServed_ = client->first;
        if (hasLeft && requests.empty())
            clients_.erase(client);
        return request;
    }
    return nullptr;
}

// Sends the requests that may go. One thread does so at a time, also for those that come meanwhile.
void Forwarder::send() {
    std::unique_lock<std::mutex> lock(mutex_);
    if (isSending_)
        return;
    for (isSending_ = true; !stopped_;) {
        if (!connection_) {
            bool wanted = false;
            for (const auto& [from, client] : clients_)
                wanted = wanted || !client.requests.empty();
            if (!wanted || isConnecting_)
                break;
            isConnecting_ = true;
            lock.unlock();
            connect();
            lock.lock();
            continue;
        }
        const auto request = nextRequest();
        if (!request)
            break;
        sent_.insert(request);
        ++underWay_;
        bytesUnderWay_ += request->parameters.size();
        room_.notify_all();
        const Connection connection = connection_;
        lock.unlock();
        sendOne(connection, request);
        lock.lock();
    }
    isSending_ = false;
}

void Forwarder::sendOne(const Connection& connection, const std::shared_ptr<Request>& request) {
    const auto done = [this, request](const std::function<void()>& answer) {
        bool isAwaited; // else it was given up
        {
            std::lock_guard<std::mutex> lock(mutex_);
            --underWay_;
            bytesUnderWay_ -= request->parameters.size();
            isAwaited = sent_.erase(request) != 0;
        }
        if (isAwaited)
            answer();
        send();
    };
    const auto failed = [request, done](std::exception_ptr why) {
        done([&] { fail({request}, why); });
    };
    try {
        request->sendTo(
            connection->createProxy(request->current.id),
            [request, done](bool isOk, const Parameters& out) {
                done([&] { request->response(isOk, out); });
            },
            failed);
    } catch (const Ice::Exception&) {
        failed(std::current_exception());
    }
}

void Forwarder::connect() {
    const auto opened = [this](const Connection& connection) {
        connection->setAdapter(callbacks_);
        {
            std::lock_guard<std::mutex> lock(mutex_);
            connection_ = connection;
            isConnecting_ = false;
            ++connections_;
        }
        connection->setCloseCallback([this](const Connection& closed) { // may be at once
            bool refuses;
            {
                std::lock_guard<std::mutex> lock(mutex_);
                if (connection_ == closed)
                    connection_ = nullptr;
                refuses = holds_;
            }
            if (refuses)
                refuseWaiting();
            send();
        });
        send();
    };
    try {
        vehicle_->ice_getConnectionAsync(
            opened, [this](std::exception_ptr why) { failAll(std::move(why)); });
    } catch (const Ice::Exception&) {
        failAll(std::current_exception());
    }
}

// Fails requests. Prints how many one-way ones are among them, since no client hears of these.
void Forwarder::fail(const Requests& requests, std::exception_ptr why) {
    size_t oneways = 0;
    for (const auto& request : requests) {
        oneways += request->isOneway();
        request->failed(why);
    }
    if (oneways == 0)
        return;
    const auto told = [oneways](const std::string& reason) {
        std::cerr << "gateway: one-way calls that were not sent: " + std::to_string(oneways) +
                         " (" + reason + ")\n";
    };
    try {
        std::rethrow_exception(why);
    } catch (const Ice::UnknownException& e) {
        told(e.unknown);
    } catch (const std::exception& e) {
        told(e.what());
    }
}

// Fails the waiting requests that came before `due`.
void Forwarder::failWaiting(std::chrono::steady_clock::time_point due, std::exception_ptr why) {
    Requests out;
    std::unique_lock<std::mutex> lock(mutex_);
    for (auto client = clients_.begin(); client != clients_.end();) {
        auto& [requests, bytes, hasLeft] = client->second;
        for (; !requests.empty() && requests.front()->since < due; requests.pop_front()) {
            bytes -= requests.front()->parameters.size();
            out.push_back(requests.front());
        }
        client = hasLeft && requests.empty() ? clients_.erase(client) : std::next(client);
    }
    room_.notify_all();
    lock.unlock();
    fail(out, why);
}

// Fails all waiting requests, since the vehicle cannot be reached.
void Forwarder::failAll(std::exception_ptr why) {
    {
        std::lock_guard<std::mutex> lock(mutex_);
        isConnecting_ = false;
    }
    failWaiting(std::chrono::steady_clock::time_point::max(), why);
}

void Forwarder::hold() {
    {
        std::lock_guard<std::mutex> lock(mutex_);
        holds_ = true;
        if (connection_ || isConnecting_ || stopped_)
            return;
        isConnecting_ = true;
    }
    connect();
}

unsigned Forwarder::session() const {
    std::lock_guard<std::mutex> lock(mutex_);
    return connection_ ? connections_ : 0;
}

void Forwarder::refuseWaiting() {
    failWaiting(std::chrono::steady_clock::time_point::max(),
                std::make_exception_ptr(Ice::ObjectNotExistException(__FILE__, __LINE__)));
}

void Forwarder::giveUp(std::chrono::milliseconds age) {
    Requests old;
    {
        std::lock_guard<std::mutex> lock(mutex_);
        const auto due = std::chrono::steady_clock::now() - age;
        std::copy_if(sent_.begin(), sent_.end(), std::back_inserter(old),
                     [due](const auto& request) { return request->since < due; });
        for (const auto& request : old)
            sent_.erase(request);
    }
    fail(old, std::make_exception_ptr(Ice::UnknownException(
                  __FILE__, __LINE__,
                  "icesoc-gateway: the vehicle went to another ground meanwhile; whether it has "
                  "carried this call out is unknown")));
}

void Forwarder::failLateRequests() {
    failWaiting(std::chrono::steady_clock::now() - wait_,
                std::make_exception_ptr(Ice::UnknownException(
                    __FILE__, __LINE__,
                    "icesoc-gateway: waited " + std::to_string(wait_.count()) +
                        " s for the radio (--wait); the vehicle has not got this call")));
}

void Forwarder::stop() {
    {
        std::lock_guard<std::mutex> lock(mutex_);
        stopped_ = true;
    }
    // Ice waits for the answers when it stops.
    failAll(std::make_exception_ptr(Ice::CommunicatorDestroyedException(__FILE__, __LINE__)));
}

// ---- from the vehicle to the clients ----

void Forwarder::takeCallback(std::shared_ptr<Request> request) {
    std::vector<Connection> clients; // the last is tried first
    {
        std::lock_guard<std::mutex> lock(mutex_);
        for (const auto& [connection, client] : clients_)
            clients.push_back(connection);
        const auto owner = owners_.find(request->current.id);
        if (owner != owners_.end())
            clients.push_back(owner->second);
        else if (clients_.count(lastServed_))
            clients.push_back(lastServed_);
    }
    tryClients(std::move(request), std::move(clients));
}

void Forwarder::tryClients(std::shared_ptr<Request> request, std::vector<Connection> clients) {
    const Ice::Current& current = request->current;
    if (clients.empty())
        return request->failed(std::make_exception_ptr(Ice::ObjectNotExistException(
            __FILE__, __LINE__, current.id, current.facet, current.operation)));
    const Connection connection = clients.back();
    clients.pop_back();
    // A one-way request needs an answer, too, to know whether the object is there.
    Request asked = *request;
    asked.current.requestId = 1;
    try {
        asked.sendTo(
            connection->createProxy(current.id),
            [this, request, connection](bool isOk, const Parameters& out) {
                {
                    std::lock_guard<std::mutex> lock(mutex_);
                    if (clients_.count(connection))
                        owners_[request->current.id] = connection;
                }
                request->response(isOk, out);
            },
            [this, request, clients](std::exception_ptr why) {
                try {
                    std::rethrow_exception(why);
                } catch (const Ice::ObjectNotExistException&) {
                    tryClients(request, clients);
                } catch (...) {
                    request->failed(why);
                }
            });
    } catch (const Ice::Exception&) { // it has just left
        tryClients(std::move(request), std::move(clients));
    }
}

} // namespace gateway
