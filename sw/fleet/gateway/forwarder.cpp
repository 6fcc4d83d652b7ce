// SPDX-License-Identifier: MIT
//
// forwarder: sends the clients' calls on the two lanes to the vehicle, and passes on the vehicle's
// calls.

#include "forwarder.h"
#include "packet_line.h"
#include "passed_proxies.h"
#include "reason.h"

#include <algorithm>
#include <iostream>
#include <iterator>

namespace gateway {

namespace {

// type id of interfaces with metadata [":maintenance"]
const char* const maintenanceType = "::IceSoC::Maintenance";

// size in bytes above which a call or reply uses the lane for long messages
constexpr size_t longBytes = 512;

std::exception_ptr refusal(const Ice::Identity& maintained) {
    return unknown("'" + Ice::identityToString(maintained) +
                   "' is a maintenance object: call it at the endpoint given with --maintenance");
}

// Reports the loss of a one-way request. It has no reply, so the client only notices the loss if
// its connection is closed. A datagram has no connection of its own: all clients of the endpoint
// share it.
void reportLoss(const Request& request, const std::string& why) {
    if (!request.isOneway())
        return;
    if (request.current.con->type() == "udp")
        std::cerr << "gateway: dropped a datagram: " + why + "\n";
    else
        request.current.con->close(Ice::ConnectionClose::Forcefully);
}

[[noreturn]] void refuse(const Request& request, const std::string& why) {
    reportLoss(request, why);
    std::rethrow_exception(unknown(why));
}

} // namespace

Forwarder::Forwarder(const std::shared_ptr<Ice::ObjectPrx>& vehicle, std::chrono::seconds wait)
    : vehicle_(vehicle->ice_connectionCached(false)), wait_(wait) {
    // The proxy does not cache its connection, because a cached connection may already be
    // lost.
}

void Forwarder::setCallbacks(std::shared_ptr<Ice::ObjectAdapter> adapter) {
    callbacks_ = std::move(adapter);
}

// ---- clients to vehicle ----

void Forwarder::forget(const Connection& connection) {
    Requests dropped;
    {
        std::lock_guard<std::mutex> lock(mutex_);
        dropped = queues_.leave(connection);
        addressees_.leave(connection);
        room_.notify_all();
    }
    fail(dropped, std::make_exception_ptr(Ice::ConnectionLostException(__FILE__, __LINE__)));
}

void Forwarder::take(std::shared_ptr<Request> request) {
    if (request->bytes > LINK_MAX_MESSAGE)
        refuse(*request, "a message of " + std::to_string(request->bytes) +
                             " bytes is too long for the radio link (at most " +
                             std::to_string(LINK_MAX_MESSAGE) + " bytes)");
    {
        std::unique_lock<std::mutex> lock(mutex_);
        if (!queues_.hasRoom(*request) && !stopped_) {
            if (!queues_.block(request->subject)) {
                lock.unlock();
                refuse(*request, "'" + request->subject +
                                     "' has too many waiting requests: the limit is " +
                                     std::to_string(ClientQueues::mostBytes) + " bytes");
            }
            room_.wait(lock, [&] { return stopped_ || queues_.hasRoom(*request); });
            queues_.unblock(request->subject);
        }
        if (stopped_)
            throw Ice::CommunicatorDestroyedException(__FILE__, __LINE__);
        if (holds_ && !lanes_[shortCalls].connection)
            throw Ice::ObjectNotExistException(__FILE__, __LINE__);
        queues_.add(std::move(request));
    }
    send();
}

int Forwarder::laneOf(const Request& request) const {
    const Ice::Current& current = request.current;
    const bool isLong =
        request.bytes > longBytes || longReplies_.count({current.id, current.operation}) != 0;
    return isLong && !lanes_[longCalls].isMissing ? longCalls : shortCalls;
}

// Returns whether the oldest request of a client may be sent now.
bool Forwarder::mayGo(const Client& client) const {
    const Request& request = *client.requests.front();
    const int number = laneOf(request);
    const Lane& lane = lanes_[number];
    return (client.underWay == 0 || client.lane == number) && lane.accepts(request.bytes);
}

// Returns a lane that has no connection although requests wait for this lane; -1 if no such
// lane exists.
int Forwarder::laneToConnect() const {
    const bool isConnected = lanes_[shortCalls].connection != nullptr;
    int found = -1;
    queues_.isAnyWaiting([&](const Client& client) {
        const int lane = isConnected ? laneOf(*client.requests.front()) : int(shortCalls);
        if (!lanes_[lane].connection && !lanes_[lane].isConnecting)
            found = lane;
        return found >= 0;
    });
    return found;
}

// Removes and returns the next request that may be sent now; returns null if none exists. The
// caller holds the mutex.
std::shared_ptr<Request> Forwarder::nextRequest() {
    auto request = queues_.popNext([this](const Client& client) { return mayGo(client); });
    if (!request)
        return nullptr;
    room_.notify_all();
    request->lane = request->client->lane = laneOf(*request);
    ++request->client->underWay;
    lanes_[request->lane].count(*request);
    return request;
}

// Sends all requests that may be sent. Only one thread at a time executes this loop. This thread
// also sends the requests that other threads queue in the meantime.
void Forwarder::send() {
    std::unique_lock<std::mutex> lock(mutex_);
    if (isSending_)
        return;
    for (isSending_ = true; !stopped_;) {
        const int lane = laneToConnect();
        if (lane >= 0) {
            lanes_[lane].isConnecting = true;
            lock.unlock();
            connect(lane);
            lock.lock();
            continue;
        }
        std::shared_ptr<Request> request;
        if (ready_.empty()) {
            request = nextRequest();
        } else {
            request = ready_.front();
            ready_.pop_front();
        }
        if (!request)
            break;
        sent_.insert(request);
        const ObjectTypes::Verdict verdict = types_.verdictOn(request);
        const Connection connection = lanes_[shortCalls].connection;
        lock.unlock();
        if (verdict == ObjectTypes::Verdict::Goes)
            sendOne(request);
        else if (verdict == ObjectTypes::Verdict::Asks)
            ask(connection, ObjectTypes::objectOf(*request));
        else if (verdict == ObjectTypes::Verdict::Refused)
            finish(request, false, [&] { fail({request}, refusal(request->current.id)); });
        lock.lock();
    }
    isSending_ = false;
}

// ---- maintenance objects: the gateway asks the vehicle once for the type of each object ----

void Forwarder::ask(const Connection& connection, const Object& object) {
    const auto failed = [this, object](std::exception_ptr why) {
        try {
            std::rethrow_exception(why);
        } catch (const Ice::RequestFailedException&) {
            // the object does not exist now, but may exist later
            answered(object, false, false, nullptr);
        } catch (const Ice::MarshalException&) {
            // the vehicle has replied, but this object cannot report a type
            answered(object, true, false, nullptr);
        } catch (...) {
            answered(object, false, false, why);
        }
    };
    try {
        if (!connection)
            throw Ice::ConnectionLostException(__FILE__, __LINE__);
        connection->createProxy(object.first)
            ->ice_facet(object.second)
            ->ice_isAAsync(
                maintenanceType, [this, object](bool is) { answered(object, true, is, nullptr); },
                failed);
    } catch (const Ice::Exception&) {
        failed(std::current_exception());
    }
}

// Handles the requests that waited for an object's type: fails them if the object is a maintenance
// object, otherwise sends them. If the vehicle could not be asked for the type, fails them with the
// error `why`.
void Forwarder::answered(const Object& object, bool isKnown, bool isMaintenance,
                         std::exception_ptr why) {
    Requests waiting;
    {
        std::lock_guard<std::mutex> lock(mutex_);
        waiting = types_.answered(object);
        if (isKnown && lanes_[shortCalls].connection)
            types_.record(object, isMaintenance);
        for (const auto& request : waiting) {
            // send() then sends this request without asking for the type again
            request->mayMaintain = !isMaintenance;
            if (!why && !isMaintenance)
                ready_.push_back(request);
        }
    }
    if (why || isMaintenance)
        for (const auto& request : waiting)
            finish(request, false,
                   [&] { fail({request}, why ? explained(why) : refusal(object.first)); });
    send();
}

// ---- the lanes ----

// Records the client as an owner of all objects that a request passes to the vehicle as proxies.
// Skips the operations that every object has, such as ice_ping, because they pass no proxies.
// Returns false, after failing the request, if one of the objects belongs to a client of another
// subject.
bool Forwarder::recordProxies(const std::shared_ptr<Request>& request) {
    if (!request->client || request->current.operation.compare(0, 4, "ice_") == 0)
        return true;
    const auto passed = passedProxies(request->parameters);
    std::optional<Ice::Identity> others;
    {
        std::lock_guard<std::mutex> lock(mutex_);
        // With encoding 1.0, a text before zeros looks like a proxy.
        const bool isSure = request->current.encoding != Ice::Encoding_1_0;
        others = addressees_.record(*request->client, passed, isSure);
    }
    if (!others)
        return true;
    const std::string why = "a proxy of '" + Ice::identityToString(*others) +
                            "' belongs to another client: use a UUID as the identity";
    reportLoss(*request, why);
    finish(request, false, [&] { fail({request}, unknown(why)); });
    return false;
}

// Sends a request on its lane. Only the thread that executes send() calls this function.
void Forwarder::sendOne(const std::shared_ptr<Request>& request) {
    if (!recordProxies(request))
        return;
    const auto failed = [this, request](std::exception_ptr why) {
        finish(request, false, [&] { fail({request}, explained(why)); });
    };
    Connection connection;
    // true if it is unknown whether the one-way requests sent so far have arrived
    bool isUnsure = false;
    {
        std::lock_guard<std::mutex> lock(mutex_);
        Lane& lane = lanes_[request->lane];
        connection = lane.connection;
        lane.begin(request);
        if (request->isOneway())
            isUnsure = request->lane == longCalls || lane.inFlight() >= Lane::mostUnconfirmed;
    }
    try {
        if (!connection)
            throw Ice::ConnectionLostException(__FILE__, __LINE__);
        request->sendTo(
            connection->createProxy(request->current.id),
            [this, request](bool isOk, const Parameters& out) {
                finish(request, !request->isOneway(), [&] { request->response(isOk, out); });
                if (out.second - out.first <= std::ptrdiff_t(longBytes))
                    return;
                std::lock_guard<std::mutex> lock(mutex_);
                if (longReplies_.size() >= mostKnown)
                    longReplies_.clear();
                longReplies_.insert({request->current.id, request->current.operation});
            },
            failed);
    } catch (const Ice::Exception&) {
        failed(std::current_exception());
    }
    if (isUnsure)
        confirm(request->lane, request->current);
}

// Sends a ping unless another ping is pending. The reply to the ping confirms that all earlier
// requests have arrived.
void Forwarder::confirm(int number, const Ice::Current& of) {
    const auto done = [this, number] {
        std::lock_guard<std::mutex> lock(mutex_);
        lanes_[number].isConfirming = false;
    };
    Ice::Current current = of;
    current.operation = "ice_ping";
    current.mode = Ice::OperationMode::Nonmutating;
    current.requestId = 1;
    current.ctx.clear();
    current.encoding = Ice::currentEncoding;
    static const Ice::Byte empty[] = {6, 0, 0, 0, 1, 1};
    const auto ping = std::make_shared<Request>(
        Parameters{empty, empty + sizeof empty}, [done](bool, const Parameters&) { done(); },
        [done](std::exception_ptr) { done(); }, current);
    ping->lane = number;
    {
        std::lock_guard<std::mutex> lock(mutex_);
        Lane& lane = lanes_[number];
        if (lane.isConfirming || !lane.connection)
            return;
        lane.isConfirming = true;
        lane.count(*ping);
        sent_.insert(ping);
    }
    sendOne(ping);
}

// Ends a request. If the request has arrived, all requests sent before it on the same lane have
// also arrived.
void Forwarder::finish(const std::shared_ptr<Request>& request, bool hasArrived,
                       const std::function<void()>& answer) {
    bool isAwaited; // false if giveUp has already failed this request
    {
        std::lock_guard<std::mutex> lock(mutex_);
        lanes_[request->lane].end(request, hasArrived);
        isAwaited = sent_.erase(request) != 0;
    }
    if (isAwaited)
        answer();
    send();
}

void Forwarder::opened(int lane, const Connection& connection) {
    connection->setAdapter(callbacks_);
    {
        std::lock_guard<std::mutex> lock(mutex_);
        lanes_[lane].connection = connection;
        lanes_[lane].isConnecting = false;
        connections_ += lane == shortCalls;
    }
    connection->setCloseCallback([this, lane](const Connection& over) {
        closed(lane, over);
    }); // Ice may call this function before setCloseCallback returns
    send();
}

void Forwarder::closed(int number, const Connection& connection) {
    bool refuses = false;
    {
        std::lock_guard<std::mutex> lock(mutex_);
        Lane& lane = lanes_[number];
        if (lane.connection == connection) {
            lane.disconnect();
            refuses = holds_ && number == shortCalls;
            if (number == shortCalls) {
                types_.clear();
                lanes_[longCalls].isMissing = false;
            }
        }
    }
    if (refuses)
        refuseWaiting();
    send();
}

void Forwarder::connect(int lane) {
    const auto failed = [this, lane](std::exception_ptr why) {
        if (lane == shortCalls)
            return failAll(explained(why));
        // the lane for long calls has no connection, because the vehicle or this ground station has
        // no free channel
        {
            std::lock_guard<std::mutex> lock(mutex_);
            lanes_[lane].isConnecting = false;
            lanes_[lane].isMissing = true;
        }
        send();
    };
    try {
        vehicle_->ice_connectionId(lane == longCalls ? "long" : "")
            ->ice_getConnectionAsync(
                [this, lane](const Connection& connection) { opened(lane, connection); }, failed);
    } catch (const Ice::Exception&) {
        failed(std::current_exception());
    }
}

// Fails the waiting requests that arrived before `due`.
void Forwarder::failWaiting(std::chrono::steady_clock::time_point due, std::exception_ptr why) {
    Requests out;
    {
        std::lock_guard<std::mutex> lock(mutex_);
        out = queues_.popOlder(due);
        room_.notify_all();
    }
    fail(out, why);
}

// Fails all waiting requests, since the vehicle cannot be reached.
void Forwarder::failAll(std::exception_ptr why) {
    {
        std::lock_guard<std::mutex> lock(mutex_);
        lanes_[shortCalls].isConnecting = false;
    }
    failWaiting(std::chrono::steady_clock::time_point::max(), why);
}

void Forwarder::hold() {
    {
        std::lock_guard<std::mutex> lock(mutex_);
        holds_ = true;
        Lane& lane = lanes_[shortCalls];
        if (lane.connection || lane.isConnecting || stopped_)
            return;
        lane.isConnecting = true;
    }
    connect(shortCalls);
}

unsigned Forwarder::session() const {
    std::lock_guard<std::mutex> lock(mutex_);
    return lanes_[shortCalls].connection ? connections_ : 0;
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
    fail(old, unknown("the vehicle has connected to another ground station; it may or may not have "
                      "executed this call"));
}

void Forwarder::failLateRequests() {
    failWaiting(std::chrono::steady_clock::now() - wait_,
                unknown("waited " + std::to_string(wait_.count()) +
                        " s for the radio (limit: --wait); the call was not sent to the vehicle"));
    // Calls in flight count against the limits of their lane until they have arrived, even if the
    // vehicle replies late. A ping is therefore sent: its reply confirms that these calls have
    // arrived.
    for (int number = 0; number < lanes; ++number) {
        std::shared_ptr<Request> latest;
        {
            std::lock_guard<std::mutex> lock(mutex_);
            latest = lanes_[number].latest();
            if (isSending_ || !latest)
                continue;
            isSending_ = true;
        }
        confirm(number, latest->current);
        {
            std::lock_guard<std::mutex> lock(mutex_);
            isSending_ = false;
        }
        send();
    }
}

void Forwarder::stop() {
    {
        std::lock_guard<std::mutex> lock(mutex_);
        stopped_ = true;
        room_.notify_all();
    }
    // The waiting requests fail here, because the destruction of the communicator waits until all
    // requests have a reply.
    failAll(std::make_exception_ptr(Ice::CommunicatorDestroyedException(__FILE__, __LINE__)));
}

// ---- vehicle to clients ----

void Forwarder::takeCallback(std::shared_ptr<Request> request) {
    const Ice::Current& current = request->current;
    Connection addressee;
    {
        std::lock_guard<std::mutex> lock(mutex_);
        addressee = addressees_.of(current.id, sent_);
    }
    const auto isMissing = [request](const Ice::Current& at) {
        request->failed(std::make_exception_ptr(
            Ice::ObjectNotExistException(__FILE__, __LINE__, at.id, at.facet, at.operation)));
    };
    if (!addressee)
        return isMissing(current);
    // The vehicle's one-way request is sent to the client as a two-way request, because only a
    // reply shows whether the object exists.
    Request asked = *request;
    asked.current.requestId = 1;
    try {
        asked.sendTo(addressee->createProxy(current.id), request->response, request->failed);
    } catch (const Ice::Exception&) { // the client has just disconnected
        isMissing(current);
    }
}

} // namespace gateway
