/* SPDX-License-Identifier: MIT
 *
 * ice_status: statuses in words; where Ice has an exception for one, by its name.
 */
#include "ice_seam.h"

const char* Ice_Status_text(Ice_Status status) {
    static const char* const texts[] = {
        "ok",
        "user exception",
        "Ice::ObjectNotExistException",
        "Ice::FacetNotExistException",
        "Ice::OperationNotExistException",
        "Ice::UnknownLocalException",
        "Ice::UnknownUserException",
        "Ice::UnknownException: the servant failed",
        "Ice::MarshalException: malformed, or too long for IceC's buffers",
        "Ice::ProtocolException: version, encoding or operation mode",
        "Ice::TimeoutException",
        "Ice::ConnectionLostException",
        "Ice::NoEndpointException",
        "a limit of IceC was reached",
        "Ice::CloseConnectionException",
        "Ice::ParseException: not a proxy, identity or endpoint",
        "Ice::TwowayOnlyException",
        "the reply comes later"};
    return (unsigned)status < sizeof texts / sizeof texts[0] ? texts[status] : "unknown status";
}
