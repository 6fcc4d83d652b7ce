// SPDX-License-Identifier: MIT
//
// preprocessor: one run of libmcpp over a file, output in memory.

#include "preprocessor.h"
extern "C" {
#include <mcpp_lib.h>
}
#include <algorithm>
#include <cstdlib>

namespace {

void addOnce(std::vector<std::string>& list, const std::string& name) {
    if (std::find(list.begin(), list.end(), name) == list.end())
        list.push_back(name);
}

// Follows the markers: #line 1 "file" enters a file, any other name returns to one around it.
void findFiles(Preprocessed& p) {
    std::vector<std::string> open;
    for (size_t at = 0; (at = p.text.find("#line ", at)) != std::string::npos;) {
        size_t begin = at, end = std::min(p.text.find('\n', at), p.text.size());
        at = end;
        if (begin > 0 && p.text[begin - 1] != '\n')
            continue;
        size_t quote = p.text.find('"', begin), close = p.text.rfind('"', end);
        if (quote >= end || close <= quote)
            continue;
        std::string name = p.text.substr(quote + 1, close - quote - 1);
        auto around = std::find(open.begin(), open.end(), name);
        if (around != open.end()) {
            open.erase(around + 1, open.end());
            continue;
        }
        if (open.size() == 1)
            addOnce(p.includes, name);
        open.push_back(name);
        addOnce(p.files, name);
    }
}

} // namespace

Preprocessed preprocess(const std::string& file, const std::vector<std::string>& options) {
    // -C: comments stay, for doc comments; -k: columns stay, for messages. The version macros are
    // those that Ice's own compilers of 3.7 define.
    std::vector<std::string> arguments = {"mcpp",
                                          "-C",
                                          "-k",
                                          "-e",
                                          "en_us.utf8",
                                          "-D__SLICE2C__",
                                          "-DICE_VERSION=30708",
                                          "-D__ICE_VERSION__=30708"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    arguments.push_back(file);
    std::vector<char*> argv;
    for (std::string& a : arguments)
        argv.push_back(a.data());

    mcpp_use_mem_buffers(1);
    Preprocessed result;
    result.ok = mcpp_lib_main(static_cast<int>(argv.size()), argv.data()) == 0;
    if (const char* text = mcpp_get_mem_buffer(OUT))
        result.text = text;
    if (const char* messages = mcpp_get_mem_buffer(ERR))
        result.messages = messages;
    mcpp_use_mem_buffers(1); // frees them
    findFiles(result);
    return result;
}
