// SPDX-License-Identifier: MIT
//
// child: the ground's program that the simulator starts; it ends with the simulator, however that
// ends.

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

    // Throws std::system_error if there is no process available. A program that cannot be started
    // ends with status 127.
    void start(const std::vector<std::string>& command,
               const std::map<std::string, std::string>& places);
    // True while it runs. stderr names a signal that ends it.
    bool runs();
    // Asks it to end, and waits for at most a second until it has.
    void stop();
    int status() const { return status_; } // as in a shell

private:
    std::string name_;
    pid_t pid_ = 0;
    int status_ = 0;
    bool asked_ = false;
};

#endif
