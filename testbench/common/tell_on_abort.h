// SPDX-License-Identifier: MIT
//
// tell_on_abort: states of models, printed when the program is aborted, as the regression does with
// a test that hangs.

#pragma once

#include <csignal>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <map>
#include <string>

// The clock of the model that ran last, for failed assertions.
inline uint64_t observedClock = 0;

// A line of each model that is alive, by its address; a model removes its own at its end.
inline std::map<const void*, std::function<std::string()>> tellers;

inline void tellOnAbort(const void* model, std::function<std::string()> tell) {
    tellers[model] = std::move(tell);
    std::signal(SIGABRT, [](int signal) { // the program ends: what it calls need not be safe here
        std::signal(signal, SIG_DFL);
        for (const auto& [_, line] : tellers)
            std::fprintf(stderr, "%s\n", line().c_str());
        std::raise(signal);
    });
}
