// SPDX-License-Identifier: MIT
//
// object_types: which of the vehicle's objects are for maintenance. The gateway asks the vehicle
// once per session for the type of each object; requests to an object of unknown type wait here.
// It has no lock: the forwarder calls it under its own.

#pragma once

#include "request.h"

#include <map>

namespace gateway {

constexpr size_t mostKnown = 1000; // objects, or operations, that are remembered

class ObjectTypes {
public:
    using Object = std::pair<Ice::Identity, std::string>; // identity and facet
    static Object objectOf(const Request& request) {
        return {request.current.id, request.current.facet};
    }

    // Asks: the caller is to ask the vehicle, and to report the type to answered().
    enum class Verdict { Goes, Waits, Asks, Refused };
    Verdict verdictOn(const std::shared_ptr<Request>& request) {
        const Object object = objectOf(*request);
        const auto known = isMaintenance_.find(object);
        if (request->mayMaintain || (known != isMaintenance_.end() && !known->second))
            return Verdict::Goes;
        if (known != isMaintenance_.end())
            return Verdict::Refused;
        Requests& waiting = waiting_[object];
        waiting.push_back(request);
        return waiting.size() == 1 ? Verdict::Asks : Verdict::Waits;
    }
    // Returns the requests that waited for an object's type.
    Requests answered(const Object& object) {
        Requests waiting;
        waiting.swap(waiting_[object]);
        waiting_.erase(object);
        return waiting;
    }
    // Records an object's type until the end of the session.
    void record(const Object& object, bool isMaintenance) {
        if (isMaintenance_.size() >= mostKnown)
            isMaintenance_.clear();
        isMaintenance_[object] = isMaintenance;
    }
    // Forgets all types: the next vehicle may have other objects.
    void clear() { isMaintenance_.clear(); }

private:
    std::map<Object, Requests> waiting_;
    std::map<Object, bool> isMaintenance_;
};

} // namespace gateway
