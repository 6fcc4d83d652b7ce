// SPDX-License-Identifier: MIT
//
// slurm: the same tests as one array job.

#include "runner.h"
#include "shell.h"
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <stdexcept>

namespace fs = std::filesystem;

namespace {

void writeJob(const std::string& path, const std::vector<Test>& tests, const RunOptions& options) {
    std::ofstream job(path);
    job << "#!/bin/sh\n#SBATCH --job-name=icesoc\n#SBATCH --ntasks=1\n"
        << "export SEED=" << options.seed << "\n"
        << "test=$(sed -n \"$((SLURM_ARRAY_TASK_ID + 1))p\" " << quoted(fs::absolute(options.out + "/slurm.list"))
        << ")\n"
        << "exec ctest --test-dir " << quoted(fs::absolute(options.build)) << " -I \"0,0,0,$test\" --output-junit "
        << quoted(fs::absolute(options.out)) << "/slurm-$SLURM_ARRAY_TASK_ID.xml --test-output-size-failed 200000\n";
    std::ofstream list(options.out + "/slurm.list");
    for (const Test& test : tests)
        list << test.number << '\n';
    if (!job.flush() || !list.flush())
        throw std::runtime_error("cannot write " + path + ": is the disk full?");
}

} // namespace

std::vector<Result> runSlurm(const std::vector<Test>& tests, const RunOptions& options) {
    std::string script = options.out + "/slurm.sh";
    writeJob(script, tests, options);
    for (size_t i = 0; i < tests.size(); ++i)
        fs::remove(fmt::format("{}/slurm-{}.xml", options.out, i));
    Output out = run({"sbatch", "--wait", "--chdir", fs::absolute(options.out),
                      "--output", "slurm-%a.log", fmt::format("--array=0-{}", tests.size() - 1), script});
    std::vector<Result> results;
    for (size_t i = 0; i < tests.size(); ++i) {
        std::string junit = fmt::format("{}/slurm-{}.xml", options.out, i);
        Result result;
        if (fs::exists(junit)) {
            auto one = readJUnit(junit);
            if (one.size() == 1)
                result = one[0];
        }
        if (result.name.empty()) { // the node died, or the job was cancelled: that is no pass
            result.name = tests[i].name;
            result.status = "failed";
            result.log = "Slurm gave no result for this test.\n" + out.text;
        }
        result.seed = options.seed;
        if (options.onEnd)
            options.onEnd(result, static_cast<unsigned>(i + 1), static_cast<unsigned>(tests.size()));
        results.push_back(std::move(result));
    }
    return results;
}
