// SPDX-License-Identifier: MIT

#include "process.h"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <sys/wait.h>
#include <thread>

Output run(const std::vector<std::string>& command,
           const std::map<std::string, std::string>& environment,
           const std::function<void(const std::string& line)>& onLine) {
    // The shell is replaced, so signals reach the program; it ends with this process, however that
    // ends.
    std::string words = "exec setpriv --pdeathsig TERM env";
    for (const auto& [name, value] : environment)
        words += " " + quoted(name + "=" + value);
    for (const std::string& word : command)
        words += " " + quoted(word);
    FILE* pipe = popen((words + " 2>&1").c_str(), "re");
    if (!pipe)
        throw std::runtime_error("cannot run " + command.at(0));
    Output out{0, {}};
    std::string line;
    for (int c; (c = std::fgetc(pipe)) != EOF;) {
        out.text += static_cast<char>(c);
        if (!onLine)
            continue;
        if (c == '\n') {
            onLine(line);
            line.clear();
        } else {
            line += static_cast<char>(c);
        }
    }
    const int status = pclose(pipe);
    out.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    if (out.status == 126 || out.status == 127)
        throw std::runtime_error("cannot run " + command.at(0) + ": " + out.text);
    return out;
}

std::string quoted(const std::string& word) {
    std::string out = "'";
    for (char c : word)
        out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

void inParallel(unsigned jobs, size_t count, const std::function<void(size_t)>& work) {
    std::atomic<size_t> next{0};
    std::exception_ptr failed;
    std::mutex failing;
    std::vector<std::thread> threads;
    for (unsigned k = 0; k < std::max(1u, jobs); k++)
        threads.emplace_back([&] {
            for (size_t i; (i = next++) < count;)
                try {
                    work(i);
                } catch (...) {
                    const std::lock_guard<std::mutex> lock(failing);
                    if (!failed)
                        failed = std::current_exception();
                }
        });
    for (std::thread& thread : threads)
        thread.join();
    if (failed)
        std::rethrow_exception(failed);
}
