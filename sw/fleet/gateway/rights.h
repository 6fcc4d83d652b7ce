// SPDX-License-Identifier: MIT
//
// rights: gives clients of the gateway the right to call operations, by a JSON file of rules:
//
//   [{"who": "CN=pilot*", "identities": ["*"], "operations": ["*"]},
//    {"who": "",          "identities": ["uav", "hwengine*"], "operations": ["get*", "isAlive"]}]
//
// `who` is the subject of the client's certificate, as a shell pattern; a client without a
// certificate has the subject "". A call passes if one rule allows it. Every caller of an
// object may ask it for its type and ping it.

#pragma once

#include <Ice/Ice.h>

namespace gateway {

class Rights {
public:
    Rights() = default; // everybody may call everything
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
