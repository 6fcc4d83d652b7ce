// SPDX-License-Identifier: MIT
//
// clock_file: a simulated clock for programs on the ground. While this object exists, the variable
// XBEEAT_CLOCK contains the path of a file with the time; the file has no name on the disk.

#pragma once

#include "status_file.h"
#include <cstdlib>
#include <string>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

// A file in memory, with mode 0600, that this process and its children can open by a path. If the
// test is killed, the file disappears.
class UnnamedFile {
public:
    UnnamedFile() { fchmod(fd_, 0600); }
    ~UnnamedFile() { close(fd_); }
    UnnamedFile(const UnnamedFile&) = delete;
    UnnamedFile& operator=(const UnnamedFile&) = delete;
    int fd() const { return fd_; }
    const std::string& path() const { return path_; }

private:
    const int fd_ = memfd_create("icesoc-test", MFD_CLOEXEC);
    const std::string path_ = "/proc/" + std::to_string(getpid()) + "/fd/" + std::to_string(fd_);
};

class ClockFile : public UnnamedFile, public StatusFile {
public:
    ClockFile() : StatusFile(fd()) { setenv("XBEEAT_CLOCK", (SIM_CLOCK ":" + path()).c_str(), 1); }
    ~ClockFile() { unsetenv("XBEEAT_CLOCK"); }
};
