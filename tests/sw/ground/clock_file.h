// SPDX-License-Identifier: MIT
//
// clock_file: simulated time that programs on the ground keep step with: a file that XBEEAT_CLOCK
// names while this object lives.

#ifndef CLOCK_FILE_H
#define CLOCK_FILE_H

#include "status_file.h"
#include <cstdlib>

class TemporaryName {
public:
    TemporaryName() { close(mkstemp(name_)); }
    ~TemporaryName() { unlink(name_); }
    TemporaryName(const TemporaryName&) = delete;
    TemporaryName& operator=(const TemporaryName&) = delete;
    std::string path() const { return name_; }

private:
    char name_[27] = "/tmp/icesoc-clock-XXXXXX";
};

class ClockFile : public TemporaryName, public StatusFile {
public:
    ClockFile() : StatusFile(path()) { setenv("XBEEAT_CLOCK", path().c_str(), 1); }
    ~ClockFile() { unsetenv("XBEEAT_CLOCK"); }
};

#endif
