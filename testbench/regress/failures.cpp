// SPDX-License-Identifier: MIT

#include "failures.h"
#include "shell.h"
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <regex>
#include <sstream>
#include <stdexcept>

namespace fs = std::filesystem;

namespace {

std::string strip(std::string text) {
    auto begin = text.find_first_not_of(" \t\r"), end = text.find_last_not_of(" \t\r");
    return begin == std::string::npos ? "" : text.substr(begin, end - begin + 1);
}

// GoogleTest's lines after "Failure"; else the last line that speaks of an error; else the last one.
std::string reasonOf(const std::string& log) {
    std::istringstream lines(log);
    std::string last, error, reason;
    static const std::regex trouble("error|fail|throw|exception|not |cannot|SURVIVED", std::regex::icase);
    static const std::regex noise(R"(^\[|tests? (ran|FAILED|PASSED)|^\s*\d+ FAILED|note:)", std::regex::icase);
    unsigned wanted = 0;
    for (std::string line; std::getline(lines, line);) {
        line = strip(line);
        if (line.empty() || line.rfind("at clock cycle", 0) == 0)
            continue;
        if (wanted > 0) {
            reason += (reason.empty() ? "" : " ") + line;
            if (--wanted == 0)
                return reason;
            continue;
        }
        if (line.size() > 7 && line.compare(line.size() - 7, 7, "Failure") == 0 && reason.empty()) {
            wanted = 4;
            continue;
        }
        if (!std::regex_search(line, noise)) {
            last = line;
            if (std::regex_search(line, trouble))
                error = line;
        }
    }
    return !reason.empty() ? reason : !error.empty() ? error : last;
}

std::string bucketOf(const std::string& reason) {
    static const std::regex numbers("0x[0-9a-fA-F]+|[0-9]+(\\.[0-9]+)?"), paths("[^ ]*/");
    return std::regex_replace(std::regex_replace(reason, paths, ""), numbers, "#").substr(0, 160);
}

} // namespace

std::vector<Failure> examine(const std::vector<Result>& results, const std::string& out) {
    std::vector<Failure> failures;
    fs::path folder = fs::path(out) / "failures";
    fs::remove_all(folder);
    for (const Result& result : results) {
        if (result.status != "failed")
            continue;
        Failure failure;
        failure.result = result;
        failure.reason = reasonOf(result.log);
        failure.bucket = bucketOf(failure.reason);
        std::string exact = std::regex_replace(result.name, std::regex(R"([.+*?()\[\]{}|^$\\])"), "\\$&");
        failure.repeat = fmt::format("make test NAME='^{}$$' SEED={}", exact, result.seed);
        fs::create_directories(folder);
        std::string file = std::regex_replace(result.name, std::regex("[^A-Za-z0-9_.-]"), "_");
        failure.log = (folder / (file + "-" + result.seed + ".log")).string();
        std::ofstream log(failure.log);
        log << "# " << failure.repeat << '\n' << result.log;
        if (!log.flush())
            throw std::runtime_error("cannot write " + failure.log + ": is the disk full?");
        failures.push_back(std::move(failure));
    }
    return failures;
}
