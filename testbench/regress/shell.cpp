// SPDX-License-Identifier: MIT

#include "shell.h"
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <sys/wait.h>
#include <unistd.h>

Output run(const std::vector<std::string>& command, const std::map<std::string, std::string>& environment,
           const std::function<void(const std::string& line)>& onLine) {
    int ends[2];
    if (pipe(ends) != 0)
        throw std::runtime_error(std::string("pipe: ") + std::strerror(errno));
    pid_t child = fork();
    if (child < 0)
        throw std::runtime_error(std::string("fork: ") + std::strerror(errno));
    if (child == 0) {
        dup2(ends[1], 1);
        dup2(ends[1], 2);
        close(ends[0]);
        close(ends[1]);
        for (auto& [name, value] : environment)
            setenv(name.c_str(), value.c_str(), 1);
        std::vector<char*> words;
        for (const std::string& word : command)
            words.push_back(const_cast<char*>(word.c_str()));
        words.push_back(nullptr);
        execvp(words[0], words.data());
        std::string message = command[0] + ": " + std::strerror(errno) + "\n";
        if (write(2, message.data(), message.size()) < 0)
            _exit(126);
        _exit(127);
    }
    close(ends[1]);
    Output out{0, {}};
    std::string line;
    char block[4096];
    for (;;) {
        ssize_t n = read(ends[0], block, sizeof block);
        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0)
            break;
        out.text.append(block, static_cast<size_t>(n));
        if (!onLine)
            continue;
        for (ssize_t i = 0; i < n; ++i) {
            if (block[i] == '\n') {
                onLine(line);
                line.clear();
            } else {
                line += block[i];
            }
        }
    }
    close(ends[0]);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    out.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    if (out.status == 127)
        throw std::runtime_error("cannot run " + out.text);
    return out;
}

std::string quoted(const std::string& word) {
    std::string out = "'";
    for (char c : word)
        out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}
