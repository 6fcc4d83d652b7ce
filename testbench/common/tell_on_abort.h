// SPDX-License-Identifier: MIT
//
// tell_on_abort: prints the state of all models when the program is aborted. The test runner aborts
// a test that hangs.

#pragma once

#include <csignal>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <map>
#include <string>

// Clock cycle of the model that ran last; the messages of failed assertions contain it.
inline uint64_t observedClock = 0;

// One function for each existing model, which returns a line of text about the model; the key is
// the model's address. A model removes its function when it is destroyed.
inline std::map<const void*, std::function<std::string()>> tellers;

inline void tellOnAbort(const void* model, std::function<std::string()> tell) {
    tellers[model] = std::move(tell);
    // the program ends anyway, so functions that are not signal-safe are allowed
    std::signal(SIGABRT, [](int signal) {
        std::signal(signal, SIG_DFL);
        for (const auto& [_, line] : tellers)
            std::fprintf(stderr, "%s\n", line().c_str());
        std::raise(signal);
    });
}
