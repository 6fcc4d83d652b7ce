// SPDX-License-Identifier: MIT

#include "test_list.h"
#include "files.h"
#include "process.h"
#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <stdexcept>

namespace fs = std::filesystem;

namespace {

const std::string notBuilt = "_NOT_BUILT"; // what CTest calls a program without its cases

// Returns the labels that icesoc_test() gives to the cases of a program.
std::vector<std::string> labelsOfCases(const Test& unbuilt) {
    const std::string file = unbuilt.folder + "/" + programOf(unbuilt) + "_labels.cmake";
    std::vector<std::string> labels;
    if (!fs::exists(file))
        return labels;
    const std::string text = readFile(file);
    const std::regex list("LABELS \"([^\"]*)\"");
    for (std::sregex_iterator match(text.begin(), text.end(), list), end; match != end; ++match) {
        std::istringstream words((*match)[1]);
        for (std::string label; std::getline(words, label, ';');)
            labels.push_back(label);
    }
    return labels;
}

} // namespace

std::vector<Test> listTests(const std::string& build) {
    Output out = run({"ctest", "--test-dir", build, "--show-only=json-v1"});
    if (out.status != 0)
        throw std::runtime_error("ctest cannot list the tests of " + build + ":\n" + out.text);
    auto begin = out.text.find('{');
    if (begin == std::string::npos)
        throw std::runtime_error("ctest lists no tests in " + build + "; run `make build` first");
    auto json = nlohmann::json::parse(out.text.substr(begin));
    const std::string below = fs::canonical(build).string() + "/tests/";
    std::vector<Test> tests;
    for (auto& entry : json.at("tests")) {
        Test test;
        test.number = static_cast<unsigned>(tests.size() + 1);
        test.name = entry.at("name");
        if (entry.contains("command"))
            test.command = entry["command"].get<std::vector<std::string>>();
        for (auto& property : entry.value("properties", nlohmann::json::array())) {
            if (property.at("name") == "LABELS")
                test.labels = property.at("value").get<std::vector<std::string>>();
            if (property.at("name") == "ENVIRONMENT")
                for (const std::string word : property.at("value"))
                    if (word.rfind("NEEDS=", 0) == 0)
                        test.targets = word.substr(6);
            if (property.at("name") == "FIXTURES_REQUIRED")
                test.needs = property.at("value").get<std::vector<std::string>>();
            if (property.at("name") == "FIXTURES_SETUP")
                test.sets = property.at("value").get<std::vector<std::string>>();
            if (property.at("name") == "WORKING_DIRECTORY") {
                const std::string& folder = test.folder = property.at("value");
                test.place = folder.rfind(below, 0) == 0 ? folder.substr(below.size())
                                                         : fs::path(folder).filename().string();
            }
        }
        if (isUnbuilt(test))
            test.labels = labelsOfCases(test);
        tests.push_back(std::move(test));
    }
    return tests;
}

std::set<std::string> blockWords(const Test& test) {
    std::set<std::string> words;
    std::string text = test.place + "/" + test.name.substr(0, test.name.find('.'));
    if (test.name.rfind("formal.", 0) == 0 || test.name.rfind("lint.", 0) == 0 ||
        test.name.rfind("wave.", 0) == 0)
        text += "/" + test.name.substr(test.name.find('.') + 1);
    std::string word;
    for (char c : text + "/") {
        if (std::isalnum(static_cast<unsigned char>(c))) {
            word += c;
        } else {
            if (!word.empty())
                words.insert(word);
            word.clear();
        }
    }
    return words;
}

std::vector<std::string> readsOf(const Test& test) {
    if (test.place.find("formal") != std::string::npos ||
        test.place.find("lint") != std::string::npos)
        return {"bus", "hdl", "ip", "tests/" + test.place};
    if (test.place.rfind("slice", 0) == 0)
        return {"slice", "tests/slice"};
    return {"bus", "hdl", "ip", "slice", "sw", "testbench", "tests/" + test.place};
}

