// SPDX-License-Identifier: MIT
//
// slice2c: Slice files into C90 stubs and skeletons for IceC.

#include "c/dependencies.h"
#include "c/names.h"
#include "front/front.h"
#include "front/preprocessor.h"
#include "hw/generator.h"
#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>

namespace fs = std::filesystem;

namespace {

struct Options {
    std::vector<std::string> files, includes, defines, undefines;
    std::string outputDir = ".", includeDir, headerExtension = "h", sourceExtension = "c",
                dependFile, hwVerilog, hwVhdl, hwRegisters, hwC, hwCpp, hwNewVerilog, hwNewVhdl;
    bool oneProgram = false, preprocessOnly = false, depend = false, validate = false,
         hwOwnClock = false;
    NameRules rules;
};

std::vector<std::string> preprocessorOptions(const Options& o) {
    std::vector<std::string> list;
    for (const std::string& i : o.includes)
        list.push_back("-I" + i);
    for (const std::string& d : o.defines)
        list.push_back("-D" + d);
    for (const std::string& u : o.undefines)
        list.push_back("-U" + u);
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

// Saves all files or none: each is written beside its place and then moved there.
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

CFileNames namesFor(const std::string& file, const Options& o, const Preprocessed& p) {
    CFileNames names;
    names.base = fs::path(file).stem().string();
    names.path = headerOf(file, file, o.includes, o.headerExtension);
    names.headerExtension = o.headerExtension;
    names.sourceExtension = o.sourceExtension;
    names.includeDir = o.includeDir;
    for (const std::string& included : p.includes)
        names.includes.push_back(headerOf(included, file, o.includes, o.headerExtension));
    return names;
}

bool wantsHardware(const Options& o) {
    return !(o.hwVerilog + o.hwVhdl + o.hwRegisters + o.hwC + o.hwCpp + o.hwNewVerilog +
             o.hwNewVhdl)
                .empty();
}

bool saveHardware(const std::vector<hw::Block>& blocks, const Options& o, const CFileNames& names) {
    using Make = std::function<GeneratedFile(const hw::Block&)>;
    auto inC = [&](auto make) {
        return [&names, make](const hw::Block& b) { return make(b, names); };
    };
    for (auto [directory, makes] :
         {std::pair{&o.hwVerilog, std::vector<Make>{hw::verilogFile}},
          std::pair{&o.hwVhdl, std::vector<Make>{hw::vhdlFile}},
          std::pair{&o.hwRegisters, std::vector<Make>{hw::registersFile}},
          std::pair{&o.hwC, std::vector<Make>{inC(hw::servantHeader), inC(hw::servantSource)}},
          std::pair{&o.hwCpp, std::vector<Make>{inC(hw::proxyFile)}},
          std::pair{&o.hwNewVerilog, std::vector<Make>{hw::verilogSkeleton, hw::testSkeleton}},
          std::pair{&o.hwNewVhdl, std::vector<Make>{hw::vhdlSkeleton, hw::testSkeleton}}}) {
        std::vector<GeneratedFile> files;
        if (directory->empty())
            continue;
        for (const hw::Block& b : blocks)
            for (Make make : makes)
                files.push_back(make(b));
        if (!save(files, *directory))
            return false;
    }
    return true;
}

// The definitions of one program's files, each with its place. In all of them C has one name for a
// definition of a kind, and one header for files of one name.
class Program {
public:
    void add(const Unit& unit, Diagnostics& diagnostics) {
        std::string name = fs::path(unit.file).filename().string();
        auto [header, isNew] = headers_.emplace(name, unit.file);
        if (!isNew)
            diagnostics.error({diagnostics.intern(unit.file), 1, 1},
                              "'" + name + "' is the name of " + header->second +
                                  " too; both go into one program: give one file another name");
        for (const auto& d : unit.declarations) {
            if (d->isForward || d->fromInclude)
                continue;
            std::string at = unit.file + ":" + std::to_string(d->at.line);
            auto [other, isFirst] = definitions_.emplace(cName(*d), at);
            if (!isFirst && other->second != at)
                diagnostics.error(d->at, "'" + d->id() + "' is '" + other->first + "' in C, as " +
                                             other->second +
                                             " is; both go into one program: give a module or "
                                             "a name another one");
        }
    }

private:
    std::map<std::string, std::string> headers_, definitions_;
};

bool compile(const std::string& file, const Options& o, Dependencies& dependencies,
             Program& program) {
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
        dependencies.add(file, names, p.files);
        return true;
    }
    Diagnostics diagnostics(std::cerr);
    Unit unit = compileUnit(p.text, file, o.rules, diagnostics);
    if (diagnostics.errors() == 0)
        addLimits(unit, limits, diagnostics);
    scopeEnumerators(unit);
    if (diagnostics.errors() == 0)
        checkC(unit, names, diagnostics);
    std::vector<hw::Block> blocks;
    if (diagnostics.errors() == 0 && wantsHardware(o))
        blocks = hw::mapHardware(unit, diagnostics);
    for (hw::Block& b : blocks)
        b.hasOwnClock = o.hwOwnClock;
    if (diagnostics.errors() == 0 && o.oneProgram)
        program.add(unit, diagnostics);
    if (diagnostics.errors()) {
        std::cerr << diagnostics.errors() << (diagnostics.errors() == 1 ? " error\n" : " errors\n");
        return false;
    }
    return o.oneProgram ||
           (save(generateC(unit, names), o.outputDir) && saveHardware(blocks, o, names));
}

void describe(CLI::App& app, Options& o) {
    app.add_option("files", o.files, "Slice files");
    app.add_option("-I", o.includes, "folder to look for #include files")->allow_extra_args(false);
    app.add_option("-D", o.defines, "define a preprocessor symbol: NAME or NAME=VALUE")
        ->allow_extra_args(false);
    app.add_option("-U", o.undefines, "forget a preprocessor symbol")->allow_extra_args(false);
    app.add_flag("-E", o.preprocessOnly, "print what the preprocessor makes, generate nothing");
    app.add_option("--output-dir", o.outputDir, "where the generated files go");
    app.add_option("--header-ext", o.headerExtension, "extension of headers, without the dot (h)");
    app.add_option("--source-ext", o.sourceExtension, "extension of sources, without the dot (c)");
    app.add_option("--include-dir", o.includeDir, "folder of the header in the sources' #include");
    app.add_option("--hw-verilog", o.hwVerilog,
                   "folder for the wrappers of [\":hw\"] interfaces (docs/hw-mapping.md)");
    app.add_option("--hw-vhdl", o.hwVhdl, "folder for the same wrappers in VHDL");
    app.add_option("--hw-regs", o.hwRegisters, "folder for their registers, *.regs.json");
    app.add_option("--hw-c", o.hwC, "folder for their servants in C90");
    app.add_option("--hw-cpp", o.hwCpp, "folder for their proxies in C++, for test benches");
    app.add_flag("--hw-own-clock", o.hwOwnClock,
                 "the cores have a clock of their own: servants ask whether they answered");
    app.add_option("--hw-new-verilog", o.hwNewVerilog,
                   "folder for a core to begin with, in Verilog, and its test");
    app.add_option("--hw-new-vhdl", o.hwNewVhdl, "the same in VHDL");
    app.add_flag("--depend", o.depend, "print make dependencies, generate nothing");
    app.add_option("--depend-file", o.dependFile, "write dependencies to this file");
    app.add_flag("--one-program", o.oneProgram,
                 "generate nothing; say where two of the files define one name of C");
    app.add_flag("--validate", o.validate, "check the command line only");
    app.add_flag("--underscore", o.rules.underscore, "allow underscores in names");
    app.add_flag("--ice", o.rules.icePrefix, "allow names that begin with 'ice'");
    app.set_version_flag("-v,--version", "slice2c 1.0, Slice of Ice 3.7");
    app.footer("Exit status: 0, or 1 where a file has errors or the command line is wrong.");
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app{"Generates C90 stubs and skeletons for IceC from Slice files."};
    Options o;
    describe(app, o);
    try {
        app.parse(argc, argv);
        if (o.files.empty() && !o.validate)
            throw CLI::RequiredError("a Slice file");
    } catch (const CLI::ParseError& e) {
        return app.exit(e) ? 1 : 0;
    }
    if (o.validate)
        return 0;
    o.depend = o.depend || !o.dependFile.empty();
    Dependencies dependencies;
    Program program;
    int failures = 0;
    for (const std::string& file : o.files)
        failures += !compile(file, o, dependencies, program);
    if (o.depend && failures == 0) {
        std::string text = dependencies.text();
        failures += !(o.dependFile.empty() ? print(text) : write(o.dependFile, text));
    }
    return failures ? 1 : 0;
}
