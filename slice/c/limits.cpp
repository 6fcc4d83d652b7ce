// SPDX-License-Identifier: MIT
//
// limits: reads C metadata from Name.limits next to Name.ice, so that third-party Slice files need
// no change.

#include "c/generator.h"
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

std::vector<std::string> limitFiles(const std::vector<std::string>& files) {
    std::vector<std::string> found;
    for (const std::string& file : files) {
        std::string limits = std::filesystem::path(file).replace_extension("limits").string();
        if (std::filesystem::exists(limits))
            found.push_back(limits);
    }
    return found;
}

void addLimits(Unit& unit, const std::vector<std::string>& files, Diagnostics& diagnostics) {
    for (const std::string& file : files) {
        std::ifstream in(file);
        int number = 0;
        for (std::string line; std::getline(in, line);) {
            Location at{diagnostics.intern(file), ++number, 1};
            std::istringstream words(line.substr(0, line.find('#')));
            std::string name, metadata;
            if (!(words >> name))
                continue;
            auto& all = unit.declarations;
            auto found = std::find_if(all.begin(), all.end(), [&](const auto& d) {
                return !d->isForward && (d->id() == name || d->id() == "::" + name);
            });
            if (found == all.end())
                diagnostics.error(at, "'" + name +
                                          "' is not defined: expected a name with its modules, "
                                          "then metadata, such as M::Names c:max:20");
            else if (!(words >> metadata))
                diagnostics.error(at, "'" + name +
                                          "': expected metadata after the name, such as c:max:20");
            else
                do
                    (*found)->metadata.insert((*found)->metadata.begin(), metadata);
                while (words >> metadata);
        }
        if (in.bad() || !in.eof())
            diagnostics.error({diagnostics.intern(file), 1, 1}, "cannot be read");
    }
}
