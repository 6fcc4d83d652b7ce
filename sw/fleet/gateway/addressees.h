// SPDX-License-Identifier: MIT
//
// addressees: finds the client that receives a request of the vehicle: the only client that has
// passed a proxy of the called object to the vehicle. If no client has ever passed such a proxy, it
// is the only client with a two-way call in progress. After the owner of an object has
// disconnected, no client receives a call to this object. While the owner is connected, clients of
// other subjects cannot pass a proxy of the object. Addressees has no lock: the forwarder holds a
// lock whenever it calls Addressees.

#pragma once

#include "client_queues.h"
#include "object_types.h"

#include <optional>

namespace gateway {

class Addressees {
public:
    // Records that a client has passed proxies of these objects to the vehicle. If one of the
    // objects surely belongs to connected clients of another subject, records nothing and returns
    // this object. `isSure`: other parameters hardly look like these proxies.
    std::optional<Ice::Identity> record(Client& client, const std::vector<Ice::Identity>& passed,
                                        bool isSure) {
        for (const Ice::Identity& object : passed) {
            const auto found = owners_.find(object);
            if (found != owners_.end() && !found->second.connections.empty() &&
                found->second.subject != client.subject && found->second.isSure)
                return object;
        }
        for (const Ice::Identity& object : passed)
            if (!client.hasLeft && client.objects < mostKnown) {
                Owners& owners = owners_[object];
                if (owners.connections.empty())
                    owners = {client.subject, false, {}};
                owners.isSure |= isSure && owners.subject == client.subject;
                client.objects += owners.connections.insert(client.connection).second;
            }
        return std::nullopt;
    }
    // Removes a client that has disconnected. Its objects keep entries without an owner. If there
    // are too many of these entries, removes them all; after that, a call to an object reaches a
    // client only if the client has passed a proxy of this object.
    void leave(const Connection& connection) {
        size_t ownerless = 0;
        for (auto& each : owners_) {
            each.second.connections.erase(connection);
            ownerless += each.second.connections.empty();
        }
        if (ownerless <= mostOwnerless)
            return;
        forgets_ = true;
        for (auto each = owners_.begin(); each != owners_.end();)
            each = each->second.connections.empty() ? owners_.erase(each) : std::next(each);
    }
    // Returns the client that receives a call to `object`; null if no client or several clients
    // qualify. `sent`: the sent requests that have no reply yet.
    Connection of(const Ice::Identity& object,
                  const std::set<std::shared_ptr<Request>>& sent) const {
        std::set<Connection> candidates;
        const auto owner = owners_.find(object);
        if (owner != owners_.end())
            candidates = owner->second.connections;
        else if (!forgets_)
            for (const auto& each : sent)
                if (each->client && !each->isOneway())
                    candidates.insert(each->current.con);
        return candidates.size() == 1 ? *candidates.begin() : nullptr;
    }

private:
    static constexpr size_t mostOwnerless = 10000;
    // The connected clients that have passed a proxy of an object, and their common subject.
    struct Owners {
        std::string subject;
        bool isSure = false;
        std::set<Connection> connections;
    };
    std::map<Ice::Identity, Owners> owners_;
    bool forgets_ = false; // true once entries without an owner have been dropped
};

} // namespace gateway
