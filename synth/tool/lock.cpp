// SPDX-License-Identifier: MIT
//
// lock: one run at a time in a folder of reports, by flock(2).

#include "lock.h"

#include <cerrno>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <system_error>
#include <unistd.h>

namespace {

[[noreturn]] void fail(const std::filesystem::path& file) {
    throw std::system_error(errno, std::generic_category(), file.string());
}

} // namespace

FolderLock::FolderLock(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    const std::filesystem::path file = folder / "lock";
    file_ = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (file_ < 0)
        fail(file);
    if (flock(file_, LOCK_EX | LOCK_NB) == 0)
        return;
    if (errno == EWOULDBLOCK)
        fmt::print(stderr, "utilisation: waiting for another run in {} ...\n", folder.string());
    while (flock(file_, LOCK_EX) != 0)
        if (errno != EINTR) {
            const int error = errno;
            close(file_);
            errno = error;
            fail(file);
        }
}

FolderLock::~FolderLock() {
    close(file_);
}
