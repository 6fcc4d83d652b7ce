// SPDX-License-Identifier: MIT
//
// addressees: finds the client to which a request of the vehicle belongs. It is the only client
// that has passed the vehicle a proxy of the called object. If no client has passed such a proxy,
// it is the only client with a two-way call in progress. Addressees has no lock: the forwarder
// calls it while it holds its own lock.

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
    // Returns the client that a call to an object is for; null if no client or several clients
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
    // clients that have passed a proxy of an object, by object
    std::map<Ice::Identity, std::set<Connection>> owners_;
};

} // namespace gateway
