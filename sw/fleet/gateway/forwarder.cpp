// SPDX-License-Identifier: MIT
//
// forwarder: the clients' queues, the order in which they are served, and the two lanes
// (connections) to the vehicle.

#include "forwarder.h"
#include "passed_proxies.h"

#include <algorithm>
#include <iostream>
#include <iterator>

namespace gateway {

struct Client {
    std::shared_ptr<Ice::Connection> connection;
    std::string subject;
    std::deque<std::shared_ptr<Request>> requests;
    size_t underWay = 0;  // number of requests that may not have reached the vehicle yet
    int lane = 0;         // lane on which these requests were sent
    size_t objects = 0;   // number of objects that it has passed to the vehicle
    bool hasLeft = false; // true if the client has disconnected and only its one-way requests
                          // remain
};

namespace {

const char* const maintenanceType = "::IceSoC::Maintenance"; // selected by metadata
                                                             // [":maintenance"]

constexpr size_t longBytes = 512;  // size in bytes above which a call or reply uses the lane for
                                   // long messages
constexpr size_t mostUnderWay = 8; // requests of a lane
// Bytes in flight, short lane and long lane; a single longer request is allowed.
constexpr size_t mostBytesUnderWay[] = {1536, 8192};
constexpr size_t mostUnconfirmed = 4;          // one-way requests after which a ping must confirm
                                               // their arrival
constexpr size_t mostQueued = size_t{1} << 18; // largest number of queued bytes of one subject
constexpr size_t mostClients = 200;            // largest number of clients of one subject; each may
                                               // queue at least one request
constexpr size_t mostBlocked = 16;             // largest number of threads that wait for room for
                                               // one subject
constexpr size_t mostKnown = 1000;             // largest number of objects and operations that are
                                               // remembered
constexpr size_t requestCost = 100;            // fixed cost of a request when turns are computed,
                                               // in addition to its bytes

size_t costOf(const Request& request) {
    return request.parameters.size() + requestCost;
}

std::exception_ptr unknown(const std::string& why) {
    return std::make_exception_ptr(
        Ice::UnknownException(__FILE__, __LINE__, "icesoc-gateway: " + why));
}

std::exception_ptr refusal(const Ice::Identity& maintained) {
    return unknown("'" + Ice::identityToString(maintained) +
                   "' is for maintenance: call it at the endpoint of --maintenance");
}

} // namespace

void Request::sendTo(const std::shared_ptr<Ice::ObjectPrx>& target, Response onResponse,
                     Failure onError) const {
    auto object = target->ice_identity(current.id)->ice_facet(current.facet);
    object = object->ice_encodingVersion(current.encoding);
    object = isOneway() ? object->ice_oneway() : object->ice_twoway();
    const Parameters in{parameters.data(), parameters.data() + parameters.size()};
    std::function<void(bool)> sent; // called when Ice has sent a one-way request, which has no
                                    // other result
    if (isOneway())
        sent = [onResponse](bool) { onResponse(true, {}); };
    object->ice_invokeAsync(current.operation, current.mode, in, std::move(onResponse),
                            std::move(onError), std::move(sent), current.ctx);
}

Forwarder::Forwarder(const std::shared_ptr<Ice::ObjectPrx>& vehicle, std::chrono::seconds wait)
    : vehicle_(vehicle->ice_connectionCached(false)), wait_(wait) {
} // without cached connection, Ice could
  // return a connection that has been lost

void Forwarder::setCallbacks(std::shared_ptr<Ice::ObjectAdapter> adapter) {
    callbacks_ = std::move(adapter);
}

// ---- clients to vehicle ----

std::shared_ptr<Client> Forwarder::clientOf(const Request& request) {
    const Connection& from = request.current.con;
    std::shared_ptr<Client>& client = clients_[from];
    if (!client) {
        client = std::make_shared<Client>();
        client->connection = from;
        client->subject = request.subject;
        subjects_[request.subject].clients.insert(client);
        from->setCloseCallback([this](const Connection& closed) { forget(closed); });
    }
    return client;
}

// Ends the turns of a client that has nothing more to send. Also ends the turns of its subject, if
// no other client of the subject has anything to send.
void Forwarder::restIfEmpty(const Client& client) {
    if (!client.requests.empty())
        return;
    Subject& subject = subjects_[client.subject];
    subject.turns.rest(&client);
    if (std::all_of(subject.clients.begin(), subject.clients.end(),
                    [](const auto& each) { return each->requests.empty(); }))
        turns_.rest(client.subject);
}

// Removes a client that has disconnected and has nothing more to send.
void Forwarder::dropIfOver(const std::shared_ptr<Client>& client) {
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

// Drops the two-way requests of a client that has disconnected; its one-way requests are still
// sent.
void Forwarder::forget(const Connection& connection) {
    std::lock_guard<std::mutex> lock(mutex_);
    const auto found = clients_.find(connection);
    if (found == clients_.end())
        return;
    const std::shared_ptr<Client> client = found->second;
    auto& requests = client->requests;
    const auto goes = [&](const std::shared_ptr<Request>& request) {
        subjects_[client->subject].bytes -= request->isOneway() ? 0 : request->parameters.size();
        return !request->isOneway();
    };
    requests.erase(std::remove_if(requests.begin(), requests.end(), goes), requests.end());
    client->hasLeft = true;
    restIfEmpty(*client);
    dropIfOver(client);
    for (auto owner = owners_.begin(); owner != owners_.end();) {
        owner->second.erase(connection);
        owner = owner->second.empty() ? owners_.erase(owner) : std::next(owner);
    }
    room_.notify_all();
}

// Returns whether a request may wait here. The first request of a client always may, unless its
// subject has too many clients. These include disconnected clients with waiting one-way requests,
// so that a subject gains nothing by reconnecting.
bool Forwarder::hasRoom(const Request& request) {
    const bool isFirst = clientOf(request)->requests.empty();
    const Subject& subject = subjects_[request.subject];
    return (isFirst && subject.clients.size() <= mostClients) ||
           subject.bytes + request.parameters.size() <= mostQueued;
}

void Forwarder::take(std::shared_ptr<Request> request) {
    {
        std::unique_lock<std::mutex> lock(mutex_);
        if (!hasRoom(*request) && !stopped_) {
            if (subjects_[request->subject].blocked == mostBlocked) {
                lock.unlock();
                if (request->isOneway()) // a one-way request has no reply: its loss is only noticed
                                         // when the connection closes
                    request->current.con->close(Ice::ConnectionClose::Forcefully);
                throw Ice::UnknownException(__FILE__, __LINE__,
                                            "icesoc-gateway: '" + request->subject +
                                                "' has too much waiting: at most " +
                                                std::to_string(mostQueued) + " bytes");
            }
            ++subjects_[request->subject].blocked;
            room_.wait(lock, [&] { return stopped_ || hasRoom(*request); });
            --subjects_[request->subject].blocked;
        }
        if (stopped_)
            throw Ice::CommunicatorDestroyedException(__FILE__, __LINE__);
        if (holds_ && !lanes_[shortCalls].connection)
            throw Ice::ObjectNotExistException(__FILE__, __LINE__);
        const std::shared_ptr<Client> client = clientOf(*request);
        Subject& subject = subjects_[client->subject];
        request->client = client;
        subject.bytes += request->parameters.size();
        client->requests.push_back(std::move(request));
        subject.turns.wait(client.get());
        turns_.wait(client->subject);
    }
    send();
}

int Forwarder::laneOf(const Request& request) const {
    const Ice::Current& current = request.current;
    const bool isLong = request.parameters.size() > longBytes ||
                        longReplies_.count({current.id, current.operation}) != 0;
    return isLong && !lanes_[longCalls].isMissing ? longCalls : shortCalls;
}

// Returns whether a client's first request may be sent now.
bool Forwarder::mayGo(const Client& client) const {
    if (client.requests.empty())
        return false;
    const Request& request = *client.requests.front();
    const int number = laneOf(request);
    const Lane& lane = lanes_[number];
    return lane.connection && (client.underWay == 0 || client.lane == number) &&
           (lane.requests == 0 ||
            (lane.requests < mostUnderWay &&
             lane.bytes + request.parameters.size() <= mostBytesUnderWay[number]));
}

// Returns a lane that has waiting requests and no connection; -1 if none.
int Forwarder::laneToConnect() const {
    for (const auto& [connection, client] : clients_) {
        if (client->requests.empty())
            continue;
        const int lane = lanes_[shortCalls].connection ? laneOf(*client->requests.front()) : 0;
        if (!lanes_[lane].connection && !lanes_[lane].isConnecting)
            return lane;
    }
    return -1;
}

std::shared_ptr<Request> Forwarder::pop(const std::shared_ptr<Client>& client) {
    const std::shared_ptr<Request> request = client->requests.front();
    client->requests.pop_front();
    subjects_[client->subject].bytes -= request->parameters.size();
    restIfEmpty(*client);
    dropIfOver(client);
    room_.notify_all();
    return request;
}

// Returns the next request in turn if it may be sent now. The caller holds the mutex.
std::shared_ptr<Request> Forwarder::nextRequest() {
    std::shared_ptr<Client> next;
    uint64_t least = 0;
    for (const auto& [name, subject] : subjects_) {
        std::shared_ptr<Client> first; // first client of the subject
        uint64_t leastHere = 0;
        for (const auto& client : subject.clients) {
            if (!mayGo(*client))
                continue;
            const uint64_t after =
                subject.turns.after(client.get(), costOf(*client->requests.front()));
            if (!first || after < leastHere) {
                first = client;
                leastHere = after;
            }
        }
        if (!first)
            continue;
        const uint64_t after = turns_.after(name, costOf(*first->requests.front()));
        if (!next || after < least) {
            next = first;
            least = after;
        }
    }
    if (!next)
        return nullptr;
    const size_t cost = costOf(*next->requests.front());
    turns_.take(next->subject, cost);
    subjects_[next->subject].turns.take(next.get(), cost);
    const int lane = laneOf(*next->requests.front());
    const auto request = pop(next);
    request->lane = next->lane = lane;
    ++next->underWay;
    ++lanes_[lane].requests;
    lanes_[lane].bytes += request->parameters.size();
    request->isCounted = true;
    return request;
}

// Records that a request has arrived, or that it can no longer arrive.
void Forwarder::release(Request& request) {
    if (!request.isCounted)
        return;
    request.isCounted = false;
    --lanes_[request.lane].requests;
    lanes_[request.lane].bytes -= request.parameters.size();
    if (request.client)
        --request.client->underWay;
}

// Sends the requests that may be sent. One thread at a time does this; it also sends requests that
// arrive in the meantime.
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
        const Verdict verdict = verdictOn(request);
        const Connection connection = lanes_[shortCalls].connection;
        lock.unlock();
        if (verdict == Verdict::Goes)
            sendOne(request);
        else if (verdict == Verdict::IsAsked)
            ask(connection, {request->current.id, request->current.facet});
        else if (verdict == Verdict::IsRefused)
            finish(request, false, [&] { fail({request}, refusal(request->current.id)); });
        lock.lock();
    }
    isSending_ = false;
}

