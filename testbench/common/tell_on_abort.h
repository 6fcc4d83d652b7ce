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

// One line per live model, by the model's address; a model removes its line when it is destroyed.
inline std::map<const void*, std::function<std::string()>> tellers;

inline void tellOnAbort(const void* model, std::function<std::string()> tell) {
    tellers[model] = std::move(tell);
    std::signal(SIGABRT, [](int signal) { // the program ends anyway, so functions that are not
                                          // signal-safe are allowed
        std::signal(signal, SIG_DFL);
        for (const auto& [_, line] : tellers)
            std::fprintf(stderr, "%s\n", line().c_str());
        std::raise(signal);
    });
}
