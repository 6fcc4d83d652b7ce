// SPDX-License-Identifier: MIT
//
// failures: what a person needs of a failed test: why, its log, how to repeat it, who fails alike,
// a waveform.

#ifndef FAILURES_H
#define FAILURES_H

#include "runner.h"
#include <nlohmann/json_fwd.hpp>

struct Failure {
    Result result;
    std::string reason; // the line that says what went wrong
    std::string
        bucket; // the reason without its numbers: failures of one bucket have one cause, likely
    std::string repeat;        // one command
    std::string place;         // GoogleTest's: "tests/sw/link/link_test.cpp:185", or ""
    std::string changed;       // since it passed, by Changes; or ""
    std::string log;           // file
    std::string wave;          // FST or VCD file, or ""
    std::string about;         // text that names signals which matter: the assertion, or the reason
    std::string scope;         // instance in which to look: "u_window.u_wrapper", or ""
    bool ownAssertion = false; // of a proof: it stands in the module that is proven
    std::string save;          // GTKWave save file, or ""
    uint64_t clock = 0;        // of the failure, in that waveform; 0: its end
};

// Keeps the logs, and the traces of proofs, in <out>/failures/. Proofs come first, then the tests
// of single blocks, missions last.
std::vector<Failure> examine(const std::vector<Result>& results, const std::vector<Test>& tests,
                             const std::string& out);

// Runs failed tests of RTL again in a build with waveforms (build/trace), and keeps the clocks
// around the failure; of a failed flight its replay, around the last event of a core. `launcher`:
// local, or slurm, where a node runs them. Says on the terminal what it does; a test that cannot be
// traced has none.
void addWaves(std::vector<Failure>& failures, const std::vector<Test>& tests,
              const std::string& source, const std::string& build, const std::string& launcher,
              unsigned jobs, unsigned limit);

// Returns the end of a waveform, VCD or FST (by fst2vcd): {from, to, signals: [[name, bits, [time,
// value, ...]], ...], more: signals left out}: the program's, those that the failure's text names,
// those that move below its instance, others that move, those that stay as they are; among each the
// outermost first; the last changes of each. Null: it is empty. Of a drawing of more than `room`
// bytes as JSON the older changes are left out, then the last signals.
nlohmann::json drawingOf(const Failure& failure, size_t room);

#endif
