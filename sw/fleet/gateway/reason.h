// SPDX-License-Identifier: MIT
//
// reason: turns Ice's exceptions into words for users. Ice's own messages begin with a position in
// Ice's source code, and with the name of a class.

#pragma once

#include <Ice/Ice.h>
#include <exception>
#include <string>

namespace gateway {

// Returns the name of an exception class, split into words: "::Ice::BadMagicException" becomes "bad
// magic".
std::string nameInWords(const std::string& id);

// Returns the reason why Ice failed, in words.
std::string reasonOf(const Ice::Exception& e);

// Returns the exception that a caller gets for an error. Ice would send its message of a local
// exception to the caller; the returned exception has the reason in words instead. Errors that the
// protocol can express, such as "object does not exist", stay as they are.
std::exception_ptr inWords(std::exception_ptr why);

// Returns the exception that a client gets if its request could not be sent, or if the connection
// was lost before the reply. If the connection to the vehicle has failed, the text of the exception
// explains the error to the user.
std::exception_ptr explained(std::exception_ptr why);

} // namespace gateway