bool isProgram(const Test& test, const std::string& build) {
    return !test.command.empty() && test.command[0].find("/test_") != std::string::npos &&
           test.command[0].rfind(fs::absolute(build).string(), 0) == 0;
}

bool isUnbuilt(const Test& test) {
    return test.name.size() > notBuilt.size() &&
           test.name.compare(test.name.size() - notBuilt.size(), notBuilt.size(), notBuilt) == 0;
}

std::string programOf(const Test& unbuilt) {
    return unbuilt.name.substr(0, unbuilt.name.size() - notBuilt.size());
}

// A case is called program.Suite.Case, and suites begin with a capital letter.
bool mayHold(const Test& unbuilt, const std::string& name) {
    static const std::regex beginning("(\\^?)([a-z0-9_]+)(\\\\?[.])?.*");
    std::smatch word;
    if (name.find_first_of("|?*{") != std::string::npos || !std::regex_match(name, word, beginning))
        return true;
    const std::string program = programOf(unbuilt) + ".", head = word[2];
    const bool anchored = word.length(1) > 0 || head.rfind("test_", 0) == 0;
    if (word.length(3) > 0) // the program's name ends here
        return anchored ? program == head + "." : program.find(head + ".") != std::string::npos;
    return !anchored || program.rfind(head, 0) == 0;
}

std::set<std::string> outputsOf(const std::string& build) {
    Output out = run({"ninja", "-C", build, "-t", "targets", "all"});
    std::set<std::string> outputs;
    std::istringstream lines(out.text);
    for (std::string line; std::getline(lines, line);)
        outputs.insert(line.substr(0, line.rfind(':')));
    return outputs;
}

std::vector<std::string> targetsOf(const Test& test, const std::string& build,
                                   const std::set<std::string>& outputs) {
    if (isUnbuilt(test))
        return {programOf(test)};
    if (test.name.rfind("formal.", 0) == 0)
        return {"regmaps"};
    if (test.targets) {
        std::istringstream words(*test.targets);
        return {std::istream_iterator<std::string>(words), {}};
    }
    const std::string root = fs::canonical(build).string();
    std::vector<std::string> targets;
    for (const std::string& word : test.command)
        for (size_t at = word.find(root); at != std::string::npos; at = word.find(root, at + 1)) {
            const std::string path = word.substr(at, word.find_first_of(" '\":;,<>", at) - at);
            if (path.rfind(test.folder + "/", 0) == 0 &&
                !outputs.count(path.substr(root.size() + 1)))
                continue; // the test makes it
            const std::string target = path.substr(std::min(path.size(), root.size() + 1));
            const std::string name = fs::path(target).filename(); // Ice adds .so to a plugin's
            targets.push_back(target == "gen"         ? "synth_inputs"
                              : outputs.count(target) ? target
                              : outputs.count(name)   ? name
                                                      : "all");
        }
    return targets;
}

void fingerprint(std::vector<Test>& tests, const std::string& source, const std::string& build) {
    const std::map<std::string, std::string> fileHash = fileHashes(source);
    std::map<std::string, std::string> programHash;
    for (Test& test : tests) {
        std::vector<std::string> parts;
        if (isProgram(test, build)) {
            auto found = programHash.find(test.command[0]);
            if (found == programHash.end())
                found = programHash
                            .emplace(test.command[0], fs::exists(test.command[0])
                                                          ? hexHash({readFile(test.command[0])})
                                                          : "")
                            .first;
            parts.push_back(found->second);
        } else {
            for (const std::string& folder : readsOf(test))
                for (auto it = fileHash.lower_bound(folder + "/");
                     it != fileHash.end() && it->first.rfind(folder + "/", 0) == 0; ++it)
                    parts.push_back(it->second);
        }
        test.print = hexHash(parts);
    }
}
