// SPDX-License-Identifier: MIT
//
// reason: chooses the text of an exception by its class.

#include "reason.h"

#include <cctype>
#include <cerrno>
#include <system_error>

namespace gateway {

namespace {

std::exception_ptr unreachable(const std::string& why) {
    return std::make_exception_ptr(Ice::UnknownLocalException(
        __FILE__, __LINE__, "icesoc-gateway: cannot reach the vehicle: " + why));
}

} // namespace

std::string nameInWords(const std::string& id) {
    std::string words;
    for (const char c : id.substr(id.rfind(':') + 1))
        if (std::isupper(c))
            words += (words.empty() ? "" : " ") + std::string(1, char(std::tolower(c)));
        else
            words += c;
    return words.substr(0, words.rfind(" exception"));
}

std::string reasonOf(const Ice::Exception& e) {
    if (const auto* file = dynamic_cast<const Ice::FileException*>(&e))
        return file->path + ": " + std::generic_category().message(file->error);
    if (const auto* system = dynamic_cast<const Ice::SyscallException*>(&e))
        return std::generic_category().message(system->error);
    if (const auto* host = dynamic_cast<const Ice::DNSException*>(&e))
        return host->host + ": host not found";
    if (const auto* plugin = dynamic_cast<const Ice::PluginInitializationException*>(&e))
        return plugin->reason;
    if (const auto* start = dynamic_cast<const Ice::InitializationException*>(&e))
        return start->reason;
    if (const auto* security = dynamic_cast<const Ice::SecurityException*>(&e))
        return security->reason;
    if (const auto* unknown = dynamic_cast<const Ice::UnknownException*>(&e))
        return unknown->unknown;
    const auto* protocol = dynamic_cast<const Ice::ProtocolException*>(&e);
    if (protocol && !protocol->reason.empty())
        return protocol->reason;
    if (dynamic_cast<const Ice::CommunicatorDestroyedException*>(&e))
        return "the gateway ends";
    if (const auto* endpoint = dynamic_cast<const Ice::EndpointParseException*>(&e))
        return endpoint->str;
    if (const auto* proxy = dynamic_cast<const Ice::ProxyParseException*>(&e))
        return proxy->str;
    if (const auto* endpoint = dynamic_cast<const Ice::NoEndpointException*>(&e))
        return "expected a proxy with endpoints, got '" + endpoint->proxy + "'";
    return nameInWords(e.ice_id()); // other exceptions have no text
}

std::exception_ptr inWords(std::exception_ptr why) {
    try {
        std::rethrow_exception(why);
    } catch (const Ice::RequestFailedException&) {
        return why;
    } catch (const Ice::UnknownException&) {
        return why;
    } catch (const Ice::LocalException& e) {
        return std::make_exception_ptr(
            Ice::UnknownLocalException(__FILE__, __LINE__, "icesoc-gateway: " + reasonOf(e)));
    } catch (...) {
        return why;
    }
}

std::exception_ptr explained(std::exception_ptr why) {
    try {
        std::rethrow_exception(why);
    } catch (const Ice::ConnectTimeoutException&) {
        return unreachable("it does not answer: check that it is on, in range, and has the same "
                           "key as this gateway");
    } catch (const Ice::ConnectFailedException& e) {
        return unreachable(e.error == EBUSY
                               ? "another ground station with the same address is connected to it"
                               : "the modem is lost or does not answer: check its cable and its "
                                 "power; the gateway's log has the reason");
    } catch (const Ice::ConnectionLostException&) {
        return unreachable("the connection was lost during the call; the vehicle may have executed "
                           "the call");
    } catch (...) {
        return why;
    }
}

} // namespace gateway
