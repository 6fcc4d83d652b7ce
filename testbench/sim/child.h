// SPDX-License-Identifier: MIT
//
// child: starts the ground program as a child process that ends together with the simulator, even
// if the simulator is killed.

#pragma once

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <map>
#include <string>
#include <sys/prctl.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <system_error>
#include <thread>
#include <unistd.h>
#include <vector>

class Child {
public:
    Child() = default;
    ~Child() { stop(); }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    // Starts a command. Throws std::system_error if no process can be created. If the program
    // cannot be started, its exit status is 127.
    void start(const std::vector<std::string>& command,
               const std::map<std::string, std::string>& places) {
        std::vector<std::string> words;
        std::vector<char*> argv;
        for (const std::string& word : command)
            words.push_back(filledIn(word, places));
        for (std::string& word : words)
            argv.push_back(word.data());
        argv.push_back(nullptr);
        name_ = words.front();
        const pid_t parent = getpid();
        pid_ = fork();
        if (pid_ < 0)
            throw std::system_error(errno, std::generic_category(), "cannot start '" + name_ + "'");
        if (pid_ > 0)
            return;
        prctl(PR_SET_PDEATHSIG, SIGTERM);
        if (getppid() != parent) // the parent ended before this process had requested the signal
            _exit(143);
        execvp(argv[0], argv.data());
        std::fprintf(stderr, "icesoc-sim: cannot start '%s': %s\n", argv[0], std::strerror(errno));
        _exit(127);
    }
    // Returns true while the process runs. Prints a line on stderr if a signal has ended it.
    bool runs() {
        int status;
        if (pid_ > 0 && waitpid(pid_, &status, WNOHANG) == pid_) {
            pid_ = 0;
            status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
            if (WIFSIGNALED(status) && !asked_)
                std::fprintf(stderr, "icesoc-sim: '%s' was ended by signal %d (%s)\n",
                             name_.c_str(), WTERMSIG(status), strsignal(WTERMSIG(status)));
        }
        return pid_ > 0;
    }
    // Asks the process to end, and waits at most one second for this.
    void stop() {
        asked_ = true;
        for (int i = 0; runs(); ++i) {
            if (i == 0)
                kill(pid_, SIGINT);
            else if (i == 100)
                kill(pid_, SIGKILL);
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
    }
    int status() const { return status_; } // Returns the exit status as a shell would report it.

private:
    // Returns `word` with each name in `places` replaced by its value, in one pass.
    static std::string filledIn(const std::string& word,
                                const std::map<std::string, std::string>& places) {
        std::string result;
        for (size_t at = 0; at < word.size();) {
            auto place = places.begin();
            while (place != places.end() &&
                   word.compare(at, place->first.size(), place->first) != 0)
                ++place;
            const bool found = place != places.end();
            result += found ? place->second : std::string(1, word[at]);
            at += found ? place->first.size() : 1;
        }
        return result;
    }

    std::string name_;
    pid_t pid_ = 0;
    int status_ = 0;
    bool asked_ = false;
};
