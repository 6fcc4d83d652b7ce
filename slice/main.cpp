// SPDX-License-Identifier: MIT
//
// slice2c: Slice files into C90 stubs and skeletons for IceC.

#include "c_generator.h"
#include "lexer.h"
#include "parser.h"
#include "preprocessor.h"
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>

namespace fs = std::filesystem;

namespace {

struct Options {
    std::vector<std::string> files, includes, defines, undefines;
    std::string outputDir = ".", headerExtension = "h";
    bool depend = false;
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

// All files or none: each is written beside its place and then moved there.
bool save(const std::vector<GeneratedFile>& files, const std::string& directory) {
    std::error_code error;
    fs::create_directories(directory, error);
    for (const GeneratedFile& f : files) {
        fs::path path = fs::path(directory) / (f.name + ".tmp");
        std::ofstream out(path, std::ios::binary);
        out << f.text;
        out.close();
        if (!out) {
            std::cerr << "slice2c: error: cannot write '" << path.string() << "'\n";
            for (const GeneratedFile& g : files)
                fs::remove(fs::path(directory) / (g.name + ".tmp"), error);
            return false;
        }
    }
    for (const GeneratedFile& f : files)
        fs::rename(fs::path(directory) / (f.name + ".tmp"), fs::path(directory) / f.name, error);
    return !error;
}

bool compile(const std::string& file, const Options& o) {
    if (!std::ifstream(file)) {
        std::cerr << "slice2c: error: cannot read '" << file << "'\n";
        return false;
    }
    Preprocessed p = preprocess(file, preprocessorOptions(o));
    if (!p.messages.empty())
        std::cerr << p.messages;
    if (!p.ok)
        return false;
    if (o.depend) {
        std::cout << fs::path(file).stem().string() << "." << o.headerExtension << ":";
        for (const std::string& d : p.dependencies)
            std::cout << " \\\n " << d;
        std::cout << "\n";
        return true;
    }
    Diagnostics diagnostics(std::cerr);
    Unit unit = parse(tokenize(p.text, file, diagnostics), file, diagnostics);
    if (diagnostics.errors() == 0)
        checkC(unit, diagnostics);
    if (diagnostics.errors()) {
        std::cerr << diagnostics.errors() << (diagnostics.errors() == 1 ? " error\n" : " errors\n");
        return false;
    }
    return save(generateC(unit, fs::path(file).stem().string(), o.headerExtension), o.outputDir);
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app{"Generates C90 stubs and skeletons for IceC from Slice files."};
    Options o;
    app.add_option("files", o.files, "Slice files")->required();
    app.add_option("-I", o.includes, "folder to look for #include files")->allow_extra_args(false);
    app.add_option("-D", o.defines, "define a preprocessor symbol: NAME or NAME=VALUE")->allow_extra_args(false);
    app.add_option("-U", o.undefines, "forget a preprocessor symbol")->allow_extra_args(false);
    app.add_option("--output-dir", o.outputDir, "where the generated files go");
    app.add_option("--header-ext", o.headerExtension, "extension of headers");
    app.add_flag("--depend", o.depend, "print make dependencies, generate nothing");
    app.set_version_flag("--version", "0.1");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) ? 1 : 0;
    }
    int failures = 0;
    for (const std::string& file : o.files)
        failures += !compile(file, o);
    return failures ? 1 : 0;
}
