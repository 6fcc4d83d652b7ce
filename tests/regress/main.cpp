// SPDX-License-Identifier: MIT
//
// regress: runs chosen tests, keeps what failed, remembers, and writes the pages. `make regress`
// calls it.

#include "budget.h"
#include "changes.h"
#include "failures.h"
#include "files.h"
#include "history.h"
#include "lights.h"
#include "process.h"
#include "progress.h"
#include "report.h"
#include "seeds.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fmt/format.h>
#include <iostream>
#include <map>
#include <random>
#include <regex>
#include <set>

namespace fs = std::filesystem;

namespace {

struct Options {
    std::string source = ".", build = "build/main", out = "build/regress", seed = "1",
                launcher = "local", tree;
    Selection selection;
    unsigned jobs = 2, repeat = 1, waves = 3;
    double budget = 0; // seconds; 0: as long as it takes
    bool list = false, kept = false, make = false, plan = false, prepare = false;
};

std::regex regexOf(const std::string& variable, const std::string& text) {
    try {
        return std::regex(text);
    } catch (const std::regex_error&) {
        throw std::runtime_error(fmt::format(
            "{}='{}' is no regular expression, in which .* is any text", variable, text));
    }
}

std::vector<Test> choose(const std::vector<Test>& all, const Selection& selection,
                         const History& history) {
    std::vector<Test> chosen;
    const std::regex name = regexOf("NAME", selection.name),
                     label = regexOf("LABEL", selection.label);
    const bool exact = std::any_of(all.begin(), all.end(),
                                   [&](const Test& test) { return test.name == selection.name; });
    for (const Test& test : all) {
        if (!selection.block.empty() && !blockWords(test).count(selection.block))
            continue;
        const bool unbuilt = isUnbuilt(test);
        if (!selection.label.empty() && !(unbuilt && test.labels.empty()) &&
            std::none_of(test.labels.begin(), test.labels.end(),
                         [&](const std::string& each) { return std::regex_search(each, label); }))
            continue;
        if (unbuilt) { // its cases are not known
            if (!exact && mayHold(test, selection.name))
                chosen.push_back(test);
            continue;
        }
        if (!(exact ? test.name == selection.name : std::regex_search(test.name, name)))
            continue;
        if (selection.changed && history.passedWith(test.name) == test.print)
            continue;
        if (selection.failed && history.last(test.name) != "f")
            continue;
        chosen.push_back(test);
    }
    return chosen;
}

// Lists the labels and folders there are, for a person who mistyped one.
std::string known(const std::vector<Test>& all) {
    std::set<std::string> labels, places;
    for (const Test& test : all) {
        labels.insert(test.labels.begin(), test.labels.end());
        places.insert(test.place);
    }
    std::string text = "labels:";
    for (const std::string& label : labels)
        text += " " + label;
    text += "\nfolders:";
    for (const std::string& place : places)
        text += " " + place;
    return text;
}

std::string commitOf(const std::string& source) {
    Output out = run({"git", "-C", source, "describe", "--always", "--dirty", "--abbrev=10"});
    return out.status == 0 ? out.text.substr(0, out.text.find('\n')) : "unknown";
}

std::string subjectOf(const std::string& source) {
    Output out = run({"git", "-C", source, "log", "-1", "--format=%s"});
    return out.status == 0 ? out.text.substr(0, out.text.find('\n')) : "";
}

// Returns the first test of each group of failures, with its reason; of no more than five.
nlohmann::json reasonsOf(const std::vector<Failure>& failures) {
    std::set<std::string> buckets;
    nlohmann::json reasons = nlohmann::json::array();
    for (const Failure& failure : failures)
        if (buckets.size() < 5 && buckets.insert(failure.bucket).second)
            reasons.push_back(failure.result.name + ": " + failure.reason.substr(0, 120));
    return reasons;
}

void summary(const nlohmann::json& data, const std::vector<Failure>& failures,
             const std::string& out) {
    std::vector<std::vector<const Failure*>> groups; // in the order of their first failures
    for (const Failure& failure : failures) {
        auto group = std::find_if(groups.begin(), groups.end(), [&](const auto& members) {
            return members[0]->bucket == failure.bucket;
        });
        if (group == groups.end())
            group = groups.emplace(groups.end());
        group->push_back(&failure);
    }
    for (const auto& members : groups) {
        std::cout << fmt::format("\n{} x  {}\n", members.size(), members[0]->reason.substr(0, 200));
        for (const Failure* failure : members) {
            std::cout << "    " << failure->repeat << "\n        log " << failure->log << '\n';
            if (!failure->place.empty())
                std::cout << "        at " << failure->place << '\n';
            if (!failure->changed.empty() &&
                (failure == members[0] || failure->changed != members[0]->changed))
                std::cout << "        " << failure->changed << '\n';
            if (!failure->wave.empty())
                std::cout << "        gtkwave "
                          << (failure->save.empty() ? failure->wave : failure->save) << '\n';
        }
    }
    if (!data["flaky"].empty()) {
        std::cout << "\nFlaky:";
        for (auto& name : data["flaky"])
            std::cout << ' ' << name.get<std::string>();
        std::cout << '\n';
    }
    std::vector<std::pair<double, std::string>> longest;
    for (const auto& row : data["results"])
        longest.emplace_back(row.at(2).get<double>(), row.at(0).get<std::string>());
    std::sort(longest.rbegin(), longest.rend());
    longest.resize(std::min<size_t>(longest.size(), 3));
    std::cout << "\nThe longest:";
    for (const auto& [seconds, name] : longest)
        std::cout << fmt::format(" {} {:.1f} s", name, seconds);
    std::cout << '\n';
    if (!data["seeds"].empty())
        std::cout << fmt::format(
            "\n{} failing seeds are kept: make regress KEPT=1 runs them again\n",
            data["seeds"].size());
    std::cout << '\n' << lightsText(data["lights"]);
    std::cout << fmt::format("{} passed, {} failed, {} skipped in {:.0f} s; {}/report.html\n",
                             data["passed"].get<int>(), data["failed"].get<int>(),
                             data["skipped"].get<int>(), data["seconds"].get<double>(), out);
}

struct Round {
    std::string seed;
    std::vector<Test> tests;
};

// The chosen tests once for each seed; or each test that failed once, with the seeds that showed
// it.
std::vector<Round> roundsOf(const std::vector<Test>& chosen, const Options& options,
                            FailingSeeds& seeds) {
    std::vector<Round> rounds;
    if (!options.kept) {
        uint64_t seed =
            options.seed == "random" ? std::random_device{}() : std::stoull(options.seed);
        for (unsigned i = 0; i < options.repeat; ++i)
            rounds.push_back({std::to_string(seed + i), chosen});
        return rounds;
    }
    for (const auto& [seed, names] : seeds.bySeed()) {
        Round round{seed, {}};
        for (const Test& test : chosen)
            if (std::find(names.begin(), names.end(), test.name) != names.end())
                round.tests.push_back(test);
        if (!round.tests.empty())
            rounds.push_back(std::move(round));
    }
    return rounds;
}

// Builds what the chosen tests need, or lists it; their cases are known afterwards only.
void build(const Options& options, const History& history) {
    const auto all = listTests(options.build);
    const auto outputs = outputsOf(options.build);
    auto chosen = choose(all, options.selection, history);
    std::set<std::string> targets, fixtures;
    for (size_t i = 0; i < chosen.size(); ++i) { // it grows by what sets up others' fixtures
        for (const std::string& target : targetsOf(chosen[i], options.build, outputs))
            targets.insert(target);
        for (const std::string& need : std::vector<std::string>(chosen[i].needs))
            if (fixtures.insert(need).second)
                std::copy_if(all.begin(), all.end(), std::back_inserter(chosen),
                             [&](const Test& test) {
                                 return std::count(test.sets.begin(), test.sets.end(), need) > 0;
                             });
    }
    if (targets.count("all") || options.selection.changed)
        targets = {"all"};
    if (options.list || targets.empty()) {
        for (const std::string& target : targets)
            std::cout << target << '\n';
        return;
    }
    std::vector<std::string> command = {"flock", "-o", options.build, "ninja", "-C", options.build};
    command.insert(command.end(), targets.begin(), targets.end());
    std::cout << (targets.size() > 8 ? fmt::format("Building {} targets ...\n", targets.size())
                                     : fmt::format("Building {} ...\n", fmt::join(targets, " ")))
              << std::flush;
    Output out = run(command);
    if (out.status != 0)
        throw std::runtime_error("it does not build:\n" + out.text);
}

// Says why no test is chosen. Returns the exit status.
int nothingChosen(const Options& options, const std::vector<Test>& all) {
    if (options.selection.changed || options.selection.failed) {
        std::cout << "Nothing to run: no test " << (options.selection.failed ? "failed" : "changed")
                  << " since the last run.\n";
        return 0;
    }
    std::string given;
    for (const auto& [variable, value] :
         std::map<std::string, std::string>{{"BLOCK", options.selection.block},
                                            {"LABEL", options.selection.label},
                                            {"NAME", options.selection.name}})
        given += value.empty() ? "" : " " + variable + "='" + value + "'";
    std::cerr << "regress: no test is chosen by" << given << "; `ctest --test-dir " << options.build
              << " -N` lists their names.\n"
              << known(all) << '\n';
    return 2;
}

std::vector<Result> run(const std::vector<Round>& rounds, const Options& options,
                        History& history) {
    std::vector<Result> results;
    for (const Round& round : rounds) {
        Progress progress(round.tests, history, options.jobs);
        RunOptions how{options.build,
                       options.out,
                       round.seed,
                       options.jobs,
                       [&](const std::string& name) { progress.start(name); },
                       [&](const Result& result, unsigned done, unsigned total) {
                           progress.end(result, done, total);
                       }};
        std::cout << fmt::format("{} tests, SEED={}\n", round.tests.size(), round.seed)
                  << std::flush;
        auto part =
            options.launcher == "slurm" ? runSlurm(round.tests, how) : runHere(round.tests, how);
        progress.done();
        results.insert(results.end(), part.begin(), part.end());
    }
    return results;
}

Properties propertiesOf(const std::vector<Failure>& failures) {
    Properties properties;
    for (const Failure& failure : failures) {
        auto& of = properties[failure.result.name] = {
            {"reason", failure.reason}, {"repeat", failure.repeat}, {"log", failure.log}};
        if (!failure.wave.empty())
            of["wave"] = failure.wave;
        if (!failure.changed.empty())
            of["changed"] = failure.changed;
    }
    return properties;
}

int regress(const Options& options) {
    if (!options.tree.empty()) {
        std::cout << treeState(options.source, options.tree) << '\n';
        return 0;
    }
    if (options.plan) {
        const auto plan = readPlan(options.source + "/tests/plan.md");
        const auto wrong = unmatched(plan, listTests(options.build));
        for (const std::string& each : wrong)
            std::cout << each << '\n';
        std::cout << fmt::format("{} requirements\n", plan.size());
        return plan.empty() || !wrong.empty();
    }
    if (options.prepare) { // for CTest, which keeps no history
        build(options, History(options.out + "/history.jsonl"));
        const auto all = listTests(options.build);
        return choose(all, options.selection, History(options.out + "/history.jsonl")).empty()
                   ? nothingChosen(options, all)
                   : 0;
    }
    const FolderLock lock(options.out, "regress");
    History history(options.out + "/history.jsonl");
    if (history.damaged())
        std::cout << fmt::format("{} damaged lines of {}/history.jsonl are left out\n",
                                 history.damaged(), options.out);
    if (options.make)
        build(options, history);
    auto all = listTests(options.build);
    fingerprint(all, options.source, options.build);
    auto chosen = choose(all, options.selection, history);
    if (chosen.empty())
        return nothingChosen(options, all);
    if (options.budget > 0) {
        chosen = withinBudget(chosen, options.budget, options.jobs, options.build, history,
                              readPlan(options.source + "/tests/plan.md"));
        if (chosen.empty())
            throw std::runtime_error("no test is so short: give it a larger budget");
    }
    if (options.list) {
        for (const Test& test : chosen)
            std::cout << test.name << '\n';
        return 0;
    }
    FailingSeeds seeds(options.out + "/seeds.jsonl");
    for (const std::string& gone : seeds.forgetOthers(all))
        std::cout << gone << " is no test any more: its seeds are forgotten\n";
    auto rounds = roundsOf(chosen, options, seeds);
    if (rounds.empty()) {
        std::cout << "Nothing to run: no seed is kept that made one of these tests fail.\n";
        return 0;
    }
    Changes changes(options.source, options.build, options.out);
    auto start = std::chrono::steady_clock::now();
    adoptOrphans();
    auto results = run(rounds, options, history);
    for (const std::string& each : endOrphans())
        std::cout << "A test has left behind, and it was ended: " << each << '\n';
    for (const std::string& each : changes.meanwhile())
        std::cout << "Changed while the tests ran, by one of them or by you: " << each << '\n';
    double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    auto failures = examine(results, all, options.out);
    for (Failure& failure : failures)
        for (const Test& test : all)
            if (test.name == failure.result.name)
                failure.changed =
                    changes.since(history.lastPass(test.name), test, failure.result.seed);
    const std::string commit = commitOf(options.source);
    auto made = History::makeRun(chosen, results, commit, seconds);
    made["subject"] = subjectOf(options.source);
    made["tree"] = changes.tree();
    made["reasons"] = reasonsOf(failures);
    history.add(made);
    seeds.update(results, commit);
    addWaves(failures, all, options.source, options.build, options.launcher, options.jobs,
             options.waves);
    auto data = gather(history, all, results, failures, options.source);
    data["seeds"] = seeds.list();
    summary(data, failures, options.out);
    writeJUnit(options.out + "/junit.xml", results, propertiesOf(failures));
    writeReports(data, options.out);
    return failures.empty() ? 0 : 1;
}

} // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app("Runs the regression: chosen tests, in parallel, with history, waveforms of "
                 "failures and a page.\n"
                 "Exit status 0: all passed; 1: some failed; 2: it could not run.");
    app.add_option("--source", options.source, "root of the tree")->capture_default_str();
    app.add_option("--build", options.build, "build folder with the tests")->capture_default_str();
    app.add_option("--out", options.out, "where reports go")->capture_default_str();
    app.add_option("--name", options.selection.name, "regular expression on test names");
    app.add_option("--block", options.selection.block, "one block: modem, link, bus, ...");
    app.add_option("--label", options.selection.label,
                   "one label: rtl, formal, lint, firmware, ...");
    app.add_flag("--changed", options.selection.changed,
                 "only tests whose program or sources changed since they passed");
    app.add_flag("--rerun-failed", options.selection.failed,
                 "only tests that failed in their last run");
    app.add_flag("--kept", options.kept,
                 "only tests that failed with some seed and have not passed with it since, with "
                 "these seeds")
        ->excludes("--rerun-failed")
        ->excludes("--changed");
    app.add_option("--seed", options.seed, "seed of the random tests, or `random`")
        ->capture_default_str()
        ->check([](const std::string& seed) {
            const bool number = !seed.empty() && seed.size() < 20 &&
                                seed.find_first_not_of("0123456789") == std::string::npos;
            return number || seed == "random" ? ""
                                              : "'" + seed + "' is neither a number nor `random`";
        });
    app.add_option("--budget", options.budget,
                   "only the tests that are worth most in so much time: 60s, 5m")
        ->transform(CLI::AsNumberWithUnit(std::map<std::string, double>{{"s", 1}, {"m", 60}}))
        ->check(CLI::PositiveNumber);
    app.add_option("--repeat", options.repeat, "so many runs, each with the next seed")
        ->check(CLI::Range(1, 1000));
    app.add_option("--jobs", options.jobs, "tests at once")->check(CLI::Range(1, 256));
    app.add_option("--waves", options.waves, "waveforms of at most so many failures")
        ->capture_default_str();
    app.add_option("--launcher", options.launcher, "local or slurm")
        ->check(CLI::IsMember({"local", "slurm"}));
    app.add_flag("--make", options.make, "build what the chosen tests need first");
    app.add_flag("--prepare", options.prepare,
                 "only build what the chosen tests need; with --list, only say what that is");
    app.add_option("--tree", options.tree, "only print the state of these folders");
    app.add_flag("--plan", options.plan,
                 "only look whether each pattern of tests/plan.md matches a test");
    app.add_flag("--list", options.list, "only say which tests are chosen");
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& help) {
        return app.exit(help);
    } catch (const CLI::ParseError& error) {
        std::cerr << "regress: " << error.what() << "; see --help\n";
        return 2;
    }
    try {
        return regress(options);
    } catch (const std::exception& error) {
        std::cerr << "regress: " << error.what() << '\n';
        return 2;
    }
}
