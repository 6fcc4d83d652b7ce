// SPDX-License-Identifier: MIT
//
// history: the accepted figures of earlier commits, as git has them.

#include "history.h"

#include "runner.h"

#include <cstdio>
#include <fmt/format.h>
#include <memory>
#include <sstream>

using std::string;

namespace {

string git(const std::filesystem::path& source, const string& arguments) {
    const string command = fmt::format("git -C \"{}\" {} 2>/dev/null", source.string(), arguments);
    const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
    string text;
    char part[65536];
    for (size_t n; pipe && (n = std::fread(part, 1, sizeof part, pipe.get())) > 0;)
        text.append(part, n);
    return text;
}

} // namespace

std::vector<Commit> history(const std::filesystem::path& source, size_t count) {
    std::vector<Commit> commits;
    std::istringstream lines(git(
        source, fmt::format("log -n {} --format=%h%x09%cs%x09%s -- synth/baseline.json", count)));
    for (string line; std::getline(lines, line);) {
        std::istringstream fields(line);
        Commit c;
        std::getline(fields, c.id, '\t');
        std::getline(fields, c.date, '\t');
        std::getline(fields, c.subject);
        try {
            c.baseline =
                readBaseline(git(source, fmt::format("show {}:synth/baseline.json", c.id)));
        } catch (const std::exception&) {
            continue; // of another format, or the file was taken away: nothing to show
        }
        if (!c.baseline.designs.empty())
            commits.push_back(std::move(c));
    }
    return commits;
}

string currentCommit(const std::filesystem::path& source) {
    const string id = git(source, "rev-parse --short HEAD");
    const bool changed = !git(source, "status --porcelain --untracked-files=no").empty();
    return id.substr(0, id.find('\n')) + (changed && !id.empty() ? "+" : "");
}
