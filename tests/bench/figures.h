// SPDX-License-Identifier: MIT
//
// figures: collects the figures of a bench, and writes them to the JSON file of `./icesoc bench`.
//
//   int main(int argc, char** argv) {
//       Figures figures("Speed of the FSMC bridge.");
//       return figures.run(argc, argv, [&] {
//           figures.add("read", 12.5, "clocks", 10); // 10 is the limit of the pins
//       });
//   }
//
// Usage of every bench: PROGRAM OUTPUT.json [--brief]

#pragma once

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

class Figures {
public:
    explicit Figures(const std::string& what) : app{what} {
        app.add_option("output", output_, "JSON file for the figures")->required();
        app.add_flag("--brief", brief, "measures just enough to show that the bench works");
    }
    CLI::App app; // command line; a bench can add its own options
    // true: the measurement is short, and its figures are not judged, except exact ones
    bool brief = false;

    // Adds a figure and prints it. `limit` is a physical limit or a budget with which the figure is
    // compared.
    nlohmann::json& add(const std::string& name, double value, const std::string& unit,
                        double limit = 0) {
        nlohmann::json entry = {
            {"name", name}, {"value", value}, {"unit", unit}, {"command", "./icesoc bench"}};
        std::printf("%-80s %10.4g %s", name.c_str(), value, unit.c_str());
        if (limit > 0) {
            entry["limit"] = limit;
            entry["share"] = value / limit;
            std::printf(", %.1f %% of %.6g", 100 * value / limit, limit);
        }
        std::puts("");
        return entries_.emplace_back(std::move(entry));
    }
    // Reports a figure that is too bad; the exit status of the bench is then 1. `isExact`: the
    // figure is the same in each run and with --brief, so it is also judged with --brief.
    void miss(const std::string& what, bool isExact = false) {
        if (!brief || isExact)
            missed_ += app.get_name() + ": " + what + "\n";
    }
    // Reads the command line, measures, and writes the file. Returns the exit status.
    template <class Measure> int run(int argc, char** argv, const Measure& measure) {
        namespace fs = std::filesystem;
        app.name(fs::path(argv[0]).filename().string());
        CLI11_PARSE(app, argc, argv);
        try {
            measure();
            fs::create_directories(fs::absolute(output_).parent_path());
            std::ofstream file(output_);
            file << entries_.dump(1) << '\n';
            if (!file.flush())
                throw std::runtime_error("cannot write " + output_);
            std::printf("Written: %s\n", output_.c_str());
        } catch (const std::exception& error) {
            std::cerr << app.get_name() << ": error: " << error.what() << '\n';
            return 1;
        }
        std::cerr << missed_;
        return missed_.empty() ? 0 : 1;
    }

private:
    std::string output_, missed_;
    nlohmann::json entries_ = nlohmann::json::array();
};
