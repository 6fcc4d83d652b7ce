// SPDX-License-Identifier: MIT
//
// slurm: the same tests as one array job. Those of a node that dies are queued again.

#include "files.h"
#include "process.h"
#include "runner.h"
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace fs = std::filesystem;

namespace {

void writeJob(const std::string& path, const std::vector<Test>& tests, const RunOptions& options) {
    std::ostringstream job;
    job << "#!/bin/sh\n#SBATCH --job-name=icesoc\n#SBATCH --ntasks=1\n#SBATCH --requeue\n"
        << "export SEED=" << options.seed << "\n"
        << "test=$(sed -n \"$((SLURM_ARRAY_TASK_ID + 1))p\" "
        << quoted(fs::absolute(options.out + "/slurm.list")) << ")\n"
        << "exec ctest --test-dir " << quoted(fs::absolute(options.build))
        << " -I \"0,0,0,$test\" --output-junit " << quoted(fs::absolute(options.out))
        << "/slurm-$SLURM_ARRAY_TASK_ID.xml --test-output-size-failed 200000\n";
    writeFile(path, job.str());
    std::string list;
    for (const Test& test : tests)
        list += std::to_string(test.number) + "\n";
    writeFile(options.out + "/slurm.list", list);
}

volatile std::sig_atomic_t interrupted = 0;

// Reads the result that a task left. False: there is none yet.
bool resultOf(const std::string& junit, Result& result) {
    if (!fs::exists(junit))
        return false;
    try {
        auto one = readJUnit(junit);
        if (one.size() != 1)
            return false;
        result = one[0];
        return true;
    } catch (const std::runtime_error&) { // half written
        return false;
    }
}

} // namespace

std::vector<Result> runSlurm(const std::vector<Test>& tests, const RunOptions& options) {
    // Without a configuration sbatch looks for one on the network, for a minute.
    const char* given = std::getenv("SLURM_CONF");
    if (const std::string conf = given ? given : "/etc/slurm/slurm.conf"; !fs::exists(conf))
        throw std::runtime_error("there is no cluster: " + conf +
                                 " does not exist; set SLURM_CONF to its configuration");
    std::string script = options.out + "/slurm.sh";
    writeJob(script, tests, options);
    auto junit = [&](size_t i) { return fmt::format("{}/slurm-{}.xml", options.out, i); };
    for (size_t i = 0; i < tests.size(); ++i)
        fs::remove(junit(i));
    Output job = run({"sbatch", "--parsable", "--chdir", fs::absolute(options.out), "--output",
                      "slurm-%a.log", fmt::format("--array=0-{}", tests.size() - 1), script});
    if (job.status != 0)
        throw std::runtime_error("sbatch: " + job.text);
    std::string id = job.text.substr(0, job.text.find_first_of(";\n"));
    auto before = std::signal(SIGINT, [](int) { interrupted = 1; });
    std::vector<Result> results(tests.size());
    std::vector<bool> known(tests.size());
    unsigned done = 0;
    for (bool running = true; running;) {
        // Asked before the files are looked at: a job that is gone has left all it will leave. A
        // controller that does not answer has said nothing of it.
        const Output queue = run({"squeue", "--noheader", "--jobs", id});
        running = queue.status == 0 ? queue.text.find(id) != std::string::npos
                                    : queue.text.find("Invalid job id") == std::string::npos;
        if (interrupted) {
            run({"scancel", id});
            throw std::runtime_error("interrupted; job " + id + " is cancelled");
        }
        for (size_t i = 0; i < tests.size(); ++i) {
            if (known[i])
                continue;
            known[i] = resultOf(junit(i), results[i]);
            if (!known[i] && !running) { // somebody cancelled it: that is no pass
                known[i] = true;
                results[i].name = tests[i].name;
                results[i].status = "failed";
                results[i].log = "Slurm gave no result for this test; see " + options.out +
                                 fmt::format("/slurm-{}.log", i);
            }
            if (!known[i])
                continue;
            results[i].seed = options.seed;
            if (options.onEnd)
                options.onEnd(results[i], ++done, static_cast<unsigned>(tests.size()));
        }
        if (running)
            std::this_thread::sleep_for(std::chrono::seconds(1));
    }
    std::signal(SIGINT, before);
    return results;
}
