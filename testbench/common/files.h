// SPDX-License-Identifier: MIT
//
// files: whole files, their hashes, pages with data in them, and a lock on a folder.

#ifndef FILES_H
#define FILES_H

#include <filesystem>
#include <map>
#include <string>
#include <vector>

// Returns what is in a file. Throws std::runtime_error if it cannot be read.
std::string readFile(const std::filesystem::path& file);

// Writes a file, all of it or none: readers see the old text or the new. Throws
// std::runtime_error.
void writeFile(const std::filesystem::path& file, const std::string& text);

// Returns 16 hexadecimal digits that differ when the contents, or where one ends, differ (FNV-1a).
std::string hexHash(const std::vector<std::string>& contents);

// Returns the state of folders, "bus hdl ip: 0123456789abcdef": a measurement keeps it, and is of
// today as long as it is the same.
std::string treeState(const std::filesystem::path& source, const std::string& folders);

// Return the style and the script that the pages of utilisation and of the regression begin with:
// libraries (nothing where they could not be fetched), colours, tables, charts.
std::string pageStyle();
std::string pageScript();

// Replaces each place in a page by its text. Throws std::runtime_error for a place that is not
// there.
std::string filled(std::string page, const std::map<std::string, std::string>& places);

// Returns JSON as it may stand in a page's script: a "</" in it does not end the script.
std::string scriptSafe(std::string json);

// Held from construction to destruction, and let go by the system when the process ends, however it
// does. While another process holds the folder, says on stderr which one, and waits. The folder is
// made if it is not there. Throws std::system_error.
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
