// SPDX-License-Identifier: MIT
//
// passed_proxies: finds the proxies in a request's parameters that let the vehicle call the client
// back. These proxies have no endpoints; the vehicle calls them over the client's connection.
//
// The gateway does not know the types of the parameters. It therefore searches for the bytes of
// such a proxy: name and category, an optional facet, mode, security, protocol 1.0, encoding 1.x,
// no endpoints, no adapter. In an encapsulation of encoding 1.0, a proxy contains neither protocol
// nor encoding.

#pragma once

#include <Ice/Ice.h>
#include <vector>

namespace gateway {

std::vector<Ice::Identity> passedProxies(const std::vector<Ice::Byte>& encapsulation);

} // namespace gateway
