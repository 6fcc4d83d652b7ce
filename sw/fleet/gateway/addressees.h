// SPDX-License-Identifier: MIT
//
// addressees: finds the client that receives a request of the vehicle. This is the only client that
// has passed the vehicle a proxy of the called object. If no client has passed such a proxy, it is
// the only client with a two-way call in progress. Addressees has no lock: the forwarder holds a
// lock whenever it calls Addressees.

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
    void leave(const Connection& connection) {
        for (auto owner = owners_.begin(); owner != owners_.end();) {
            owner->second.erase(connection);
            owner = owner->second.empty() ? owners_.erase(owner) : std::next(owner);
        }
    }
    // Returns the client that receives a call to `object`; null if no client or several clients
    // qualify. `sent`: requests of clients that have no reply yet.
    Connection of(const Ice::Identity& object,
                  const std::set<std::shared_ptr<Request>>& sent) const {
        std::set<Connection> candidates;
        const auto owner = owners_.find(object);
        if (owner != owners_.end())
            candidates = owner->second;
        else
            for (const auto& each : sent)
                if (each->client && !each->isOneway())
                    candidates.insert(each->current.con);
        return candidates.size() == 1 ? *candidates.begin() : nullptr;
    }

private:
    // for each object, the clients that have passed a proxy of this object
    std::map<Ice::Identity, std::set<Connection>> owners_;
};

} // namespace gateway
