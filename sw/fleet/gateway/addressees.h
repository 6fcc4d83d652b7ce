// SPDX-License-Identifier: MIT
//
// addressees: the client to which a request of the vehicle belongs: the only one that has passed
// the vehicle a proxy of the object; without such a client, the only one with a two-way call in
// progress. It has no lock: the forwarder calls it under its own.

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
    // Returns the addressee of a call to an object, or null if no client or several clients
    // qualify. `sent`: the clients' requests without a reply so far.
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
    std::map<Ice::Identity, std::set<Connection>> owners_; // by object that the vehicle calls
};

} // namespace gateway
