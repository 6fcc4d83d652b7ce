// SPDX-License-Identifier: MIT
//
// clock_file: simulated time that programs on the ground keep step with: a file that XBEEAT_CLOCK
// names while this object lives.

#ifndef CLOCK_FILE_H
#define CLOCK_FILE_H

#include "status_file.h"
#include "unnamed_file.h"
#include <cstdlib>

class ClockFile : public UnnamedFile, public StatusFile {
public:
    ClockFile() : StatusFile(fd()) { setenv("XBEEAT_CLOCK", path().c_str(), 1); }
    ~ClockFile() { unsetenv("XBEEAT_CLOCK"); }
};

#endif
