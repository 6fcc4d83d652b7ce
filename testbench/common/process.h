// SPDX-License-Identifier: MIT
//
// process: runs other programs.

#ifndef PROCESS_H
#define PROCESS_H

#include <functional>
#include <map>
#include <string>
#include <vector>

struct Output {
    int status;       // exit status; 128 + signal
    std::string text; // standard output and error
};

// Runs a program to its end and collects its output, if asked for line by line as it comes.
// `environment` is added to ours. Throws std::runtime_error when it cannot be started.
Output run(const std::vector<std::string>& command,
           const std::map<std::string, std::string>& environment = {},
           const std::function<void(const std::string& line)>& onLine = {});

// Returns the text between quotes, as one word for a shell.
std::string quoted(const std::string& word);

// Calls work(0) .. work(count - 1), `jobs` at a time; rethrows the first exception at the end.
void inParallel(unsigned jobs, size_t count, const std::function<void(size_t)>& work);

#endif
