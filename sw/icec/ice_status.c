/* SPDX-License-Identifier: MIT
 *
 * ice_status: converts a status to text: the name of the corresponding exception of Ice, if there
 * is one.
 */
#include "ice_port.h"
#include "ice_value.h"

const char* Ice_Status_text(Ice_Status status) {
    static const char* const texts[] = {
        "ok",
        "user exception",
        "::Ice::ObjectNotExistException",
        "::Ice::FacetNotExistException",
        "::Ice::OperationNotExistException",
        "::Ice::UnknownLocalException",
        "::Ice::UnknownUserException",
        "::Ice::UnknownException: the servant failed",
        "::Ice::MarshalException",
        "::Ice::ProtocolException: version, encoding or operation mode",
        "::Ice::TimeoutException",
        "::Ice::ConnectionLostException",
        "::Ice::NoEndpointException",
        "::Ice::MemoryLimitException: a limit of ice_config.h",
        "::Ice::CloseConnectionException",
        "::Ice::ParseException: not a proxy, identity or endpoint",
        "::Ice::TwowayOnlyException",
        "the reply comes later"};
    return (unsigned)status < sizeof texts / sizeof texts[0] ? texts[status] : "unknown status";
}

/* VALUE yields the value of a macro as text. The name must be passed separately, because it is lost
 * when the macro is expanded. */
#define VALUE(x) #x
#define NAMED(exception, name, value) exception ": over " name " (" VALUE(value) ")"
#define OVER(macro) NAMED("::Ice::MarshalException", #macro, macro)
#define LIMIT(macro) NAMED("::Ice::MemoryLimitException", #macro, macro)

const char* Ice_Failed_text(Ice_Byte failed, const char* bound) {
    static const char* const texts[] = {
        "ok",
        "::Ice::MarshalException: malformed, or not of the type that is expected",
        OVER(ICE_RESULT_MAX),
        OVER(ICE_REQUEST_MAX),
        OVER(ICE_REPLY_MAX) ": see Ice_ObjectPrx_setReplyBuffer",
        OVER(ICE_ARENA_BYTES),
        OVER(ICE_VALUES_MAX),
        OVER(ICE_VALUE_TYPES_MAX),
        OVER(ICE_IDENTITY_MAX),
        OVER(ICE_ENDPOINT_MAX),
        LIMIT(ICE_CALLS),
        LIMIT(ICE_CONNECTIONS),
        LIMIT(ICE_NESTING)};
    if (failed == ICE_FAILED_BOUND)
        return bound;
    return failed < sizeof texts / sizeof texts[0] ? texts[failed] : texts[1];
}
