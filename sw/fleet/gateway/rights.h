// SPDX-License-Identifier: MIT
//
// rights: decides which clients of the gateway may call which operations, according to a JSON file
// of rules:
//
//   [{"who": "CN=pilot*", "identities": ["*"], "operations": ["*"]},
//    {"who": "",          "identities": ["uav", "hwengine*"], "operations": ["get*", "isAlive"]}]
//
// `who` is a shell pattern for the subject of the client's certificate; the subject of a client
// without a certificate is "". A call is allowed if at least one rule allows it. A client that may
// call at least one operation of an object may also ask for the object's type and ping the object.

#pragma once

#include <Ice/Ice.h>

namespace gateway {

class Rights {
public:
    Rights() = default; // allows every client to call every operation
    // Reads the rules. Throws std::runtime_error with the reason if the file has another format.
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

// Returns the subject of the client's certificate on a connection; empty if the client has no
// certificate.
std::string subjectOf(const std::shared_ptr<Ice::Connection>& connection);

} // namespace gateway
