// SPDX-License-Identifier: MIT
//
// log: prints the messages of Ice without positions in Ice's source code and without names of
// exception classes.

#pragma once

#include <string>

namespace gateway {

// Installs the log in each communicator that is initialized later. Messages still go to the place
// that Ice's properties choose: the terminal, Ice.LogFile or Ice.UseSyslog.
void installLog();

// Returns a message of Ice in which each position in source code is removed, and the name of each
// exception is split into words: "src/Ice/Network.cpp:12: ::Ice::BadMagicException:" becomes "bad
// magic:".
std::string withoutPositions(const std::string& message);

} // namespace gateway
