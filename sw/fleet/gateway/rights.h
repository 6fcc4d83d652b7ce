// SPDX-License-Identifier: MIT
//
// rights: defines which clients of the gateway may call which operations, by a JSON file of rules:
//
//   [{"who": "CN=pilot*", "identities": ["*"], "operations": ["*"]},
//    {"who": "",          "identities": ["uav", "hwengine*"], "operations": ["get*", "isAlive"]}]
//
// `who` is a shell pattern for the subject of the client's certificate; a client without a
// certificate has the subject "". A call is allowed if one rule allows it. Every caller of an
// object may also ask for its type and ping it.

#pragma once

#include <Ice/Ice.h>

namespace gateway {

class Rights {
public:
    Rights() = default; // every client may call every operation
    // Throws std::runtime_error with the reason if the file has another form.
    explicit Rights(const std::string& path);

    bool permit(const std::string& subject, const std::string& identity,
                const std::string& operation) const;

private:
    struct Rule {
        std::string who;
        std::vector<std::string> identities, operations;
    };
    bool isOpen_ = true;
    std::vector<Rule> rules_;
};

// Returns the subject of the certificate of a connection's peer; empty without one.
std::string subjectOf(const std::shared_ptr<Ice::Connection>& connection);

} // namespace gateway
