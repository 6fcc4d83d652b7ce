// SPDX-License-Identifier: MIT
//
// test_list: every test that CTest knows, where it lives, and which of them a person asked for.

#ifndef TEST_LIST_H
#define TEST_LIST_H

#include <optional>
#include <set>
#include <string>
#include <vector>

struct Test {
    unsigned number; // CTest's, from 1
    std::string name;
    std::string place;                    // folder below tests/: "hdl/modem"
    std::string folder;                   // where it runs, which it may write
    std::vector<std::string> labels;      // of a program that is not built: those of its cases
    std::vector<std::string> needs, sets; // CTest's fixtures: what sets them up runs before
    std::vector<std::string> command;
    std::optional<std::string> targets; // NEEDS=... of its environment: what must be built for it
    std::string print;                  // changes when what the test runs changes (fingerprint)
};

struct Selection {
    std::string name;  // regular expression on the name
    std::string block; // a word of the name or of the place: "modem", "link"
    std::string label;
    bool changed = false; // only tests whose fingerprint differs from their last pass
    bool failed = false;  // only those that failed in the last run
};

// Returns all tests of a build folder; throws std::runtime_error when CTest cannot say.
std::vector<Test> listTests(const std::string& build);

// Fills Test::print: a fingerprint of what the tests of each label or folder depend on besides
// their program. `source` is the root of the tree; only files that Git knows count.
void fingerprint(std::vector<Test>& tests, const std::string& source, const std::string& build);

// True if a test is a program of the build folder, and not a script.
bool isProgram(const Test& test, const std::string& build);

// Returns the folders that a test reads which is no program.
std::vector<std::string> readsOf(const Test& test);

// True for a program that is not built, in the place of its cases.
bool isUnbuilt(const Test& test);

// Returns that program's name.
std::string programOf(const Test& unbuilt);

// True if cases of a program that is not built may be of this name (a regular expression).
bool mayHold(const Test& unbuilt, const std::string& name);

// Returns the targets that ninja must build for a test: Test::targets, or else what its command
// names of the build folder's `outputs`; "all" where it names that folder, or what is unknown.
std::vector<std::string> targetsOf(const Test& test, const std::string& build,
                                   const std::set<std::string>& outputs);

// Returns what ninja can build in a folder, by its path there.
std::set<std::string> outputsOf(const std::string& build);

// The words that --block compares with: of the folder, and of the name up to the case.
std::set<std::string> blockWords(const Test& test);

#endif
