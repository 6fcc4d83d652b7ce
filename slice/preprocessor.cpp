// SPDX-License-Identifier: MIT
//
// preprocessor: one run of libmcpp over a file, output in memory.

#include "preprocessor.h"
extern "C" {
#include <mcpp_lib.h>
}
#include <set>

Preprocessed preprocess(const std::string& file, const std::vector<std::string>& options) {
    // -C: comments stay, for doc comments; -k: columns stay, for messages.
    std::vector<std::string> arguments = {"mcpp", "-C", "-k", "-e", "en_us.utf8"};
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

    std::set<std::string> seen;
    for (size_t at = 0; (at = result.text.find("#line ", at)) != std::string::npos; ++at) {
        size_t open = result.text.find('"', at), end = result.text.find('\n', at);
        size_t close = open == std::string::npos ? open : result.text.find('"', open + 1);
        if (close == std::string::npos || close > end)
            continue;
        std::string name = result.text.substr(open + 1, close - open - 1);
        if (seen.insert(name).second)
            result.dependencies.push_back(name);
    }
    return result;
}
