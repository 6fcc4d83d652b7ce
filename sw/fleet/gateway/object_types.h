// SPDX-License-Identifier: MIT
//
// object_types: remembers which objects of the vehicle are maintenance objects. The gateway asks
// the vehicle once per session for the type of each object. Until the type is known, requests to
// the object wait here. ObjectTypes has no lock: the forwarder holds a lock whenever it calls
// ObjectTypes.

#pragma once

#include "request.h"

#include <map>

namespace gateway {

constexpr size_t mostKnown = 1000; // limit of the remembered objects or operations

class ObjectTypes {
public:
    using Object = std::pair<Ice::Identity, std::string>; // identity and facet of an object
    static Object objectOf(const Request& request) {
        return {request.current.id, request.current.facet};
    }

    // Decision about a request. Goes: the caller must send the request. Waits: the request waits
    // here for the object's type. Asks: the request also waits, and the caller must ask the
    // vehicle for the type and then call answered(). Refused: the caller must fail the request.
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
    // Removes and returns the requests that waited for the type of an object.
    Requests answered(const Object& object) {
        Requests waiting;
        waiting.swap(waiting_[object]);
        waiting_.erase(object);
        return waiting;
    }
    // Records the type of an object until the session ends.
    void record(const Object& object, bool isMaintenance) {
        if (isMaintenance_.size() >= mostKnown)
            isMaintenance_.clear();
        isMaintenance_[object] = isMaintenance;
    }
    // Forgets all types. Another vehicle, which may connect next, may have other objects.
    void clear() { isMaintenance_.clear(); }

private:
    std::map<Object, Requests> waiting_;
    std::map<Object, bool> isMaintenance_;
};

} // namespace gateway
