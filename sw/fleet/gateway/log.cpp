// SPDX-License-Identifier: MIT
//
// log: an Ice plugin that is linked with the gateway. It wraps the logger of the communicator.

#include "log.h"
#include "reason.h"

#include <Ice/Ice.h>
#include <algorithm>

namespace gateway {

namespace {

class Log : public Ice::Logger {
public:
    explicit Log(std::shared_ptr<Ice::Logger> to) : to_(std::move(to)) {}
    void print(const std::string& message) override { to_->print(withoutPositions(message)); }
    void trace(const std::string& category, const std::string& message) override {
        to_->trace(category, withoutPositions(message));
    }
    void warning(const std::string& message) override { to_->warning(withoutPositions(message)); }
    void error(const std::string& message) override { to_->error(withoutPositions(message)); }
    std::string getPrefix() override { return to_->getPrefix(); }
    std::shared_ptr<Ice::Logger> cloneWithPrefix(const std::string& prefix) override {
        return std::make_shared<Log>(to_->cloneWithPrefix(prefix));
    }

private:
    const std::shared_ptr<Ice::Logger> to_;
};

bool endsWith(const std::string& text, const std::string& end) {
    return text.size() >= end.size() &&
           text.compare(text.size() - end.size(), end.size(), end) == 0;
}

// Returns whether a word is a position in source code, such as "src/Ice/Network.cpp:12:".
bool isPosition(const std::string& word) {
    const size_t size = word.size(); // at least "a.h:1:"
    if (size < 6 || word.back() != ':')
        return false;
    const size_t colon = word.find_last_not_of("0123456789", size - 2);
    const std::string path = word.substr(0, colon == std::string::npos ? 0 : colon);
    return colon < size - 2 && word[colon] == ':' &&
           (endsWith(path, ".cpp") || endsWith(path, ".h"));
}

// Returns a word; if it is the name of an exception class, returns this name split into words.
std::string inWords(const std::string& word) {
    const size_t end = word.find_last_not_of(":.,") + 1;
    const std::string name = word.substr(0, end);
    if (name.compare(0, 2, "::") != 0 || !endsWith(name, "Exception"))
        return word;
    return nameInWords(name) + word.substr(end);
}

// Ice creates the plugin before it loads the other plugins.
Ice::Plugin* createLog(const std::shared_ptr<Ice::Communicator>& ic, const std::string&,
                       const Ice::StringSeq&) {
    return new Ice::LoggerPlugin(ic, std::make_shared<Log>(ic->getLogger()));
}

} // namespace

void installLog() {
    Ice::registerPluginFactory("IceSoCLog", createLog, true);
}

std::string withoutPositions(const std::string& message) {
    std::string text;
    for (size_t at = 0, end; at < message.size(); at = end + 1) {
        end = std::min(message.find_first_of(" \n", at), message.size());
        const std::string word = message.substr(at, end - at);
        if (isPosition(word))
            continue; // also drops the space after it
        text += inWords(word);
        text += message.substr(end, 1);
    }
    return text;
}

} // namespace gateway
