// SPDX-License-Identifier: MIT
//
// passed_proxies: finds the proxies in a request's parameters that lead back to the caller: proxies
// without endpoints, with which the vehicle calls back on the caller's connection.
//
// The gateway does not know the types of parameters, so it searches for the bytes of such a proxy:
// name and category, an optional facet, mode, security, protocol 1.0, encoding 1.x (not in an
// encapsulation of 1.0), no endpoints, no adapter.

#pragma once

#include <Ice/Ice.h>
#include <vector>

namespace gateway {

std::vector<Ice::Identity> passedProxies(const std::vector<Ice::Byte>& encapsulation);

} // namespace gateway
