// SPDX-License-Identifier: MIT

#include "failures.h"
#include "files.h"
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <regex>
#include <sstream>

namespace fs = std::filesystem;

namespace {

std::string strip(std::string text) {
    auto begin = text.find_first_not_of(" \t\r"), end = text.find_last_not_of(" \t\r");
    return begin == std::string::npos ? "" : text.substr(begin, end - begin + 1);
}

// Returns the test's own last words: GoogleTest's lines after the first "Failure", else the first
// that a compiler or a lint says of a line of a file, else the last line of the log, without what
// stands indented below a line that ends in a colon. Words of a runner or of a flight's end are
// left out: names, times and counts differ where causes do not.
std::string reasonOf(const std::string& log) {
    static const std::regex runners(R"(^\[|^at clock cycle|tests? (ran|FAILED|PASSED)|)"
                                    R"(^\s*\d+ FAILED|note:|trace: |Running main|)"
                                    R"(^The mission failed|^Its end|^icesoc-sim: Cortex-M3: |)"
                                    R"(^icesoc-sim: [0-9.]+ s simulated|^-- \S+ \S+ XBeeAT: )",
                                    std::regex::icase);
    static const std::regex ofFile(R"(^%(Error|Warning)[^ ]*: [^ ]+:\d+:|)"
                                   R"(^[^ ]+:\d+:(\d+:)? *((fatal|runtime) error|error|warning):|)"
                                   R"(^SUMMARY: \S+Sanitizer: |)"
                                   R"(^[^ ]+\.vhdl?:\d+:\d+:)");
    std::istringstream lines(log);
    std::string last, reason, first;
    bool failure = false;
    unsigned taken = 0;
    for (std::string line; std::getline(lines, line);) {
        const bool below = !line.empty() && line[0] == ' ' && !last.empty() && last.back() == ':';
        line = strip(line);
        if (failure && (line.empty() || line[0] == '[' || taken == 4))
            return reason;
        if (line.empty() || std::regex_search(line, runners) || (below && !failure))
            continue;
        if (failure) {
            reason += (taken++ ? " " : "") + line;
            continue;
        }
        failure = line.size() > 7 && line.compare(line.size() - 7, 7, "Failure") == 0;
        last = line;
        if (first.empty() && std::regex_search(line, ofFile))
            first = line;
    }
    return failure ? reason : first.empty() ? last : first;
}

// Adds to a proof's failure which assertion fails: its place and text, the instance in which it
// stands, and whether that is of the module that is proven. Yosys names the assertion's cell by
// instance, file and line, and beside it the lines of all cells around.
bool findAssertion(Failure& failure) {
    static const std::regex failed(
        R"(Assert failed in \S+: (\S+) \((?:\$flatten/)?(?:(\S*?)\.?\$assert\$(\S+)\$)?)"),
        place(R"([^|]*?((?:hdl|bus|ip)/[^|:]+):(\d+)[.](\d+)-(\d+))"); // file:89.41-91.66|...
    std::smatch match, at;
    if (!std::regex_search(failure.result.log, match, failed))
        return false;
    const std::string places = match[1];
    for (std::sregex_iterator it(places.begin(), places.end(), place), end; it != end; ++it)
        if (at.empty() ||
            (match[3].matched && it->str().find(match[3].str() + ".") != std::string::npos))
            at = *it;
    if (at.empty())
        return false;
    failure.scope = std::regex_replace(match[2].str(), std::regex("\\./"), ".");
    const int first = std::stoi(at[2]), last = std::stoi(at[4]);
    const std::string path = at.str().substr(at.str().find_first_not_of('|'));
    std::ifstream source(path.substr(0, path.find(':')));
    failure.about.clear();
    int assertion = first;
    std::string line;
    for (int number = 1; number <= last && std::getline(source, line); ++number) {
        if (number < first)
            continue;
        if (number == first && first < last) // Yosys begins at the end of the statement before
            line.erase(0, std::stoul(at[3]));
        line = strip(line);
        if (failure.about.find("assert") == std::string::npos)
            assertion = number;
        failure.about += (failure.about.empty() || line.empty() ? "" : " ") + line;
    }
    failure.reason = fmt::format("{}:{}: {}", at[1].str(), assertion, failure.about);
    failure.bucket = failure.reason;
    const std::string file = fs::path(at[1].str()).stem().string();
    const std::string module = file.substr(0, file.rfind("_proof"));
    return failure.result.name.rfind("formal." + module, 0) == 0;
}

std::string bucketOf(const std::string& reason) {
    static const std::regex numbers("0x[0-9a-fA-F]+|[0-9]+(\\.[0-9]+)?"), paths("[^ ]*/");
    return std::regex_replace(std::regex_replace(reason, paths, ""), numbers, "#").substr(0, 160);
}

// Ranks a test by when to look at its failure: first proofs, which name the property, of the module
// that has it before those of the modules around; then checks of sources; then tests of one block,
// of the chip, of the firmware; whole missions last.
int rankOf(const Failure& failure, const std::vector<Test>& tests) {
    if (failure.ownAssertion)
        return -1;
    const std::string& name = failure.result.name;
    std::string text = name;
    for (const Test& test : tests)
        if (test.name == name) {
            text += " " + test.place;
            for (const std::string& label : test.labels)
                text += " " + label;
        }
    static const std::regex order[] = {std::regex("^formal[.]"),
                                       std::regex("^(lint|tree)[.]"),
                                       std::regex("^(vhdl|slice)[.]|(hdl|bus|ip)/?.* rtl"),
                                       std::regex(" rtl"),
                                       std::regex(" (firmware|models)"),
                                       std::regex(" interop")};
    int rank = 0;
    for (const std::regex& kind : order) {
        if (std::regex_search(text, kind))
            return rank;
        ++rank;
    }
    return rank;
}

} // namespace

