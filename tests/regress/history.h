// SPDX-License-Identifier: MIT
//
// history: what each run of the regression gave, a line of JSON a run, in <out>/history.jsonl.

#ifndef HISTORY_H
#define HISTORY_H

#include "runner.h"
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

// Where a test has passed: `tree` is what the tree was then (changes.h), or "".
struct Pass {
    std::string commit, tree, seed;
};

class History {
public:
    explicit History(
        std::string path); // reads what is there; a damaged line is skipped and counted

    // Adds a run and writes the file anew (the newest 300 runs), complete or not at all.
    void add(const nlohmann::json& run);
    const std::vector<nlohmann::json>& runs() const { return runs_; }
    unsigned damaged() const { return damaged_; }

    // Fingerprint with which a test last passed, or "".
    std::string passedWith(const std::string& test) const;
    // Returns where a test last passed, if it has.
    std::optional<Pass> lastPass(const std::string& test) const;
    // Returns how a test ended in the newest run that had it: "p", "f", "s" or "".
    std::string last(const std::string& test) const;
    // Seconds that a test took in the newest run that had it, or 0.
    double seconds(const std::string& test) const;
    // Tests that both passed and failed with one fingerprint and one seed.
    std::vector<std::string> flaky() const;

    static nlohmann::json makeRun(const std::vector<Test>& tests,
                                  const std::vector<Result>& results, const std::string& commit,
                                  double seconds);

private:
    // Returns how a test ended in the newest run that had it, and ended so: [how, seconds, print,
    // seed].
    nlohmann::json newest(const std::string& test, const std::string& how) const;

    std::string path_;
    std::vector<nlohmann::json> runs_;
    unsigned damaged_ = 0;
};

#endif
