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

// Returns the test's own last words: GoogleTest's lines after the first "Failure", else the last
// line of the log, without what stands indented below a line that ends in a colon. Words of a
// runner or of a flight's end are left out: names, times and counts differ where causes do not.
std::string reasonOf(const std::string& log) {
    static const std::regex runners(R"(^\[|^at clock cycle|tests? (ran|FAILED|PASSED)|)"
                                    R"(^\s*\d+ FAILED|note:|trace: |Running main|)"
                                    R"(^The mission failed|^Its end|^icesoc-sim: Cortex-M3: |)"
                                    R"(^icesoc-sim: [0-9.]+ s simulated)",
                                    std::regex::icase);
    std::istringstream lines(log);
    std::string last, reason;
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
    }
    return failure ? reason : last;
}

// Returns the text of the assertion of a proof that fails, and adds it and its place to `reason`.
std::string assertionOf(const std::string& log, std::string& reason) {
    static const std::regex failed(
        R"(Assert failed in \S+: ((?:/\S*/)?((?:hdl|bus|ip)/\S+?)):(\d+)[.]\d+-(\d+))");
    std::smatch match;
    if (!std::regex_search(log, match, failed))
        return "";
    std::ifstream file(match[1].str());
    const int first = std::stoi(match[3]), last = std::stoi(match[4]);
    std::string text;
    for (int number = 1; number <= last && file; ++number) {
        std::string line;
        std::getline(file, line);
        if (number >= first)
            text += (text.empty() ? "" : " ") + strip(line);
    }
    reason += fmt::format(": {}:{}: {}", match[2].str(), first, text);
    return text;
}

std::string bucketOf(const std::string& reason) {
    static const std::regex numbers("0x[0-9a-fA-F]+|[0-9]+(\\.[0-9]+)?"), paths("[^ ]*/");
    return std::regex_replace(std::regex_replace(reason, paths, ""), numbers, "#").substr(0, 160);
}

// Ranks a test by when to look at its failure: first proofs, which name the property; then checks
// of sources; then tests of one block, of the chip, of the firmware; whole missions last.
int rankOf(const std::string& name, const std::vector<Test>& tests) {
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
        failure.assertion = assertionOf(result.log, failure.reason);
        failure.bucket = bucketOf(failure.reason);
        std::string exact =
            std::regex_replace(result.name, std::regex(R"([.+*?()\[\]{}|^$\\])"), "\\$&");
        failure.repeat = fmt::format("make test NAME='^{}$$' SEED={}", exact, result.seed);
        fs::create_directories(folder);
        std::string file = std::regex_replace(result.name, std::regex("[^A-Za-z0-9_.-]"), "_");
        failure.log = (folder / (file + "-" + result.seed + ".log")).string();
        // A proof has its trace already.
        static const std::regex trace("trace: (\\S+[.]vcd)");
        std::smatch match;
        if (std::regex_search(result.log, match, trace) && fs::exists(match[1].str())) {
            failure.wave = (folder / (file + ".vcd")).string();
            fs::copy_file(match[1].str(), failure.wave, fs::copy_options::overwrite_existing);
        }
        writeFile(failure.log, "# " + failure.repeat + "\n" + result.log);
        failures.push_back(std::move(failure));
    }
    std::stable_sort(failures.begin(), failures.end(), [&](const Failure& a, const Failure& b) {
        return rankOf(a.result.name, tests) < rankOf(b.result.name, tests);
    });
    return failures;
}
