// SPDX-License-Identifier: MIT

#include "plan.h"
#include <fmt/format.h>
#include <fnmatch.h>
#include <fstream>
#include <regex>
#include <stdexcept>

namespace {

bool matches(const std::string& pattern, const std::string& name) {
    return fnmatch(pattern.c_str(), name.c_str(), FNM_NOESCAPE) == 0;
}

} // namespace

bool mayMatch(const std::string& pattern, const Test& test) {
    return isUnbuilt(test) ? matches(pattern.substr(0, pattern.find('.')), programOf(test))
                           : matches(pattern, test.name);
}

std::vector<Requirement> readPlan(const std::string& file) {
    static const std::regex heading(R"(## \[([a-z0-9-]+)\]\(.*\))"),
        row(R"(\| (.*[^ ]) \| (`[^`|]+`( `[^`|]+`)*) \|)"), head(R"(\| requirement .*|\|[-|]*\|)"),
        quoted("`([^`]+)`");
    std::vector<Requirement> plan;
    std::ifstream in(file);
    std::string page;
    unsigned number = 0;
    for (std::string line; std::getline(in, line);) {
        ++number;
        std::smatch match;
        if (std::regex_match(line, match, heading)) {
            page = match[1];
        } else if (std::regex_match(line, match, row) && !page.empty()) {
            plan.push_back({page, match[1], {}});
            const std::string cell = match[2];
            for (std::sregex_iterator it(cell.begin(), cell.end(), quoted), end; it != end; ++it)
                plan.back().patterns.push_back((*it)[1]);
        } else if (!line.empty() && line[0] == '|' && !std::regex_match(line, head)) {
            throw std::runtime_error(fmt::format(
                "{}:{}: not `| requirement | `test.pattern` ... |` below a page's heading", file,
                number));
        }
    }
    return plan;
}

std::vector<std::string> unmatched(const std::vector<Requirement>& plan,
                                   const std::vector<Test>& tests) {
    std::vector<std::string> wrong;
    for (const Requirement& each : plan)
        for (const std::string& pattern : each.patterns)
            if (std::none_of(tests.begin(), tests.end(),
                             [&](const Test& test) { return mayMatch(pattern, test); }))
                wrong.push_back(
                    fmt::format("no test is called {}, which is to prove: {}", pattern, each.text));
    return wrong;
}

nlohmann::json judgePlan(const std::vector<Requirement>& plan, const std::vector<Test>& tests,
                         const History& history) {
    nlohmann::json rows = nlohmann::json::array();
    for (const Requirement& each : plan) {
        std::vector<std::string> failed = unmatched({each}, tests), notRun;
        unsigned count = 0;
        for (const Test& test : tests) {
            if (std::none_of(each.patterns.begin(), each.patterns.end(),
                             [&](const auto& pattern) { return mayMatch(pattern, test); }))
                continue;
            ++count;
            if (history.last(test.name) == "f")
                failed.push_back(test.name);
            else if (isUnbuilt(test) || history.passedWith(test.name) != test.print)
                notRun.push_back(test.name);
        }
        rows.push_back({{"page", each.page},
                        {"text", each.text},
                        {"state", !failed.empty()  ? "failed"
                                  : notRun.empty() ? "proven"
                                                   : "open"},
                        {"patterns", each.patterns},
                        {"tests", count},
                        {"open", failed.empty() ? notRun : failed}});
    }
    return rows;
}
