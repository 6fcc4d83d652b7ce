// SPDX-License-Identifier: MIT
//
// runner: runs chosen tests, here by CTest or on a cluster by Slurm, and tells how each ended.

#ifndef RUNNER_H
#define RUNNER_H

#include "test_list.h"
#include <functional>
#include <map>

struct Result {
    std::string name;
    std::string status; // "passed", "failed", "skipped"
    double seconds = 0;
    std::string log;
    std::string end; // of one that failed: "SegFault", "Timeout"; "" where it ended by itself
    std::string seed;
};

struct RunOptions {
    std::string build, out;
    std::string seed;
    unsigned jobs = 1;
    std::function<void(const std::string& name)> onStart;
    std::function<void(const Result& result, unsigned done, unsigned total)> onEnd;
};

// CTest runs the tests in parallel, those that failed last time first, and writes JUnit to
// <out>/junit-<seed>.xml. Throws std::runtime_error when it gives no results.
std::vector<Result> runHere(const std::vector<Test>& tests, const RunOptions& options);

// The same list as a Slurm array job: one task a test; needs sbatch and a folder that all nodes
// share.
std::vector<Result> runSlurm(const std::vector<Test>& tests, const RunOptions& options);

// The results of a JUnit file that CTest wrote: logs without colours and with lines of no more than
// 2,000 characters: regular expressions recurse over longer ones.
std::vector<Result> readJUnit(const std::string& path);

// JUnit of all results, for CI systems; `properties` of a failed one by its name: {"wave": file};
// its "reason" is the failure's message.
using Properties = std::map<std::string, std::map<std::string, std::string>>;
void writeJUnit(const std::string& path, const std::vector<Result>& results,
                const Properties& properties);

#endif
