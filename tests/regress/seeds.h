// SPDX-License-Identifier: MIT
//
// seeds: tests that failed, with the seeds that showed it: kept in <out>/seeds.jsonl until they
// pass with them.

#ifndef SEEDS_H
#define SEEDS_H

#include "runner.h"
#include <map>
#include <nlohmann/json.hpp>

class FailingSeeds {
public:
    explicit FailingSeeds(std::string path); // reads what is there; a damaged line is left out

    // Takes in what failed, drops what passed with its kept seed, and writes the file anew,
    // complete or not at all.
    void update(const std::vector<Result>& results, const std::string& commit);
    // Drops tests that are not in the list any more; returns their names.
    std::vector<std::string> forgetOthers(const std::vector<Test>& tests);
    // Names of tests by seed.
    std::map<std::string, std::vector<std::string>> bySeed() const;
    // [{"test", "seed", "since" (seconds, Unix), "commit", "times" (how often it failed)}]
    nlohmann::json list() const;

private:
    void write() const;

    std::string path_;
    std::map<std::pair<std::string, std::string>, nlohmann::json> kept_; // test, seed
};

#endif
