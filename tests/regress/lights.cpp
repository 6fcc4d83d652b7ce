// SPDX-License-Identifier: MIT
//
// lights: each looks at its own figures only, so that a bug of one kind turns one light red.

#include "lights.h"
#include "files.h"
#include <fmt/format.h>
#include <vector>

using nlohmann::json;

namespace {

json light(const std::string& name, const std::string& state, const std::string& text) {
    return {{"name", name}, {"state", state}, {"text", text}};
}

json missing(const std::string& name, const std::string& command) {
    return light(name, "grey", "not measured: " + command);
}

// Green with `good`, or red with the first few of what is wrong.
json judge(const std::string& name, const std::string& good, const std::string& wrong,
           const std::vector<std::string>& bad) {
    if (bad.empty())
        return light(name, "green", good);
    std::string text = fmt::format("{} {}: ", bad.size(), wrong);
    for (size_t i = 0; i < bad.size() && i < 3; ++i)
        text += (i ? ", " : "") + bad[i];
    return light(name, "red", text + (bad.size() > 3 ? ", ..." : ""));
}

// Rows of `results` are [name, status, ...]; proofs are the tests named formal.*
json ofTests(const json& data, bool proofs) {
    std::vector<std::string> bad;
    unsigned passed = 0;
    for (const json& row : data.at("results")) {
        std::string name = row.at(0), status = row.at(1);
        if ((name.rfind("formal.", 0) == 0) != proofs)
            continue;
        passed += status == "passed";
        if (status == "failed")
            bad.push_back(name);
    }
    if (bad.empty() && passed == 0)
        return missing(proofs ? "proofs" : "tests", "none ran");
    std::string good = fmt::format("{} {}", passed, proofs ? "hold" : "passed");
    if (const unsigned kept = data.at("kept").at(proofs ? "proofs" : "tests"))
        good += fmt::format(", {} of them as before, from unchanged files", kept);
    if (const unsigned left = data.at("left").at(proofs ? "proofs" : "tests"))
        good += fmt::format(", {} did not run", left);
    return judge(proofs ? "proofs" : "tests", good, "failed", bad);
}

// The light of the mutants: drawn ones count by their module's score, if the sources are the same.
json ofMutants(const json& rows, const json& drawn, const std::string& source) {
    std::vector<std::string> bad;
    const std::string tree = drawn.value("tree", "");
    if (!tree.empty() && treeState(source, tree.substr(0, tree.find(':'))) == tree)
        for (const auto& [module, score] : drawn.at("modules").items())
            if (score.at("score") < drawn.at("gate"))
                bad.push_back(module);
    if (!bad.empty())
        return judge("mutants", "", "modules of which proofs and tests miss drawn mutants", bad);
    if (rows.empty())
        return missing("mutants", "make mutants");
    for (const json& row : rows)
        if (row.at(1) != "caught")
            bad.push_back(row.at(0));
    return judge("mutants", fmt::format("{} of {} caught", rows.size(), rows.size()),
                 fmt::format("of {} not caught", rows.size()), bad);
}

json ofCoverage(const json& data) {
    if (!data.contains("coverage"))
        return missing("coverage", "make coverage");
    const json& coverage = data["coverage"];
    std::vector<std::string> bad;
    for (const json& file : coverage.at("files"))
        if (file.at("percent") < file.at("gate") ||
            (file.value("toggle_points", 0) > 0 &&
             file.value("toggles", 100.0) < file.value("toggle_gate", 0.0)) ||
            file.value("point_percent", 100.0) < file.value("point_gate", 0.0))
            bad.push_back(file.at("file"));
    return judge("coverage",
                 fmt::format("{:.1f} % of lines, {:.1f} % of toggles, {} of {} cover points",
                             coverage.at("total").get<double>(), coverage.value("toggles", 0.0),
                             coverage.value("points", 0), coverage.value("points_total", 0)),
                 "files below their gate", bad);
}

// Entries with a limit: most allowed, or least where the unit says "at least".
json ofEntries(const std::string& name, const json& entries, const std::string& command) {
    std::vector<std::string> bad;
    unsigned limits = 0;
    for (const json& entry : entries) {
        if (!entry.is_object() || !entry.contains("limit"))
            continue;
        ++limits;
        double value = entry.at("value"), limit = entry.at("limit");
        bool least = entry.value("unit", "").find("at least") != std::string::npos;
        if (least ? value < limit : value > limit)
            bad.push_back(fmt::format("{} {:g} ({} {:g})", entry.at("name").get<std::string>(),
                                      value, least ? "at least" : "at most", limit));
    }
    return limits ? judge(name, fmt::format("{} figures within their limits", limits),
                          "beyond their limits", bad)
                  : missing(name, command);
}

// A design that failed has no figure: what `make synth` says decides.
json ofSize(const json& utilisation) {
    if (!utilisation.is_object())
        return missing("size", "make synth");
    std::vector<std::string> failures = utilisation.at("failures");
    if (!failures.empty())
        return judge("size", "", "designs failed", failures);
    if (!utilisation.at("missing").empty())
        return light("size", "grey",
                     fmt::format("{} designs have changed since they were synthesised: make synth",
                                 utilisation["missing"].size()));
    return ofEntries("size", utilisation.at("entries"), "make synth");
}

json ofPlan(const json& plan) {
    std::vector<std::string> bad;
    size_t proven = 0;
    for (const json& each : plan) {
        proven += each.at("state") == "proven";
        if (each.at("state") == "failed")
            bad.push_back(each.at("text"));
    }
    json all = judge("plan", fmt::format("{} requirements of docs/ are proven", proven),
                     fmt::format("of {} requirements of docs/ are not proven", plan.size()), bad);
    if (bad.empty() && proven < plan.size())
        all = light("plan", "grey",
                    fmt::format("{} of {} requirements of docs/ are proven; tests of the others "
                                "have not run with these sources",
                                proven, plan.size()));
    return all;
}

} // namespace

json lightsOf(const json& data, const std::string& source) {
    json lights = {ofTests(data, false), ofTests(data, true)};
    if (!data.at("plan").empty())
        lights.push_back(ofPlan(data["plan"]));
    // A measurement keeps the state of the tree that it measured (treeState).
    const auto add = [&](json light) {
        const std::string tree = data.at("trees").value(light["name"].get<std::string>(), "");
        const std::string folders = tree.substr(0, tree.find(':'));
        if (light["state"] != "grey" && treeState(source, folders) != tree) {
            light["text"] =
                fmt::format("sources have changed since it was {}: {}",
                            light["state"].get<std::string>(), light["text"].get<std::string>());
            light["state"] = "grey";
        }
        lights.push_back(light);
    };
    add(ofMutants(data.at("mutants"), data.value("drawn", json::object()), source));
    add(ofCoverage(data));
    add(ofSize(data.value("utilisation", json())));
    add(ofEntries("speed", data.value("speed", json::object()).value("entries", json::array()),
                  "make bench"));
    return lights;
}

std::string lightsText(const json& lights) {
    std::string text;
    for (const json& each : lights)
        text +=
            fmt::format("{:<9} {:<6} {}\n", each.at("name").get<std::string>(),
                        each.at("state").get<std::string>(), each.at("text").get<std::string>());
    return text;
}
