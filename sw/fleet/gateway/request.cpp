// SPDX-License-Identifier: MIT
//
// request: sends a request to its object, or fails it.

#include "request.h"
#include "reason.h"

#include <iostream>

namespace gateway {

size_t Request::messageBytes(const Ice::Current& current) {
    const auto text = [](const std::string& s) { return s.size() + (s.size() < 255 ? 1 : 5); };
    size_t bytes = 14 + 4 + 1; // header, number and mode of the request
    bytes += text(current.id.name) + text(current.id.category) + text(current.operation);
    bytes += 1 + (current.facet.empty() ? 0 : text(current.facet));
    bytes += current.ctx.size() < 255 ? 1 : 5;
    for (const auto& [key, value] : current.ctx)
        bytes += text(key) + text(value);
    return bytes;
}

void Request::sendTo(const std::shared_ptr<Ice::ObjectPrx>& target, Response onResponse,
                     Failure onError) const {
    auto object = target->ice_identity(current.id)->ice_facet(current.facet);
    object = object->ice_encodingVersion(current.encoding);
    object = isOneway() ? object->ice_oneway() : object->ice_twoway();
    const Parameters in{parameters.data(), parameters.data() + parameters.size()};
    std::function<void(bool)>
        sent; // function that Ice calls when it has sent a one-way request, which has no reply
    if (isOneway())
        sent = [onResponse](bool) { onResponse(true, {}); };
    object->ice_invokeAsync(current.operation, current.mode, in, std::move(onResponse),
                            std::move(onError), std::move(sent), current.ctx);
}

std::exception_ptr unknown(const std::string& why) {
    return std::make_exception_ptr(
        Ice::UnknownException(__FILE__, __LINE__, "icesoc-gateway: " + why));
}

void fail(const Requests& requests, std::exception_ptr why) {
    size_t oneways = 0;
    for (const auto& request : requests) {
        oneways += request->isOneway();
        request->failed(why);
    }
    if (oneways == 0)
        return;
    const auto report = [oneways](const std::string& reason) {
        std::cerr << "gateway: one-way calls that were not sent: " + std::to_string(oneways) +
                         " (" + reason + ")\n";
    };
    try {
        std::rethrow_exception(why);
    } catch (const Ice::Exception& e) {
        report(reasonOf(e));
    }
}

} // namespace gateway
