// SPDX-License-Identifier: MIT
//
// lock: one run at a time in a folder of reports.

#ifndef UTILISATION_LOCK_H
#define UTILISATION_LOCK_H

#include <filesystem>

// Held from construction to destruction, and let go by the system when the process ends, however it
// does. While another process holds it, says so on stderr and waits. The folder is made if it is
// not there. Throws std::system_error.
class FolderLock {
public:
    explicit FolderLock(const std::filesystem::path& folder);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

private:
    int file_;
};

#endif
