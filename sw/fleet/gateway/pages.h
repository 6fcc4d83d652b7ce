// SPDX-License-Identifier: MIT
//
// pages: web pages that call through the gateway: the gateway's page, and pages of other origins,
// which are refused.
//
// A browser sends the origin of a page with each WebSocket, and Ice accepts every origin: any page
// that a user visits could call a gateway of the same machine. The gateway therefore refuses calls
// of all pages except its own one (--page) and those of --origin. Its own page also has to send a
// cookie with a secret, which the browser sends for this page only.

#pragma once

#include "gateway_options.h"

#include <sys/types.h>

namespace gateway {

class Pages {
public:
    explicit Pages(const Options& o);
    ~Pages();
    Pages(const Pages&) = delete;
    Pages& operator=(const Pages&) = delete;

    // Returns the reason to refuse the calls of a connection; empty if they are allowed. A program
    // that is not a browser sends no origin, and is allowed.
    std::string refusal(const std::shared_ptr<Ice::Connection>& connection) const;

    // Returns the endpoints at which to listen: the given endpoints, and an additional one for
    // browsers if the page needs it.
    std::string endpoints(bool hasCertificate) const;

    // Adds a vehicle, with the adapter that browsers call.
    void add(const std::string& vehicle, const std::shared_ptr<Ice::ObjectAdapter>& adapter);

    // Starts the server of the page, icesoc-page, if there is --page.
    void start(const std::string& certificate);

    // Throws if the server of the page has ended.
    void check();

private:
    const Options& o_;
    std::string host_, port_, secret_, protocol_;
    std::vector<std::string> origins_;  // origins of the gateway's own page
    std::vector<std::string> vehicles_; // arguments for icesoc-page, such as uav1=wss:10002
    pid_t server_ = -1;
};

} // namespace gateway
