// SPDX-License-Identifier: MIT
//
// slice2c: compiles Slice files into C90 stubs and skeletons for IceC.

#include "c/context.h"
#include "options.h"
#include "text/description.h"
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>

namespace fs = std::filesystem;

namespace {

std::vector<std::string> preprocessorOptions(const Options& o) {
    std::vector<std::string> list;
    for (const auto& [flag, values] :
         {std::pair{"-I", &o.includes}, std::pair{"-D", &o.defines}, std::pair{"-U", &o.undefines}})
        for (const std::string& value : *values)
            list.push_back(flag + value);
    return list;
}

bool write(const fs::path& path, const std::string& text) {
    std::ofstream out(path, std::ios::binary);
    out << text;
    out.close();
    if (!out)
        std::cerr << "slice2c: error: cannot write '" << path.string() << "'\n";
    return !out.fail();
}

bool print(const std::string& text) {
    std::cout << text << std::flush;
    if (!std::cout)
        std::cerr << "slice2c: error: cannot write to standard output\n";
    return !std::cout.fail();
}

// Saves all files or none: writes each file under a temporary name, and then renames all of them.
bool save(const std::vector<GeneratedFile>& files, const std::string& directory) {
    std::error_code error;
    fs::create_directories(directory, error);
    for (const GeneratedFile& f : files) {
        fs::path path = fs::path(directory) / (f.name + ".tmp");
        if (!write(path, f.text)) {
            for (const GeneratedFile& g : files)
                fs::remove(fs::path(directory) / (g.name + ".tmp"), error);
            return false;
        }
    }
    for (const GeneratedFile& f : files)
        fs::rename(fs::path(directory) / (f.name + ".tmp"), fs::path(directory) / f.name, error);
    if (error)
        std::cerr << "slice2c: error: cannot write into '" << directory << "': " << error.message()
                  << "\n";
    return !error;
}

// Returns the path that an #include uses for the header of `included`: the shortest path
// relative to one of the -I folders; if the header is in none of these folders, the path
// relative to the folder of `file`.
std::string headerOf(const std::string& included, const std::string& file, const Options& o) {
    fs::path path = fs::weakly_canonical(included), best;
    for (const std::string& dir : o.includes) {
        fs::path relative = path.lexically_relative(fs::weakly_canonical(dir));
        bool isUnder = !relative.empty() && *relative.begin() != "..";
        if (isUnder && (best.empty() || relative.string().size() < best.string().size()))
            best = relative;
    }
    if (best.empty())
        best = path.lexically_relative(fs::weakly_canonical(fs::absolute(file).parent_path()));
    return best.replace_extension(o.headerExtension).generic_string();
}

// The preprocessor makes paths absolute; paths below the current folder are written relative to it.
std::string shown(const std::string& file) {
    fs::path path = fs::weakly_canonical(file),
             relative = path.lexically_relative(fs::current_path());
    return relative.empty() || *relative.begin() == ".." ? path.string() : relative.string();
}

// Returns a rule for make. `files` are the Slice file and all files that it includes.
std::string dependencyRule(const std::string& file, const CFileNames& names,
                           const std::vector<std::string>& files) {
    std::string rule = names.base + "." + names.headerExtension;
    for (const char* part : {"_types", "_client", "_async", "_server"})
        rule += " " + names.base + part + "." + names.sourceExtension;
    rule += ": \\\n " + file;
    for (const std::string& f : files)
        if (shown(f) != shown(file))
            rule += " \\\n " + shown(f);
    return rule + "\n";
}

CFileNames namesFor(const std::string& file, const Options& o, const Preprocessed& p) {
    CFileNames names;
    names.base = fs::path(file).stem().string();
    names.path = headerOf(file, file, o);
    names.headerExtension = o.headerExtension;
    names.sourceExtension = o.sourceExtension;
    names.includeDir = o.includeDir;
    for (const std::string& included : p.includes)
        names.includes.push_back(headerOf(included, file, o));
    return names;
}

bool wantsHardware(const Options& o) {
    return std::any_of(std::begin(o.hardware), std::end(o.hardware),
                       [](const std::string& folder) { return !folder.empty(); });
}

bool saveHardware(const std::vector<hw::Block>& blocks, const Options& o) {
    for (size_t i = 0; i < std::size(hardwareOutputs); ++i) {
        std::vector<GeneratedFile> files;
        if (o.hardware[i].empty())
            continue;
        for (const hw::Block& b : blocks)
            for (auto make : hardwareOutputs[i].makes)
                if (make)
                    files.push_back(make(b));
        if (!save(files, o.hardware[i]))
            return false;
    }
    return true;
}

// The definitions of all files of one program, with their positions. The C names of the definitions
// must be unique in the program. File names must also be unique, because headers are named after
// them.
class Program {
public:
    void add(const Unit& unit, Diagnostics& diagnostics) {
        std::string name = fs::path(unit.file).filename().string();
        auto [header, isNew] = headers_.emplace(name, unit.file);
        if (!isNew)
            diagnostics.error({diagnostics.intern(unit.file), 1, 1},
                              "file '" + name + "' has the same name as " + header->second +
                                  "; both go into one program: rename one of them");
        for (const auto& d : unit.declarations) {
            if (d->isForward || d->fromInclude)
                continue;
            std::string at = unit.file + ":" + std::to_string(d->at.line);
            auto [other, isFirst] = definitions_.emplace(cName(*d), at);
            if (!isFirst && other->second != at)
                diagnostics.error(d->at, "'" + d->id() + "' and the declaration at " +
                                             other->second + " would both be named '" +
                                             other->first +
                                             "' in C; both go into one program: "
                                             "rename one of them");
        }
    }

private:
    std::map<std::string, std::string> headers_, definitions_;
};

// Data that all files of a command line share.
struct Collected {
    std::string rules;               // --depend
    Program program;                 // definitions for the option --one-program
    Json described = Json::object(); // --describe
};

// Compiles a file. With --depend or --describe, only adds the file's dependencies or its
// description to `all`.
bool compile(const std::string& file, const Options& o, Collected& all) {
    if (fs::is_directory(file) || !std::ifstream(file)) {
        std::cerr << "slice2c: error: cannot read '" << file << "'\n";
        return false;
    }
    Preprocessed p = preprocess(file, preprocessorOptions(o));
    if (!p.messages.empty())
        std::cerr << p.messages;
    if (!p.ok)
        return false;
    if (o.preprocessOnly)
        return print(p.text);
    CFileNames names = namesFor(file, o, p);
    std::vector<std::string> limits = limitFiles(p.files);
    if (o.depend) {
        p.files.insert(p.files.end(), limits.begin(), limits.end());
        all.rules += dependencyRule(file, names, p.files);
        return true;
    }
    Diagnostics diagnostics(std::cerr);
    Unit unit = compileUnit(p.text, file, o.rules, diagnostics);
    if (o.describe) { // the limits of the C mapping do not apply to a description
        if (diagnostics.errors() == 0)
            describeUnit(unit, all.described);
        return diagnostics.errors() == 0;
    }
    if (diagnostics.errors() == 0)
        addLimits(unit, limits, diagnostics);
    scopeEnumerators(unit);
    if (diagnostics.errors() == 0)
        checkC(unit, names, diagnostics);
    std::vector<hw::Block> blocks;
    if (diagnostics.errors() == 0 && wantsHardware(o))
        blocks = hw::mapHardware(unit, diagnostics);
    for (hw::Block& b : blocks) {
        b.hasOwnClock = o.hwOwnClock;
        b.header = names.base + "." + names.headerExtension;
    }
    if (diagnostics.errors() == 0 && o.oneProgram)
        all.program.add(unit, diagnostics);
    if (diagnostics.errors()) {
        std::cerr << diagnostics.errors() << (diagnostics.errors() == 1 ? " error\n" : " errors\n");
        return false;
    }
    return o.oneProgram || (save(generateC(unit, names), o.outputDir) && saveHardware(blocks, o));
}

} // namespace

int main(int argc, char** argv) {
    Options o;
    if (std::optional<int> status = readOptions(argc, argv, o))
        return *status;
    o.depend = o.depend || !o.dependFile.empty();
    Collected all;
    int failures = 0;
    for (const std::string& file : o.files)
        failures += !compile(file, o, all);
    if (o.depend && failures == 0)
        failures += !(o.dependFile.empty() ? print(all.rules) : write(o.dependFile, all.rules));
    if (o.describe && failures == 0)
        failures += !print(all.described.print() + "\n");
    return failures ? 1 : 0;
}
