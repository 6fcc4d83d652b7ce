// SPDX-License-Identifier: MIT

#include "runner.h"
#include "files.h"
#include "process.h"
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <pugixml.hpp>
#include <regex>
#include <sstream>
#include <stdexcept>

namespace fs = std::filesystem;

namespace {

std::string readable(const std::string& log) {
    constexpr size_t longest = 2000;
    static const std::regex colour(R"(\[NON-XML-CHAR-0x1B\]\[[0-9;]*m)"); // CTest's word for ESC
    std::istringstream in(log);
    std::string text;
    for (std::string line; std::getline(in, line);)
        text += (line.size() > longest
                     ? fmt::format("{} ... {} characters ... {}", line.substr(0, longest / 2),
                                   line.size(), line.substr(line.size() - longest / 4))
                     : std::regex_replace(line, colour, "")) +
                "\n";
    return text;
}

} // namespace

std::vector<Result> readJUnit(const std::string& path) {
    pugi::xml_document document;
    auto parsed = document.load_file(path.c_str());
    if (!parsed)
        throw std::runtime_error(
            fmt::format("{}: {}; is the disk full?", path, parsed.description()));
    std::vector<Result> results;
    for (auto node : document.child("testsuite").children("testcase")) {
        Result result;
        result.name = node.attribute("name").value();
        result.seconds = node.attribute("time").as_double();
        std::string status = node.attribute("status").value();
        result.log = readable(node.child("system-out").text().get());
        const bool missing = result.log.rfind("Unable to find", 0) == 0; // its program
        result.status = status == "run"               ? "passed"
                        : status == "fail" || missing ? "failed"
                                                      : "skipped";
        results.push_back(std::move(result));
    }
    return results;
}

void writeJUnit(const std::string& path, const std::vector<Result>& results,
                const Properties& properties) {
    pugi::xml_document document;
    auto suite = document.append_child("testsuite");
    unsigned failures = 0, skipped = 0;
    for (const Result& result : results) {
        auto node = suite.append_child("testcase");
        node.append_attribute("name") = result.name.c_str();
        node.append_attribute("classname") = result.name.substr(0, result.name.find('.')).c_str();
        node.append_attribute("time") = result.seconds;
        if (result.status == "failed") {
            ++failures;
            std::string message = "SEED=" + result.seed;
            if (auto found = properties.find(result.name); found != properties.end()) {
                auto list = node.append_child("properties");
                for (const auto& [name, value] : found->second) {
                    if (name == "reason") {
                        message = value + " (" + message + ")";
                        continue;
                    }
                    auto property = list.append_child("property");
                    property.append_attribute("name") = name.c_str();
                    property.append_attribute("value") = value.c_str();
                }
            }
            node.append_child("failure").append_attribute("message") = message.c_str();
            node.append_child("system-out").text().set(result.log.c_str());
        } else if (result.status == "skipped") {
            ++skipped;
            node.append_child("skipped");
        }
    }
    suite.append_attribute("name") = "icesoc";
    suite.append_attribute("tests") = static_cast<unsigned>(results.size());
    suite.append_attribute("failures") = failures;
    suite.append_attribute("skipped") = skipped;
    if (!document.save_file(path.c_str()))
        throw std::runtime_error("cannot write " + path + ": is the disk full?");
}

std::vector<Result> runHere(const std::vector<Test>& tests, const RunOptions& options) {
    std::string list = options.out + "/tests.list";
    std::string numbers = "0,0,0"; // start, end, stride: none but the numbers
    for (const Test& test : tests)
        numbers += "," + std::to_string(test.number);
    writeFile(list, numbers + "\n");
    std::string junit = fs::absolute(options.out + "/junit-" + options.seed + ".xml");
    fs::remove(junit);
    std::regex ended(R"(^ *\d+/\d+ Test +#\d+: (\S+) \.*(.*?) +([0-9.]+) sec.*)");
    std::regex started(R"(^ *Start +\d+: (\S+))");
    unsigned done = 0;
    std::map<std::string, std::string> ends; // CTest's words: "***Exception: SegFault"
    Output out =
        run({"ctest", "--test-dir", options.build, "-I", fs::absolute(list), "-j",
             std::to_string(options.jobs), "--output-junit", junit, "--test-output-size-passed",
             "4096", "--test-output-size-failed", "200000", "--test-output-truncation", "middle"},
            {{"SEED", options.seed}}, [&](const std::string& line) {
                std::smatch match;
                if (std::regex_match(line, match, started) && options.onStart)
                    options.onStart(match[1]);
                if (!std::regex_match(line, match, ended))
                    return;
                Result result;
                result.name = match[1];
                std::string how = match[2];
                ends[result.name] = how;
                result.status = how.find("Passed") != std::string::npos    ? "passed"
                                : how.find("Skipped") != std::string::npos ? "skipped"
                                                                           : "failed";
                result.seconds = std::stod(match[3]);
                result.seed = options.seed;
                if (options.onEnd)
                    options.onEnd(result, ++done, static_cast<unsigned>(tests.size()));
            });
    if (!fs::exists(junit))
        throw std::runtime_error("ctest gave no results:\n" + out.text);
    auto results = readJUnit(junit);
    for (Result& result : results) {
        result.seed = options.seed;
        if (const std::string& how = ends[result.name]; how != "***Failed" && how != "***Not Run")
            result.end = std::regex_replace(how, std::regex("[*]{3}(Exception: *)?"), "");
    }
    return results;
}
