// SPDX-License-Identifier: MIT
//
// rights: reads the file of rules, and matches clients and calls with the patterns in the rules.

#include "rights.h"

#include <IceSSL/IceSSL.h>
#include <fnmatch.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sys/stat.h>

namespace gateway {

namespace {

bool matches(const std::string& pattern, const std::string& text) {
    return fnmatch(pattern.c_str(), text.c_str(), 0) == 0;
}

bool matchesOne(const std::vector<std::string>& patterns, const std::string& text) {
    for (const std::string& pattern : patterns)
        if (matches(pattern, text))
            return true;
    return false;
}

} // namespace

Rights::Rights(const std::string& path) : isOpen_(false) {
    struct stat found{};
    if (stat(path.c_str(), &found) == 0 && !S_ISREG(found.st_mode))
        throw std::runtime_error("rights file '" + path + "': expected a regular file");
    std::ifstream file(path);
    if (!file)
        throw std::runtime_error("cannot read rights file '" + path + "'");
    if (found.st_mode & S_IWOTH)
        throw std::runtime_error("other users may write to rights file '" + path +
                                 "': chmod o-w '" + path + "'");
    const auto refuse = [&path](const std::string& why) {
        throw std::runtime_error("rights file '" + path +
                                 "': expected rules such as [{\"who\": \"CN=pilot*\", "
                                 "\"identities\": [\"*\"], \"operations\": [\"*\"]}]; " +
                                 why);
    };
    try {
        const auto rules = nlohmann::json::parse(file);
        if (!rules.is_array())
            refuse("the file is not a list");
        for (const auto& rule : rules) {
            rules_.push_back({rule.at("who"), rule.at("identities"), rule.at("operations")});
            if (rule.size() != 3)
                refuse("rule " + std::to_string(rules_.size()) +
                       " has more than these three members");
        }
    } catch (const nlohmann::json::parse_error& e) {
        refuse("invalid JSON at byte " + std::to_string(e.byte));
    } catch (const nlohmann::json::exception&) {
        refuse("rule " + std::to_string(rules_.size() + 1) +
               " lacks one of these members, or has one of another type");
    }
}

bool Rights::permit(const std::string& subject, const std::string& identity,
                    const std::string& operation) const {
    static const std::set<std::string> always = {"ice_ping", "ice_isA", "ice_id", "ice_ids"};
    for (const Rule& rule : rules_)
        if (matches(rule.who, subject) && matchesOne(rule.identities, identity) &&
            (always.count(operation) || matchesOne(rule.operations, operation)))
            return true;
    return isOpen_;
}

std::string subjectOf(const std::shared_ptr<Ice::Connection>& connection) {
    for (auto info = connection->getInfo(); info; info = info->underlying)
        if (auto ssl = std::dynamic_pointer_cast<IceSSL::ConnectionInfo>(info))
            return ssl->certs.empty() ? "" : std::string(ssl->certs[0]->getSubjectDN());
    return "";
}

} // namespace gateway
