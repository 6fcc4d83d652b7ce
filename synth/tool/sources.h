// SPDX-License-Identifier: MIT
//
// sources: finds the Verilog files of a module, by reading their instances.

#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

struct VerilogModule {
    std::filesystem::path file;
    // Instance name -> module name; a name may have several, in branches of `ifdef or generate.
    std::multimap<std::string, std::string> instances;
    std::set<std::string> includes; // "`include" file names
};

class Library {
public:
    // Finds all *.v of these folders, then these files; the first of two modules with one name
    // counts.
    explicit Library(const std::vector<std::filesystem::path>& folders,
                     const std::vector<std::filesystem::path>& includeFolders,
                     const std::vector<std::filesystem::path>& files = {});

    const std::map<std::string, VerilogModule>& modules() const { return modules_; }
    bool has(const std::string& module) const { return modules_.count(module) != 0; }

    // Files of a module and of all that it instantiates, sorted; throws if `top` is not there.
    std::vector<std::filesystem::path> filesOf(const std::string& top) const;
    // Folders to search for include files.
    const std::vector<std::filesystem::path>& includeFolders() const { return includeFolders_; }
    // Changes whenever a file of the module changes, include files too.
    std::string hashOf(const std::string& top) const;
    // Module of the instance at the end of a path of instance names, "" if unknown.
    std::string moduleAt(const std::string& top, const std::string& path) const;
    // File names of the modules along such a path, the top's included.
    std::set<std::string> filesAlong(const std::string& top, const std::string& path) const;

private:
    std::set<std::string> reach(const std::string& top) const;

    std::map<std::string, VerilogModule> modules_;
    std::vector<std::filesystem::path> includeFolders_;
};
