// SPDX-License-Identifier: MIT
//
// options: reads slice2c's command line with getopt_long. The C++ library that was used before
// needed a sixth of slice2c's compile time, and every new clone waits for slice2c.

#include "options.h"
#include <getopt.h>
#include <iostream>

namespace {

// The variable that an option sets: a flag, a text, or a list of texts. An option without a
// variable prints a text and ends slice2c.
struct Target {
    Target() = default;
    Target(bool& flagged) : flag(&flagged) {}
    Target(std::string& text) : value(&text) {}
    Target(std::vector<std::string>& texts) : list(&texts) {}

    bool* flag = nullptr;
    std::string* value = nullptr;
    std::vector<std::string>* list = nullptr;
};

// An option with a letter (-I), a name (--output-dir) or both.
struct Described {
    char letter;
    const char* name;
    Target target;
    const char* help;

    bool hasArgument() const { return target.value || target.list; }
    std::string shown() const {
        std::string text = letter ? std::string("-") + letter : "";
        text += std::string(letter && *name ? "," : "") + (*name ? "--" : "") + name;
        return "  " + text + (target.value ? " TEXT" : target.list ? " TEXT ..." : "");
    }
};

std::vector<Described> describedOptions(Options& o) {
    std::vector<Described> all = {
        {'h', "help", {}, "print this help and exit"},
        {'v', "version", {}, "print the version and exit"},
        {'I', "", o.includes, "folder to search for included files; can be repeated"},
        {'D', "", o.defines, "define a preprocessor symbol: NAME or NAME=VALUE"},
        {'U', "", o.undefines, "undefine a preprocessor symbol"},
        {'E', "", o.preprocessOnly, "print the preprocessor's output, generate nothing"},
        {0, "output-dir", o.outputDir, "folder for generated files (default: current folder)"},
        {0, "header-ext", o.headerExtension, "extension of headers, without the dot (default: h)"},
        {0, "source-ext", o.sourceExtension, "extension of sources, without the dot (default: c)"},
        {0, "include-dir", o.includeDir,
         "folder in front of the header's name in the sources' #include"}};
    for (size_t i = 0; i < std::size(hardwareOutputs); ++i)
        all.push_back({0, hardwareOutputs[i].option, o.hardware[i], hardwareOutputs[i].help});
    for (const Described& option : std::vector<Described>{
             {0, "hw-own-clock", o.hwOwnClock,
              "make servants check that the core has answered, because its clock may stop"},
             {0, "describe", o.describe,
              "print the declarations as JSON, generate nothing (docs/call.md)"},
             {0, "depend", o.depend, "print make dependencies, generate nothing"},
             {0, "depend-file", o.dependFile, "write dependencies to this file"},
             {0, "one-program", o.oneProgram,
              "generate nothing; report C names that two of the files define"},
             {0, "validate", o.validate, "check the command line only"},
             {0, "underscore", o.rules.underscore, "allow underscores in names"},
             {0, "ice", o.rules.icePrefix, "allow names that start with 'ice'"}})
        all.push_back(option);
    return all;
}

void printHelp(const std::vector<Described>& all) {
    std::cout << "Generates C90 proxies and servants for IceC from Slice files, and hardware "
                 "wrappers for interfaces\n"
                 "with metadata [\":hw\"].\n"
                 "Usage: slice2c [OPTIONS] FILE...\n\n"
                 "Options:\n";
    for (const Described& option : all) {
        std::string shown = option.shown();
        shown.resize(30, ' ');
        std::cout << shown << option.help << "\n";
    }
    std::cout << "\nThe exit status is 1 if a file has errors or the command line is wrong.\n"
                 "\n"
                 "examples:\n"
                 "  slice2c --output-dir gen Mesh.ice\n"
                 "  slice2c -I slice -I /usr/share/ice/slice --output-dir gen slice/Mesh.ice\n"
                 "  slice2c --hw-verilog gen --hw-regs gen --hw-c gen Filter.ice\n";
}

int refuse(const std::string& reason) {
    if (!reason.empty())
        std::cerr << "slice2c: error: " << reason << "\n";
    std::cerr << "Run with --help for more information.\n";
    return 1;
}

} // namespace

std::optional<int> readOptions(int argc, char** argv, Options& o) {
    // getopt_long returns the letter of an option, or firstName and up for an option without letter
    constexpr int firstName = 256;
    std::vector<Described> all = describedOptions(o);
    std::vector<option> names;
    std::string letters;
    for (size_t i = 0; i < all.size(); ++i) {
        const Described& d = all[i];
        if (d.letter)
            letters += std::string(1, d.letter) + (d.hasArgument() ? ":" : "");
        if (*d.name)
            names.push_back({d.name, d.hasArgument() ? required_argument : no_argument, nullptr,
                             firstName + static_cast<int>(i)});
    }
    names.push_back({});
    for (int code; (code = getopt_long(argc, argv, letters.c_str(), names.data(), nullptr)) >= 0;) {
        const Described* found = code < firstName ? nullptr : &all[code - firstName];
        for (const Described& d : all)
            if (d.letter && d.letter == code)
                found = &d;
        if (!found)
            return refuse(""); // getopt_long has printed the reason
        if (found->target.flag)
            *found->target.flag = true;
        else if (found->target.value)
            *found->target.value = optarg;
        else if (found->target.list)
            found->target.list->push_back(optarg);
        else if (found->letter == 'h')
            return printHelp(all), 0;
        else
            return std::cout << "slice2c 1.0, Slice of Ice 3.7\n", 0;
    }
    o.files.assign(argv + optind, argv + argc);
    if (o.files.empty() && !o.validate)
        return refuse("expected a Slice file, got none");
    return o.validate ? std::optional<int>(0) : std::nullopt;
}
