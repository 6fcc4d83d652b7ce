// SPDX-License-Identifier: MIT
//
// history: the accepted figures of earlier commits, from git.

#include "history.h"

#include "process.h"

#include <fmt/format.h>
#include <sstream>

using std::string;

namespace {

string git(const std::filesystem::path& source, std::vector<string> arguments) {
    arguments.insert(arguments.begin(), {"git", "-C", source.string()});
    const Output out = run(arguments);
    return out.status == 0 ? out.text : "";
}

} // namespace

std::vector<Commit> history(const std::filesystem::path& source, size_t count) {
    std::vector<Commit> commits;
    std::istringstream lines(
        git(source, {"log", fmt::format("-n{}", count), "--format=%h%x09%cs%x09%s", "--",
                     "synth/baseline.json"}));
    for (string line; std::getline(lines, line);) {
        std::istringstream fields(line);
        Commit c;
        std::getline(fields, c.id, '\t');
        std::getline(fields, c.date, '\t');
        std::getline(fields, c.subject);
        try {
            c.baseline = readBaseline(git(source, {"show", c.id + ":synth/baseline.json"}));
        } catch (const std::exception&) {
            continue; // another format, or the file was removed: nothing to show
        }
        if (!c.baseline.designs.empty())
            commits.push_back(std::move(c));
    }
    return commits;
}

string currentCommit(const std::filesystem::path& source) {
    const string id = git(source, {"rev-parse", "--short", "HEAD"});
    const bool changed = !git(source, {"status", "--porcelain", "--untracked-files=no"}).empty();
    return id.substr(0, id.find('\n')) + (changed && !id.empty() ? "+" : "");
}
