// SPDX-License-Identifier: MIT

#include "test_list.h"
#include "files.h"
#include "process.h"
#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

namespace fs = std::filesystem;

namespace {

const std::string notBuilt = "_NOT_BUILT"; // what CTest calls a program without its cases

// Returns the folders that a test reads which is no program of its own.
std::vector<std::string> readsOf(const Test& test) {
    if (test.place.find("formal") != std::string::npos ||
        test.place.find("lint") != std::string::npos)
        return {"bus", "hdl", "ip", "tests/" + test.place};
    if (test.place.rfind("slice", 0) == 0)
        return {"slice", "tests/slice"};
    return {"bus", "hdl", "ip", "slice", "sw", "testbench", "tests/" + test.place};
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
            if (property.at("name") == "FIXTURES_REQUIRED")
                test.needs = property.at("value").get<std::vector<std::string>>();
            if (property.at("name") == "FIXTURES_SETUP")
                test.sets = property.at("value").get<std::vector<std::string>>();
            if (property.at("name") == "WORKING_DIRECTORY") {
                std::string folder = property.at("value");
                test.place = folder.rfind(below, 0) == 0 ? folder.substr(below.size())
                                                         : fs::path(folder).filename().string();
            }
        }
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

bool isUnbuilt(const Test& test) {
    return test.name.size() > notBuilt.size() &&
           test.name.compare(test.name.size() - notBuilt.size(), notBuilt.size(), notBuilt) == 0;
}

std::vector<std::string> targetsOf(const Test& test, const std::string& build) {
    const std::string root = fs::canonical(build).string() + "/";
    if (isUnbuilt(test))
        return {test.name.substr(0, test.name.size() - notBuilt.size())};
    if (test.name.rfind("formal.", 0) == 0)
        return {"regmaps"};
    std::vector<std::string> targets;
    for (const std::string& word : test.command)
        if (word.rfind(root, 0) == 0)
            targets.push_back(word.substr(root.size()));
    // A script may need more than the programs that its command names.
    bool program = targets.size() == 1 && test.command[0].find("/test_") != std::string::npos;
    return program ? targets : std::vector<std::string>{"all"};
}

void fingerprint(std::vector<Test>& tests, const std::string& source, const std::string& build) {
    const std::map<std::string, std::string> fileHash = fileHashes(source);
    std::map<std::string, std::string> programHash;
    for (Test& test : tests) {
        std::vector<std::string> parts;
        bool program = !test.command.empty() &&
                       test.command[0].find("/test_") != std::string::npos &&
                       test.command[0].rfind(fs::absolute(build).string(), 0) == 0;
        if (program) {
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
