// SPDX-License-Identifier: MIT
//
// progress: what a run says while it runs.

#ifndef PROGRESS_H
#define PROGRESS_H

#include "history.h"
#include <algorithm>
#include <fmt/format.h>
#include <iostream>
#include <map>
#include <set>
#include <string>
#include <unistd.h>
#include <vector>

// Says how far the run is: on a terminal in one line that is written anew, else at each tenth. A
// failure is told at once.
class Progress {
public:
    Progress(const std::vector<Test>& tests, const History& history, unsigned jobs) : jobs_(jobs) {
        for (const Test& test : tests)
            left_ += seconds_[test.name] = history.seconds(test.name);
    }
    void start(const std::string& name) { running_.insert(name); }
    void end(const Result& result, unsigned done, unsigned total) {
        running_.erase(result.name);
        left_ -= seconds_[result.name];
        if (result.status == "failed") {
            ++failed_;
            line(fmt::format("FAILED {} ({:.1f} s)", result.name, result.seconds), true);
        }
        const auto left = static_cast<unsigned>(std::max(0.0, left_) / jobs_);
        line(fmt::format("{} of {}, {} failed, {}:{:02} left: {}", done, total, failed_, left / 60,
                         left % 60, fmt::join(running_, " ")),
             !terminal_ && 10 * done / total != 10 * (done - 1) / total);
    }
    void done() { line("", false); }

private:
    void line(const std::string& text, bool keep) {
        if (!terminal_ && !keep)
            return;
        if (terminal_)
            std::cout << '\r' << text.substr(0, 110) << "\033[K";
        else
            std::cout << text;
        if (keep)
            std::cout << '\n';
        std::cout << std::flush;
    }
    const bool terminal_ = isatty(1);
    const unsigned jobs_;
    double left_ = 0;
    std::map<std::string, double> seconds_;
    std::set<std::string> running_;
    unsigned failed_ = 0;
};

#endif
