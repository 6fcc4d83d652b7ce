// SPDX-License-Identifier: MIT

#include "seeds.h"
#include "files.h"
#include <ctime>
#include <fstream>
#include <set>

using nlohmann::json;

FailingSeeds::FailingSeeds(std::string path) : path_(std::move(path)) {
    std::ifstream file(path_);
    for (std::string line; std::getline(file, line);) {
        json entry = json::parse(line, nullptr, false);
        if (entry.is_object() && entry.contains("test") && entry.contains("seed") &&
            entry.contains("times"))
            kept_[{entry["test"], entry["seed"]}] = entry;
    }
}

void FailingSeeds::update(const std::vector<Result>& results, const std::string& commit) {
    for (const Result& result : results) {
        std::pair<std::string, std::string> key(result.name, result.seed);
        auto it = kept_.find(key);
        if (result.status == "passed" && it != kept_.end())
            kept_.erase(it);
        if (result.status != "failed")
            continue;
        if (it == kept_.end())
            it = kept_
                     .emplace(key, json{{"test", result.name},
                                        {"seed", result.seed},
                                        {"commit", commit},
                                        {"times", 0},
                                        {"since", static_cast<int64_t>(std::time(nullptr))}})
                     .first;
        it->second["times"] = it->second["times"].get<int>() + 1;
    }
    write();
}

std::vector<std::string> FailingSeeds::forgetOthers(const std::vector<Test>& tests) {
    std::set<std::string> names, gone;
    for (const Test& test : tests)
        names.insert(test.name);
    for (auto it = kept_.begin(); it != kept_.end();) {
        bool known = names.count(it->first.first) != 0;
        if (!known)
            gone.insert(it->first.first);
        it = known ? std::next(it) : kept_.erase(it);
    }
    return {gone.begin(), gone.end()};
}

std::map<std::string, std::vector<std::string>> FailingSeeds::bySeed() const {
    std::map<std::string, std::vector<std::string>> seeds;
    for (const auto& [key, entry] : kept_)
        seeds[key.second].push_back(key.first);
    return seeds;
}

json FailingSeeds::list() const {
    json entries = json::array();
    for (const auto& [key, entry] : kept_)
        entries.push_back(entry);
    return entries;
}

void FailingSeeds::write() const {
    std::string text;
    for (const auto& [key, entry] : kept_)
        text += entry.dump() + "\n";
    writeFile(path_, text);
}
