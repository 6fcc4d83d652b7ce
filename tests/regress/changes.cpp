// SPDX-License-Identifier: MIT

#include "changes.h"
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <regex>
#include <sstream>

namespace fs = std::filesystem;

namespace {

constexpr size_t shown = 6; // files

// Returns the lines of a text.
std::vector<std::string> linesOf(const std::string& text) {
    std::istringstream in(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(in, line);)
        lines.push_back(line);
    return lines;
}

// What is tested before what tests it and what tells of it.
bool isSource(const std::string& path) {
    return path.rfind("tests/", 0) != 0 && path.rfind("docs/", 0) != 0;
}

} // namespace

Changes::Changes(const std::string& source, const std::string& build, const std::string& out)
    : source_(source), build_(build) {
    const std::string folder = fs::absolute(out).string() + "/tree";
    const Output objects = git({"rev-parse", "--path-format=absolute", "--git-path", "objects"});
    if (objects.status != 0)
        return;
    fs::create_directories(folder + "/objects");
    environment_ = {{"GIT_INDEX_FILE", folder + "/index"},
                    {"GIT_OBJECT_DIRECTORY", folder + "/objects"},
                    {"GIT_ALTERNATE_OBJECT_DIRECTORIES", linesOf(objects.text).at(0)}};
    tree_ = writeTree();
}

std::string Changes::writeTree() const {
    const Output added = git({"add", "--all"}), tree = git({"write-tree"});
    return added.status || tree.status ? "" : linesOf(tree.text).at(0);
}

std::vector<std::string> Changes::meanwhile() const {
    const std::string now = tree_.empty() ? "" : writeTree();
    return now.empty() ? std::vector<std::string>()
                       : linesOf(git({"diff", "--name-only", "--no-renames", tree_, now}).text);
}

Output Changes::git(std::vector<std::string> words) const {
    words.insert(words.begin(), {"git", "-C", source_, "-c", "core.quotePath=false"});
    return run(words, environment_);
}

// Returns what differs between a tree or a commit and now, what is not committed first; null if git
// does not know it any more.
const std::vector<Changes::File>* Changes::differing(const std::string& from) {
    auto found = differing_.find(from);
    if (found != differing_.end())
        return &found->second;
    const Output out = git({"diff", "--unified=0", "--no-color", "--no-ext-diff", "--no-renames",
                            "--src-prefix=a/", "--dst-prefix=b/", from, tree_});
    if (out.status != 0)
        return nullptr;
    static const std::regex begin("diff --git a/(.*) b/.*"),
        hunk("@@ -[0-9]+(,([0-9]+))? [+]([0-9]+)(,([0-9]+))? @@.*");
    auto& files = differing_[from];
    std::smatch match;
    for (const std::string& line : linesOf(out.text)) {
        if (std::regex_match(line, match, begin)) {
            files.push_back({match[1], 0, 0});
        } else if (!files.empty() && std::regex_match(line, match, hunk)) {
            auto count = [&](size_t n) { return match[n].matched ? std::stoul(match[n]) : 1; };
            File& file = files.back();
            if (!file.line)
                file.line = std::max(1u, static_cast<unsigned>(std::stoul(match[3])));
            file.lines += static_cast<unsigned>(std::max(count(2), count(5)));
        }
    }
    const auto open = linesOf(git({"diff", "--name-only", "--no-renames", "HEAD", tree_}).text);
    std::stable_partition(files.begin(), files.end(),
                          [](const File& file) { return isSource(file.path); });
    std::stable_partition(files.begin(), files.end(), [&](const File& file) {
        return std::find(open.begin(), open.end(), file.path) != open.end();
    });
    return &files;
}

// Returns the files of the tree of which ninja makes a test's program, headers among them.
std::set<std::string> Changes::inputsOf(const Test& test) {
    auto found = inputs_.find(test.command[0]);
    if (found != inputs_.end())
        return found->second;
    auto& inputs = inputs_[test.command[0]];
    const fs::path build = fs::canonical(build_), source = fs::canonical(source_);
    auto add = [&](const std::string& path) {
        const std::string file = (build / path).lexically_normal().lexically_relative(source);
        if (file.rfind("..", 0) != 0)
            inputs.insert(file);
    };
    std::vector<std::string> deps = {"ninja", "-C", build_, "-t", "deps"};
    const std::string program = fs::path(test.command[0]).lexically_relative(build);
    for (const std::string& path :
         linesOf(run({"ninja", "-C", build_, "-t", "inputs", program}).text)) {
        add(path);
        if (path.size() > 2 && path.compare(path.size() - 2, 2, ".o") == 0)
            deps.push_back(path);
    }
    if (deps.size() > 5)
        for (const std::string& line : linesOf(run(deps).text))
            if (line.rfind("    ", 0) == 0)
                add(line.substr(4));
    return inputs;
}

std::string Changes::since(const std::optional<Pass>& pass, const Test& test,
                           const std::string& seed) {
    if (tree_.empty())
        return "";
    const std::string commit = pass ? pass->commit.substr(0, pass->commit.find("-dirty")) : "HEAD";
    const auto* all = pass && !pass->tree.empty() ? differing(pass->tree) : nullptr;
    if (!all)
        all = differing(commit);
    if (!all || (!pass && all->empty()))
        return "";
    const bool program = isProgram(test, build_);
    const std::set<std::string> inputs = program ? inputsOf(test) : std::set<std::string>();
    const std::vector<std::string> folders =
        program ? std::vector<std::string>{"tests/" + test.place} : readsOf(test);
    std::vector<File> files;
    std::copy_if(all->begin(), all->end(), std::back_inserter(files), [&](const File& file) {
        return inputs.count(file.path) ||
               std::any_of(folders.begin(), folders.end(),
                           [&](auto& folder) { return file.path.rfind(folder + "/", 0) == 0; });
    });
    if (files.empty()) // what a script reads is not known to the last file
        files = *all;
    std::string text = !pass                ? "the commit; it is not known to have passed"
                       : pass->seed == seed ? "it passed at " + commit
                                            : "it passed at " + commit + " with SEED=" + pass->seed;
    if (files.empty())
        return "nothing has changed since " + text;
    text = "changed since " + text + ": ";
    for (size_t i = 0; i < std::min(shown, files.size()); ++i)
        text +=
            fmt::format("{}{}{}", i ? ", " : "", files[i].path,
                        files[i].line ? fmt::format(":{} ({} line{})", files[i].line,
                                                    files[i].lines, files[i].lines == 1 ? "" : "s")
                                      : "");
    return text + (files.size() > shown ? fmt::format(" and {} more", files.size() - shown) : "");
}
