// SPDX-License-Identifier: MIT
//
// passed_proxies: finds the proxies in the parameters of a request over which the vehicle can call
// the client back. These are proxies without endpoints; the vehicle calls them over the client's
// connection.
//
// The gateway does not know the types of parameters, so it searches for the bytes of such a proxy:
// name and category, an optional facet, mode, security, protocol 1.0, encoding 1.x (absent in an
// encapsulation of 1.0), no endpoints, no adapter.

#pragma once

#include <Ice/Ice.h>
#include <vector>

namespace gateway {

std::vector<Ice::Identity> passedProxies(const std::vector<Ice::Byte>& encapsulation);

} // namespace gateway