std::vector<Failure> examine(const std::vector<Result>& results, const std::vector<Test>& tests,
                             const std::string& out) {
    std::vector<Failure> failures;
    fs::path folder = fs::path(out) / "failures";
    fs::remove_all(folder);
    for (const Result& result : results) {
        if (result.status != "failed")
            continue;
        Failure failure;
        failure.result = result;
        failure.reason = reasonOf(result.log);
        if (!result.end.empty() || failure.reason.empty())
            failure.reason = (result.end.empty() ? "failed" : result.end) +
                             (failure.reason.empty() ? " without a word" : ": " + failure.reason);
        failure.about = failure.reason;
        failure.bucket = bucketOf(failure.reason);
        failure.ownAssertion = findAssertion(failure);
        static const std::regex place(R"((?:^|\n)(?:[.][.]/)*(\S+:\d+): Failure\n)");
        std::smatch match;
        if (std::regex_search(result.log, match, place))
            failure.place = fs::path(match[1].str()).is_absolute()
                                ? fs::path(match[1].str()).lexically_relative(fs::current_path())
                                : fs::path(match[1].str());
        std::string exact =
            std::regex_replace(result.name, std::regex(R"([.+*?()\[\]{}|^$\\])"), "\\$&");
        failure.repeat = fmt::format("make test NAME='^{}$$' SEED={}", exact, result.seed);
        fs::create_directories(folder);
        std::string file = std::regex_replace(result.name, std::regex("[^A-Za-z0-9_.-]"), "_");
        failure.log = (folder / (file + "-" + result.seed + ".log")).string();
        // A proof has its trace already.
        static const std::regex trace("trace: (\\S+[.]vcd)");
        if (std::regex_search(result.log, match, trace) && fs::exists(match[1].str())) {
            failure.wave = (folder / (file + ".vcd")).string();
            fs::copy_file(match[1].str(), failure.wave, fs::copy_options::overwrite_existing);
        }
        writeFile(failure.log, "# " + failure.repeat + "\n" + result.log);
        failures.push_back(std::move(failure));
    }
    std::stable_sort(failures.begin(), failures.end(), [&](const Failure& a, const Failure& b) {
        return rankOf(a, tests) < rankOf(b, tests);
    });
    return failures;
}
