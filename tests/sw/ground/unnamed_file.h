// SPDX-License-Identifier: MIT
//
// unnamed_file: a file in memory, mode 0600, that this process and its children open by a path. A
// test that is killed leaves nothing of it.

#ifndef UNNAMED_FILE_H
#define UNNAMED_FILE_H

#include <string>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

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

#endif
