// SPDX-License-Identifier: MIT
//
// history: the accepted figures of earlier commits, from git.

#pragma once

#include "baseline.h"

struct Commit {
    std::string id, date, subject; // short hash, YYYY-MM-DD, first line of the message
    Baseline baseline;
};

// Commits that changed synth/baseline.json, newest first, `count` at most; none without git.
std::vector<Commit> history(const std::filesystem::path& source, size_t count);
// "1a2b3c4", with "+" if the tree has changes; "" without git.
std::string currentCommit(const std::filesystem::path& source);