// ---- objects for maintenance: the gateway asks the vehicle once for the type of each object ----

Forwarder::Verdict Forwarder::verdictOn(const std::shared_ptr<Request>& request) {
    const Object object{request->current.id, request->current.facet};
    const auto known = isMaintenance_.find(object);
    if (request->mayMaintain || (known != isMaintenance_.end() && !known->second))
        return Verdict::Goes;
    if (known != isMaintenance_.end())
        return Verdict::IsRefused;
    Requests& waiting = asked_[object];
    waiting.push_back(request);
    return waiting.size() == 1 ? Verdict::IsAsked : Verdict::Waits;
}

void Forwarder::ask(const Connection& connection, const Object& object) {
    const auto failed = [this, object](std::exception_ptr why) {
        try {
            std::rethrow_exception(why);
        } catch (const Ice::RequestFailedException&) { // the object may exist later
            answered(object, false, false, nullptr);
        } catch (const Ice::MarshalException&) { // the object answers any request, but not with a
                                                 // type
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

// Sends the requests that waited for an object's type, or fails them, if the object is for
// maintenance. If the type remains unknown, they fail with `why`.
void Forwarder::answered(const Object& object, bool isKnown, bool isMaintenance,
                         std::exception_ptr why) {
    Requests waiting;
    {
        std::lock_guard<std::mutex> lock(mutex_);
        waiting.swap(asked_[object]);
        asked_.erase(object);
        if (isMaintenance_.size() >= mostKnown)
            isMaintenance_.clear();
        if (isKnown && lanes_[shortCalls].connection)
            isMaintenance_[object] = isMaintenance;
        for (const auto& request : waiting) {
            request->mayMaintain = !isMaintenance; // this request is sent without asking for the
                                                   // type again
            if (!why && !isMaintenance)
                ready_.push_back(request);
        }
    }
    if (why || isMaintenance)
        for (const auto& request : waiting)
            finish(request, false, [&] { fail({request}, why ? why : refusal(object.first)); });
    send();
}

// ---- the lanes ----

// Records the client as owner of the objects that a request passes to the vehicle. Every client may
// call ice_ping and similar operations, which pass no objects.
void Forwarder::recordProxies(const Request& request) {
    if (!request.client || request.current.operation.compare(0, 4, "ice_") == 0)
        return;
    const auto passed = passedProxies(request.parameters);
    std::lock_guard<std::mutex> lock(mutex_);
    Client& client = *request.client;
    for (const Ice::Identity& object : passed)
        if (!client.hasLeft && client.objects < mostKnown)
            client.objects += owners_[object].insert(client.connection).second;
}

// Sends a request on its lane. It is called only by the thread that is in send().
void Forwarder::sendOne(const std::shared_ptr<Request>& request) {
    recordProxies(*request);
    const auto failed = [this, request](std::exception_ptr why) {
        finish(request, false, [&] { fail({request}, why); });
    };
    Connection connection;
    bool isUnsure = false; // true if one-way requests were sent of which the arrival is unknown
    {
        std::lock_guard<std::mutex> lock(mutex_);
        Lane& lane = lanes_[request->lane];
        connection = lane.connection;
        lane.underWay.push_back(request);
        if (request->isOneway())
            isUnsure = request->lane == longCalls || lane.underWay.size() >= mostUnconfirmed;
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

// Sends a ping unless one is pending. Its reply confirms that all earlier requests have arrived.
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
        ++lane.requests;
        lane.bytes += ping->parameters.size();
        ping->isCounted = true;
        sent_.insert(ping);
    }
    sendOne(ping);
}

// Ends a request. If it has arrived, requests sent before it have also arrived.
void Forwarder::finish(const std::shared_ptr<Request>& request, bool hasArrived,
                       const std::function<void()>& answer) {
    bool isAwaited; // false after giveUp: nobody waits for the connection any more
    {
        std::lock_guard<std::mutex> lock(mutex_);
        auto& underWay = lanes_[request->lane].underWay;
        const auto at = std::find(underWay.begin(), underWay.end(), request);
        if (hasArrived && at != underWay.end()) {
            for (auto each = underWay.begin(); each != std::next(at); ++each)
                release(**each);
            underWay.erase(underWay.begin(), std::next(at));
        } else if (!request->isOneway() || at == underWay.end()) {
            release(*request);
            if (at != underWay.end())
                underWay.erase(at);
        }
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
    }); // this function may be called immediately
    send();
}

void Forwarder::closed(int number, const Connection& connection) {
    bool refuses = false;
    {
        std::lock_guard<std::mutex> lock(mutex_);
        Lane& lane = lanes_[number];
        if (lane.connection == connection) {
            for (const auto& request : lane.underWay)
                release(*request);
            lane.underWay.clear();
            lane.connection = nullptr;
            lane.isConfirming = false;
            refuses = holds_ && number == shortCalls;
            if (number == shortCalls) {
                isMaintenance_.clear(); // the next vehicle may have other objects
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
            return failAll(std::move(why));
        { // the vehicle or this ground station has no free channel for a lane
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

// Fails requests. Prints the number of one-way requests, because their clients receive no error.
void Forwarder::fail(const Requests& requests, std::exception_ptr why) {
    size_t oneways = 0;
    for (const auto& request : requests) {
        oneways += request->isOneway();
        request->failed(why);
    }
    if (oneways == 0)
        return;
    const auto report = [oneways](const std::string& reason) {
        std::cerr << "gateway: one-way calls that were not sent: " + std::to_string(oneways) +
                         " (" + reason + ")\n";
    };
    try {
        std::rethrow_exception(why);
    } catch (const Ice::UnknownException& e) {
        report(e.unknown);
    } catch (const std::exception& e) {
        report(e.what());
    }
}

// Fails the waiting requests that arrived before `due`.
void Forwarder::failWaiting(std::chrono::steady_clock::time_point due, std::exception_ptr why) {
    Requests out;
    {
        std::lock_guard<std::mutex> lock(mutex_);
        const auto clients = clients_; // pop removes disconnected clients
        for (const auto& [connection, client] : clients)
            while (!client->requests.empty() && client->requests.front()->since < due)
                out.push_back(pop(client));
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
    fail(old, unknown("the vehicle went to another ground meanwhile; whether it has carried this "
                      "call out is unknown"));
}

void Forwarder::failLateRequests() {
    failWaiting(std::chrono::steady_clock::now() - wait_,
                unknown("waited " + std::to_string(wait_.count()) +
                        " s for the radio (--wait); the vehicle has not got this call"));
    // Calls that the vehicle answers late fill a lane. A ping shows that they have arrived.
    for (int number = 0; number < lanes; ++number) {
        Ice::Current last;
        {
            std::lock_guard<std::mutex> lock(mutex_);
            if (isSending_ || lanes_[number].underWay.empty())
                continue;
            last = lanes_[number].underWay.back()->current;
            isSending_ = true;
        }
        confirm(number, last);
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
    // When Ice stops, it waits for the answers of all requests.
    failAll(std::make_exception_ptr(Ice::CommunicatorDestroyedException(__FILE__, __LINE__)));
}

// ---- vehicle to clients ----

void Forwarder::takeCallback(std::shared_ptr<Request> request) {
    const Ice::Current& current = request->current;
    Connection addressee;
    {
        std::lock_guard<std::mutex> lock(mutex_);
        const auto owner = owners_.find(current.id);
        if (owner != owners_.end()) {
            if (owner->second.size() == 1) // with several owners, the client to call is ambiguous
                addressee = *owner->second.begin();
        } else {
            std::set<Connection> callers;
            for (const auto& each : sent_)
                if (each->client && !each->isOneway())
                    callers.insert(each->current.con);
            if (callers.size() == 1)
                addressee = *callers.begin();
        }
    }
    const auto isMissing = [request](const Ice::Current& at) {
        request->failed(std::make_exception_ptr(
            Ice::ObjectNotExistException(__FILE__, __LINE__, at.id, at.facet, at.operation)));
    };
    if (!addressee)
        return isMissing(current);
    // A one-way request is sent two-way, because only a reply shows whether the object exists.
    Request asked = *request;
    asked.current.requestId = 1;
    try {
        asked.sendTo(addressee->createProxy(current.id), request->response, request->failed);
    } catch (const Ice::Exception&) { // the client has just disconnected
        isMissing(current);
    }
}

} // namespace gateway
