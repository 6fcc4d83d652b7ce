// SPDX-License-Identifier: MIT
//
// pages: decides which web pages may call through the gateway, and serves the gateway's page.
//
// A browser sends the origin of a page with each WebSocket, and Ice accepts every origin. Without a
// check, any page that a user visits could call a gateway on the user's machine. The gateway
// therefore refuses calls of all pages except the page that it serves (--page) and pages from the
// origins given by --origin. The gateway's page must also send a cookie that contains a secret; the
// browser sends this cookie for no other page.

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

    // Returns the reason to refuse the calls of a connection; empty if the calls are allowed. A
    // program that is not a browser sends no origin; its calls are allowed.
    std::string refusal(const std::shared_ptr<Ice::Connection>& connection) const;

    // Returns the endpoints at which the gateway must listen: the endpoints from the options, and
    // an additional one for browsers if the page needs it.
    std::string endpoints(bool hasCertificate) const;

    // Adds a vehicle, with the adapter that browsers call.
    void add(const std::string& vehicle, const std::shared_ptr<Ice::ObjectAdapter>& adapter);

    // Starts icesoc-page, the server of the page, if the option --page is given.
    void start(const std::string& certificate);

    // Throws if the server of the page has ended.
    void check();

    // Ends the server of the page. The destructor does so as well.
    void stop();

private:
    const Options& o_;
    std::string host_, port_, secret_, protocol_;
    std::vector<std::string> origins_;  // origins of the page that the gateway serves
    std::vector<std::string> vehicles_; // arguments for icesoc-page, such as uav1=wss:10002
    pid_t server_ = -1;
};

} // namespace gateway
