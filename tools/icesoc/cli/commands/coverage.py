# SPDX-License-Identifier: MIT
"""coverage: measures which lines, branches and toggles of the C, C++, Verilog and VHDL sources the
tests reach."""
import shutil
import subprocess
from pathlib import Path

from icesoc.cli.build_folder import BuildFolder, configured
from icesoc.cli.command import command
from icesoc.cli.options import BUILD, JOBS, NAME, Option
from icesoc.util.console import say, warn
from icesoc.util.errors import Stop
from icesoc.util.process import run, tool
from icesoc.util.rooms import MEASURED, RTL, rooms
from icesoc.util.tree import tree_state, write_state

# labels of the tests that coverage is measured with
COUNTED = "rtl|firmware|vhdl|models|slice|interop|e2e"
# Tests that are left out: fuzzers have coverage counters of another kind, and e2e.cores builds a
# separate chip.
LEFT_OUT = "NOT_BUILT|[.]fuzz[.]|^e2e.cores"


@command("check coverage", [
    Option("name", NAME.kind,
           "only tests with a name that matches this expression; minimum figures are then not "
           "checked", ""), BUILD,
    JOBS], make="coverage", brief=["check coverage --name ^test_fsmc_corners[.]",
                             "check coverage --name ^fir[.]vhdl"],
         long="check coverage",
         examples=[
             "check coverage",
             "check coverage --name '^fir[.]vhdl'",
             "check coverage --jobs 2"])
def coverage(values):
    """measure the lines, branches and toggles that the tests reach

    Builds the RTL models and the C and C++ programs with coverage counters (build/coverage), runs
    all tests except proofs, lints and tests of tools, and merges the counts of Verilator, GHDL and
    gcov. Writes html/index.html and summary.json in build/coverage. Exit status 1: a figure is
    below its minimum in tests/limits.toml."""
    build = configured(values, tests=True)
    build.ninja("regress")
    counted = BuildFolder("build/coverage", values)
    counted.configure("-DCOVERAGE=ON")
    counted.follow(build)
    work, regress = counted.folder, build / "tests/regress/regress"
    tree = tree_state(".", MEASURED)
    limits = Path("tests/limits.toml")
    if values.name:
        run([regress, "--prepare", "--build", work, f"--name={values.name}"])
        limits = work / "no_limits.toml"
        limits.write_text('coverage."".points = 0\n')
    else:
        counted.ninja()
    points = run_tests(work, values)
    say("coverage: merging")
    infos = [*of_host(work), *of_rtl(work, points), *of_vhdl(work, points)]
    run(["lcov", "--quiet", *(word for info in infos for word in ("--add-tracefile", info)),
         "--output-file", work / "merged.info"])
    run(["genhtml", "--quiet", "--title", "IceSoC", "--output-directory", work / "html",
         work / "merged.info"])
    status = run([*tool("regress.coverage"), limits, work], check=False)
    write_state(work, tree)
    return status


def run_tests(work, values):
    """Runs the tests and returns the folder with their coverage files. The coverage of failed tests
    counts as well, because `regress` reports the failures."""
    points = work / "points"
    for folder in (points, work / "html"):
        shutil.rmtree(folder, ignore_errors=True)
    points.mkdir()
    for path in work.rglob("*.gcda"):
        path.unlink()
    say("coverage: running the tests")
    words = ["ctest", "--test-dir", work, "-j", values.jobs, "-L", COUNTED, "-E", LEFT_OUT]
    with open(work / "ctest.log", "w") as log:
        if run(words + (["-R", values.name] if values.name else []), check=False, stdout=log,
               stderr=log, env={"COVERAGE_DIR": points.absolute()}):
            warn(f"coverage: some tests failed, see {work}/ctest.log")
    return points


def lcov(work, info, *words):
    """Writes an info file with lcov. Returns a list with its path; the list is empty if lcov
    fails."""
    path = work / info
    with open(work / "lcov.log", "w") as log:
        status = run(["lcov", "--quiet", *words, "--output-file", path], check=False, stderr=log)
    if status:
        path.unlink(missing_ok=True)
    return [path] if path.exists() and path.stat().st_size else []


def own(work, info, source, rooms):
    """Writes an info file about the files in these folders of the tree. Returns a list with its
    path; the list is empty if the build contains no file of these folders."""
    return lcov(work, info, "--extract", source, *(f"{Path.cwd()}/{room}/*" for room in rooms))


def of_host(work):
    """Returns a list with the info file about C and C++, as `lcov` does."""
    found = lcov(work, "all.info", "--capture", "--directory", work, "--ignore-errors",
                 "gcov,source")
    if not found:
        raise Stop((work / "lcov.log").read_text()[-1000:] or "no C or C++ was counted", 2)
    return own(work, "host.info", found[0], rooms("core"))


def of_rtl(work, points):
    """Returns a list with the info file about Verilog, from Verilator's counts."""
    counts = sorted(points.glob("*.dat"))
    if not counts:
        return []
    for option, name in (("--write", "rtl.dat"), ("--write-info", "all_rtl.info")):
        run(["verilator_coverage", option, work / name, *counts], stdout=subprocess.DEVNULL)
    return own(work, "rtl.info", work / "all_rtl.info", RTL)


def of_vhdl(work, points):
    """GHDL's counts."""
    counts, info = sorted(points.glob("*.json")), work / "vhdl.info"
    with open(info, "w") as file:
        if counts:
            run([work / "ghdl/ghdl", "coverage", "--format=lcov", *counts], stdout=file)
    return [info] if info.stat().st_size else []
