// SPDX-License-Identifier: MIT
//
// lane: one of the gateway's two connections to the vehicle, and the requests in flight on it.
//
// On one connection, a short message would wait for the long messages before it. There are
// therefore two: a lane for short calls, and a lane for calls that are long or have long replies.
// Few requests are in flight on each lane. A one-way request counts as in flight until the reply to
// a later request shows that it has arrived. Lane has no lock: the forwarder holds a lock whenever
// it uses a Lane.

#pragma once

#include "client_queues.h"

#include <algorithm>
#include <deque>
#include <iterator>

namespace gateway {

enum { shortCalls, longCalls, lanes };

class Lane {
public:
    static constexpr size_t mostUnderWay = 8; // limit of the requests in flight
    // number of requests after which one-way requests need a ping; the reply to the ping confirms
    // that they have arrived
    static constexpr size_t mostUnconfirmed = 4;

    // `mostBytes` is the limit of the bytes in flight. If no request is in flight, the lane accepts
    // a request of any size.
    explicit Lane(size_t mostBytes) : mostBytes_(mostBytes) {}

    Connection connection; // null if the lane is not connected
    bool isConnecting = false;
    bool isMissing = false;    // true if the lane has no connection, because no channel was free
    bool isConfirming = false; // true while a ping is pending

    // Returns whether a request of this size may be sent now.
    bool accepts(size_t bytes) const {
        return connection &&
               (requests_ == 0 || (requests_ < mostUnderWay && bytes_ + bytes <= mostBytes_));
    }
    // Counts a request that has been chosen for sending as in flight.
    void count(Request& request) {
        request.isCounted = true;
        ++requests_;
        bytes_ += request.bytes;
    }
    // Stops counting a request as in flight, because it has arrived or can no longer arrive.
    void release(Request& request) {
        if (!request.isCounted)
            return;
        request.isCounted = false;
        --requests_;
        bytes_ -= request.bytes;
        if (request.client)
            --request.client->underWay;
    }

    // Records that a request is being sent.
    void begin(std::shared_ptr<Request> request) { sent_.push_back(std::move(request)); }
    // Ends a request. If it has arrived, all requests sent before it have also arrived. A one-way
    // request that is not known to have arrived remains in flight.
    void end(const std::shared_ptr<Request>& request, bool hasArrived) {
        const auto at = std::find(sent_.begin(), sent_.end(), request);
        if (at == sent_.end()) {
            release(*request);
        } else if (hasArrived) {
            for (auto each = sent_.begin(); each != std::next(at); ++each)
                release(**each);
            sent_.erase(sent_.begin(), std::next(at));
        } else if (!request->isOneway()) {
            release(*request);
            sent_.erase(at);
        }
    }
    size_t inFlight() const { return sent_.size(); }
    // Returns the request that was sent last; null if none is in flight.
    std::shared_ptr<Request> latest() const { return sent_.empty() ? nullptr : sent_.back(); }

    // Handles the loss of the connection: none of the requests in flight can arrive any more.
    void disconnect() {
        for (const auto& request : sent_)
            release(*request);
        sent_.clear();
        connection = nullptr;
        isConfirming = false;
    }

private:
    const size_t mostBytes_;
    size_t requests_ = 0, bytes_ = 0;           // number and bytes of the requests in flight
    std::deque<std::shared_ptr<Request>> sent_; // requests that were sent, oldest first
};

} // namespace gateway
