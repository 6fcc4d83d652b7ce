// SPDX-License-Identifier: MIT
//
// child: the program on the ground that the simulator starts: it ends with the simulator, however
// that ends.

#ifndef CHILD_H
#define CHILD_H

#include <map>
#include <string>
#include <sys/types.h>
#include <vector>

// Returns `word` with each name of `places` replaced by its value, in one pass.
std::string filledIn(const std::string& word, const std::map<std::string, std::string>& places);

class Child {
public:
    Child() = default;
    ~Child() { stop(); }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    // Throws std::system_error if there is no process to be had; a program that cannot be started
    // is one that ends with status 127.
    void start(const std::vector<std::string>& command,
               const std::map<std::string, std::string>& places);
    // True while it runs. If a signal ends it, stderr says so.
    bool runs();
    // Asks it to end, and waits for a second at most until it has.
    void stop();
    int status() const { return status_; } // as a shell has it

private:
    std::string name_;
    pid_t pid_ = 0;
    int status_ = 0;
    bool asked_ = false;
};

#endif
