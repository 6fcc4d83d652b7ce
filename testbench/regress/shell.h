// SPDX-License-Identifier: MIT
//
// shell: runs other programs.

#ifndef SHELL_H
#define SHELL_H

#include <functional>
#include <map>
#include <string>
#include <vector>

struct Output {
    int status;       // exit status; 128 + signal
    std::string text; // standard output and error
};

// Runs a program with its output collected and, if asked for, handed on line by line.
// `environment` is added to ours. Throws std::runtime_error when it cannot be started.
Output run(const std::vector<std::string>& command, const std::map<std::string, std::string>& environment = {},
           const std::function<void(const std::string& line)>& onLine = {});

// The text between quotes that a shell takes as one word.
std::string quoted(const std::string& word);

#endif
