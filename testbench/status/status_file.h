// SPDX-License-Identifier: MIT
//
// status_file: keeps a simulator's counters (SimStatus) in a file that other programs map into
// memory.

#pragma once

#include "keep_step.h"
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <string>
#include <sys/mman.h>
#include <system_error>
#include <unistd.h>

class StatusFile {
public:
    // Creates a file at `path`. Throws std::system_error if this fails, also if the disk is full; a
    // full disk would otherwise end the program with SIGBUS at a later write to the mapped file.
    explicit StatusFile(const std::string& path) {
        unlink(path.c_str()); // replaces a symbolic link instead of writing to its target
        const int fd = open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
        const int error = fd < 0 ? errno : map(fd);
        if (fd >= 0)
            close(fd);
        if (error)
            throw std::system_error(error, std::generic_category(), "cannot write '" + path + "'");
    }
    // Uses an empty file that is open for writing. The caller remains responsible for closing it.
    explicit StatusFile(int fd) {
        if (const int error = map(fd))
            throw std::system_error(error, std::generic_category(),
                                    "cannot map the file that shares the simulated time");
    }
    ~StatusFile() { munmap(status_, sizeof(SimStatus)); }
    StatusFile(const StatusFile&) = delete;
    StatusFile& operator=(const StatusFile&) = delete;

    SimStatus& operator*() const { return *status_; }
    SimStatus* operator->() const { return status_; }
    uint64_t ns() const { return __atomic_load_n(&status_->ns, __ATOMIC_ACQUIRE); }
    void set(uint64_t ns) { __atomic_store_n(&status_->ns, ns, __ATOMIC_RELEASE); }

private:
    // Returns 0, or errno if the file cannot be mapped.
    int map(int fd) {
        if (const int error = posix_fallocate(fd, 0, sizeof(SimStatus)))
            return error;
        void* at = mmap(nullptr, sizeof(SimStatus), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
        if (at == MAP_FAILED)
            return errno;
        status_ = static_cast<SimStatus*>(at);
        std::memcpy(status_->magic, SIM_MAGIC, sizeof SIM_MAGIC);
        return 0;
    }
    SimStatus* status_;
};
