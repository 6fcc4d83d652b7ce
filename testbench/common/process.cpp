// SPDX-License-Identifier: MIT

#include "process.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <mutex>
#include <stdexcept>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace fs = std::filesystem;

Output run(const std::vector<std::string>& command,
           const std::map<std::string, std::string>& environment,
           const std::function<void(const std::string& line)>& onLine) {
    // The shell is gone, and signals reach the program; it ends with us, however we do.
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

void adoptOrphans() {
    prctl(PR_SET_CHILD_SUBREAPER, 1);
}

std::vector<std::string> endOrphans() {
    std::map<pid_t, std::string> left;
    for (int tries = 0; tries == 0 || (tries < 40 && !left.empty()); tries++) {
        if (tries)
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        left.clear();
        std::ifstream children(fmt::format("/proc/self/task/{}/children", getpid()));
        for (pid_t pid; children >> pid;) {
            if (waitpid(pid, nullptr, WNOHANG) == pid)
                continue;
            std::error_code gone;
            const std::string folder = fmt::format("/proc/{}/", pid);
            std::string line;
            std::getline(std::ifstream(folder + "cmdline"), line);
            std::replace(line.begin(), line.end(), '\0', ' ');
            left[pid] =
                fmt::format("{}(in {})", line,
                            fs::proximate(fs::read_symlink(folder + "cwd", gone), gone).string());
        }
    }
    std::vector<std::string> lines;
    for (const auto& [pid, line] : left) {
        kill(pid, SIGKILL);
        lines.push_back(line);
    }
    return lines;
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
