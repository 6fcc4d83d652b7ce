// SPDX-License-Identifier: MIT
//
// changes: what has changed in the tree since a failed test last passed, of the files on which it
// depends: the best hint there is, whatever has failed.

#ifndef CHANGES_H
#define CHANGES_H

#include "history.h"
#include "process.h"
#include "test_list.h"
#include <map>
#include <set>
#include <string>
#include <vector>

class Changes {
public:
    // Notes the state of the tree, changes that are not committed among it, as a tree of git, with
    // objects in <out>/tree: the repository itself does not get any.
    Changes(const std::string& source, const std::string& build, const std::string& out);

    // Returns that tree's hash; "" where git keeps nothing.
    const std::string& tree() const { return tree_; }

    // Returns "changed since it passed at 632b860abc: ip/fir/fir.v:12 (2 lines), ...", or that
    // nothing has; "" if neither is known. Of a test that has never passed here: what differs from
    // the commit.
    std::string since(const std::optional<Pass>& pass, const Test& test, const std::string& seed);

    // Returns the files that have changed since the tree was noted, which is while the tests ran.
    std::vector<std::string> meanwhile() const;

private:
    struct File {
        std::string path;
        unsigned line, lines; // the first that differs, how many do; 0: it has no lines
    };

    std::string writeTree() const;
    Output git(std::vector<std::string> words) const;
    const std::vector<File>* differing(const std::string& from);
    std::set<std::string> inputsOf(const Test& test);

    const std::string source_, build_;
    std::map<std::string, std::string> environment_; // of git
    std::string tree_;
    std::map<std::string, std::vector<File>> differing_;  // since a tree or a commit
    std::map<std::string, std::set<std::string>> inputs_; // of a program
};

#endif
