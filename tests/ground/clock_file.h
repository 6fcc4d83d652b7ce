// SPDX-License-Identifier: MIT
//
// clock_file: simulated time that programs on the ground keep step with (status.h): a file that
// XBEEAT_CLOCK names while this object lives.

#ifndef CLOCK_FILE_H
#define CLOCK_FILE_H

#include "status.h"
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <string>
#include <sys/mman.h>
#include <system_error>
#include <unistd.h>

class ClockFile {
public:
    ClockFile() {
        char name[] = "/tmp/icesoc-clock-XXXXXX";
        int fd = mkstemp(name);
        if (fd < 0 || ftruncate(fd, sizeof(SimStatus)) != 0)
            throw std::system_error(errno, std::generic_category(), "no file for the clock");
        path_ = name;
        void* at = mmap(nullptr, sizeof(SimStatus), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
        close(fd);
        if (at == MAP_FAILED)
            throw std::system_error(errno, std::generic_category(), "no clock in memory");
        status_ = static_cast<SimStatus*>(at);
        std::memcpy(status_->magic, "ICESOC1", 8);
        setenv("XBEEAT_CLOCK", path_.c_str(), 1);
    }
    ~ClockFile() {
        unsetenv("XBEEAT_CLOCK");
        munmap(status_, sizeof(SimStatus));
        unlink(path_.c_str());
    }
    ClockFile(const ClockFile&) = delete;
    ClockFile& operator=(const ClockFile&) = delete;

    SimStatus& operator*() const { return *status_; }
    SimStatus* operator->() const { return status_; }
    const std::string& path() const { return path_; }
    uint64_t ns() const { return __atomic_load_n(&status_->ns, __ATOMIC_ACQUIRE); }
    void set(uint64_t ns) { __atomic_store_n(&status_->ns, ns, __ATOMIC_RELEASE); }

private:
    std::string path_;
    SimStatus* status_;
};

#endif
