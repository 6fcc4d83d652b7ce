// SPDX-License-Identifier: MIT
//
// files: whole files, their hashes, pages with data in them, and a lock on a folder.

#ifndef FILES_H
#define FILES_H

#include <filesystem>
#include <map>
#include <string>
#include <vector>

// Returns a file's content. Throws std::runtime_error if it cannot be read.
std::string readFile(const std::filesystem::path& file);

// Writes a file, whole or not at all: readers see the old text or the new. Throws
// std::runtime_error.
void writeFile(const std::filesystem::path& file, const std::string& text);

// Returns a hash of 16 hexadecimal digits of the contents and their boundaries (FNV-1a).
std::string hexHash(const std::vector<std::string>& contents);

// Returns the state of folders, "bus hdl ip: 0123456789abcdef". A measurement stores it, and is
// valid while it stays the same.
std::string treeState(const std::filesystem::path& source, const std::string& folders);

// Return the style and the script at the beginning of the pages of utilisation and regression:
// libraries (nothing where they could not be fetched), colours, tables, charts.
std::string pageStyle();
std::string pageScript();

// Replaces each placeholder in a page by its text. Throws std::runtime_error for a missing one.
std::string filled(std::string page, const std::map<std::string, std::string>& places);

// Returns JSON for a page's script: a "</" in it does not end the script.
std::string scriptSafe(std::string json);

// Locks a folder from construction to destruction; the system frees the lock when the process ends,
// however it ends. While another process holds the folder, names it on stderr and waits. Makes a
// missing folder. Throws std::system_error.
class FolderLock {
public:
    FolderLock(const std::filesystem::path& folder, const std::string& program);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

private:
    int file_;
};

#endif
