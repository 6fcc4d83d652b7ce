// SPDX-License-Identifier: MIT
//
// pages: checks the origins and cookies of browsers, and starts the program that serves the
// gateway's page.

#include "pages.h"

#include <algorithm>
#include <csignal>
#include <random>
#include <strings.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace gateway {

namespace {

// Returns 32 hexadecimal digits from the system's random source.
std::string drawSecret() {
    std::random_device source;
    std::string secret;
    while (secret.size() < 32)
        secret += "0123456789abcdef"[source() % 16];
    return secret;
}

// Finds an object of class `Wanted` in the information about a connection or endpoint. The
// information is a chain of objects, one for each layer of the transport. Returns null if none of
// them has this class.
template <class Wanted, class Info> std::shared_ptr<Wanted> layer(std::shared_ptr<Info> info) {
    for (; info; info = info->underlying)
        if (auto found = std::dynamic_pointer_cast<Wanted>(info))
            return found;
    return nullptr;
}

// Returns the value of an HTTP header. Ignores the case of header names, because browsers use
// different cases.
std::string header(const Ice::HeaderDict& headers, const char* name) {
    for (const auto& [key, value] : headers)
        if (strcasecmp(key.c_str(), name) == 0)
            return value;
    return "";
}

bool isLoopback(const std::string& host) {
    return host == "127.0.0.1" || host == "localhost" || host == "[::1]";
}

// Returns the folder of this program.
std::string here() {
    std::vector<char> path(4096);
    const ssize_t size = readlink("/proc/self/exe", path.data(), path.size());
    const std::string text(path.data(), size > 0 ? size : 0);
    return text.substr(0, text.rfind('/'));
}

} // namespace

Pages::Pages(const Options& o) : o_(o), secret_(drawSecret()) {
    if (o.page.empty())
        return;
    const size_t colon = o.page.rfind(':');
    host_ = o.page.substr(0, colon);
    port_ = colon == std::string::npos ? "" : o.page.substr(colon + 1);
    if (host_.empty() || port_.empty() || port_.size() > 5 ||
        port_.find_first_not_of("0123456789") != std::string::npos || std::stoul(port_) > 65535 ||
        std::stoul(port_) == 0)
        throw std::runtime_error("--page: expected HOST:PORT with a port of 1 to 65535, got '" +
                                 o.page + "'");
    const std::vector<std::string> names =
        isLoopback(host_) ? std::vector<std::string>{"127.0.0.1", "localhost", "[::1]"}
                          : std::vector<std::string>{host_};
    for (const std::string& name : names)
        for (const std::string scheme : {"http", "https"})
            origins_.push_back(scheme + "://" + name +
                               (port_ == (scheme == "http" ? "80" : "443") ? "" : ":" + port_));
}

Pages::~Pages() {
    stop();
}

void Pages::stop() {
    if (server_ > 0) {
        kill(server_, SIGTERM);
        waitpid(server_, nullptr, 0);
        server_ = -1;
    }
}

std::string Pages::refusal(const std::shared_ptr<Ice::Connection>& connection) const {
    const auto socket = connection ? layer<Ice::WSConnectionInfo>(connection->getInfo()) : nullptr;
    const std::string origin = socket ? header(socket->headers, "Origin") : "";
    if (origin.empty() ||
        std::find(o_.origins.begin(), o_.origins.end(), origin) != o_.origins.end())
        return "";
    if (std::find(origins_.begin(), origins_.end(), origin) == origins_.end())
        return "pages from " + origin + " are not allowed to call; --origin " + origin +
               " allows them";
    const std::string cookies = "; " + header(socket->headers, "Cookie") + ";";
    if (cookies.find("; icesoc-" + port_ + "=" + secret_ + ";") == std::string::npos)
        return "this page was loaded from an earlier gateway: reload it";
    return "";
}

std::string Pages::endpoints(bool hasCertificate) const {
    const std::string given = endpointsOf(o_.listen);
    if (o_.page.empty() || given.find("ws ") == 0 || given.find("wss ") == 0 ||
        given.find(":ws ") != std::string::npos || given.find(":wss ") != std::string::npos)
        return o_.listen;
    const std::string host = host_.front() == '[' ? host_.substr(1, host_.size() - 2) : host_;
    return given + (hasCertificate ? ":wss -h \"" : ":ws -h \"") + host + "\" -p 0";
}

void Pages::add(const std::string& vehicle, const std::shared_ptr<Ice::ObjectAdapter>& adapter) {
    if (o_.page.empty())
        return;
    for (const auto& endpoint : adapter->getEndpoints()) {
        const auto info = endpoint->getInfo();
        const auto ip = layer<Ice::IPEndpointInfo>(info);
        if (!ip || !layer<Ice::WSEndpointInfo>(info))
            continue;
        protocol_ = info->secure() ? "wss" : "ws";
        vehicles_.push_back(vehicle + "=" + protocol_ + ":" + std::to_string(ip->port));
        return;
    }
    throw std::runtime_error("--page: vehicle '" + vehicle + "' has no ws or wss endpoint");
}

void Pages::start(const std::string& certificate) {
    if (o_.page.empty())
        return;
    std::vector<std::string> words = {"icesoc-page", "--listen", o_.page};
    for (const std::string& vehicle : vehicles_)
        words.insert(words.end(), {"--vehicle", vehicle});
    if (protocol_ == "wss")
        words.insert(words.end(), {"--certificate", certificate});
    const std::string program = here() + "/icesoc-page";
    std::vector<char*> arguments;
    for (std::string& word : words)
        arguments.push_back(word.data());
    arguments.push_back(nullptr);
    // passed in the environment, because other users can read a program's arguments
    setenv("ICESOC_PAGE_SECRET", secret_.c_str(), 1);
    server_ = fork();
    if (server_ == 0) {
        sigset_t none;
        sigemptyset(&none);
        pthread_sigmask(SIG_SETMASK, &none, nullptr);
        prctl(PR_SET_PDEATHSIG, SIGTERM);
        execv(program.c_str(), arguments.data());
        execvp("icesoc-page", arguments.data());
        _exit(127);
    }
    unsetenv("ICESOC_PAGE_SECRET");
    if (server_ < 0)
        throw std::runtime_error("--page: cannot start icesoc-page");
}

void Pages::check() {
    int status = 0;
    if (server_ < 0 || waitpid(server_, &status, WNOHANG) <= 0)
        return;
    server_ = -1;
    throw std::runtime_error(WIFEXITED(status) && WEXITSTATUS(status) == 127
                                 ? "--page: icesoc-page not found: install it next to this program"
                                 : "--page: the server of the page (icesoc-page) has ended");
}

} // namespace gateway
