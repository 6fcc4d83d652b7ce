// SPDX-License-Identifier: MIT
//
// addressees: finds the client that receives a request of the vehicle: the only client that has
// passed a proxy of the called object to the vehicle. If no client has ever passed such a proxy, it
// is the only client with a two-way call in progress. After the owner of an object has
// disconnected, no client receives a call to this object. Addressees has no lock: the forwarder
// holds a lock whenever it calls Addressees.

#pragma once

#include "client_queues.h"
#include "object_types.h"

namespace gateway {

class Addressees {
public:
    // Records that a client has passed proxies of these objects to the vehicle.
    void record(Client& client, const std::vector<Ice::Identity>& passed) {
        for (const Ice::Identity& object : passed)
            if (!client.hasLeft && client.objects < mostKnown)
                client.objects += owners_[object].insert(client.connection).second;
    }
    // Removes a client that has disconnected. Its objects keep entries without an owner. If there
    // are too many of these entries, removes them all; after that, a call to an object reaches a
    // client only if the client has passed a proxy of this object.
    void leave(const Connection& connection) {
        size_t ownerless = 0;
        for (auto& each : owners_) {
            each.second.erase(connection);
            ownerless += each.second.empty();
        }
        if (ownerless <= mostOwnerless)
            return;
        forgets_ = true;
        for (auto each = owners_.begin(); each != owners_.end();)
            each = each->second.empty() ? owners_.erase(each) : std::next(each);
    }
    // Returns the client that receives a call to `object`; null if no client or several clients
    // qualify. `sent`: the sent requests that have no reply yet.
    Connection of(const Ice::Identity& object,
                  const std::set<std::shared_ptr<Request>>& sent) const {
        std::set<Connection> candidates;
        const auto owner = owners_.find(object);
        if (owner != owners_.end())
            candidates = owner->second;
        else if (!forgets_)
            for (const auto& each : sent)
                if (each->client && !each->isOneway())
                    candidates.insert(each->current.con);
        return candidates.size() == 1 ? *candidates.begin() : nullptr;
    }

private:
    static constexpr size_t mostOwnerless = 10000;
    // connected clients of each object: the clients that have passed a proxy of this object
    std::map<Ice::Identity, std::set<Connection>> owners_;
    bool forgets_ = false; // true once entries without an owner have been dropped
};

} // namespace gateway
