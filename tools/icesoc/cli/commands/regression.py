# SPDX-License-Identifier: MIT
"""regression: commands that run tests, with selection, history and a page; find the commit that
broke a test; and run the nightly suite."""
import functools
import re
import shlex
import time
import typing
from pathlib import Path

from icesoc.cli import choices
from icesoc.cli.build_folder import ROOMS_OF_PROGRAMS, BuildFolder, configured
from icesoc.cli.command import COMMANDS, command
from icesoc.cli.options import (BLOCK, BUILD, CORE_FOLDERS, COUNT, FRESH, JOBS, LABEL, SEED, SWITCH,
                                TEST_NAME, TESTS, TEXT, UCOS2, WORDS, Option, matching, number)
from icesoc.regress.history import History
from icesoc.regress.tests import write_numbers
from icesoc.regress.unchanged import Passes
from icesoc.util import spelling
from icesoc.util.console import say
from icesoc.util.errors import Stop, nearest
from icesoc.util.lock import lock
from icesoc.util.process import output, run
from icesoc.util.table import Table
from icesoc.util.tree import commit

WAVES = Option("waves", number(0), "number of failures for which waveforms are recorded", 3)


def at_once(values):
    return values.tests or values.jobs + 4


def selection(values, *more):
    """Returns the options that select tests, as words for the regression program. A value may begin
    with a hyphen."""
    return [f"--{name}={getattr(values, name)}" for name in ("name", "label", *more)
            if getattr(values, name)]


@command("test", [
    Option("folder", TEXT, "folder of the tests, such as hdl/fsmc or ip/fir (default: all)", "",
           positional=True, choices=choices.test_folders, has_name=choices.has_tests),
    LABEL, TEST_NAME,
    Option("all", SWITCH, "run all tests, also those that have passed with the same inputs"),
    SEED, FRESH, TESTS, UCOS2, BUILD, JOBS], make="test",
         brief="test tree", examples=[
             "test hdl/fsmc", "test --label rtl", "test --name Burst --seed 7", "test --all"])
def test(values):
    """run all tests, the tests of a folder, or tests selected by options

    Without options, runs the tests of the build folder, then the tests of firmware, models and
    IceC again with sanitizers. Leaves out tests that have passed with the same inputs (program,
    files, packages and seed). With a folder, a name or a label, builds only the programs of the
    selected tests, and runs all selected tests."""
    build = BuildFolder(values.build, values).prepare(tests=True)
    some, tests, seed = values.folder or values.name or values.label, at_once(values), {
        "SEED": values.seed, "FRESH": "1" if values.fresh else ""}
    chosen = ["--end-hangs"]
    # the tests with this label belong to a configuration of CTest; -C selects it
    if values.label == "zeroc":
        build.ninja()
        chosen = ["-C", "zeroc", "-L", "zeroc", *(["-R", values.name] if values.name else [])]
    elif some:
        build.ninja("regress")
        numbers = build / "chosen.tests"
        run([build / "tests/regress/regress", *([] if values.built else ["--prepare"]), "--select",
             numbers, "--build", build.folder, *selection(values, "folder"),
             *(["--by-make"] if spelling.IS_MAKE else [])])
        chosen += ["-I", numbers.absolute()]
    else:
        build.ninja()
        return every_test(build, values, tests, seed)
    build.ctest(*chosen, tests=tests, **seed)


def every_test(build, values, tests, seed):
    """Runs all tests, or only the tests with inputs that have changed since they passed."""
    status = changed_tests(build, values, tests, seed)
    if not status:
        sanitized = BuildFolder("build/sanitized", values)
        sanitized.configure("-DSANITIZE=ON", f"-DROOMS={ROOMS_OF_PROGRAMS}")
        sanitized.follow(build)
        sanitized.ninja("sanitized")
        status = changed_tests(sanitized, values, tests, seed, label="sanitized")
    return status


def changed_tests(build, values, tests, seed, label=""):
    """Runs the tests of a build folder, or of a label, that have not passed with their current
    inputs. With --all or --fresh, runs all of them. Records the tests that have passed."""
    passes = Passes(Path("."), build.folder, str(values.seed))
    some, others = passes.changed(label, values.all or values.fresh)
    if others:
        say(f"{build.folder}: {others} tests have passed with the present files and packages; "
            "--all (ALL=1) runs them again")
    if not some:
        return 0
    numbers = build / "changed.tests"
    write_numbers(numbers, some)
    (build / "junit.xml").unlink(missing_ok=True)
    try:
        # tests with sanitizers take longer than usual
        return build.ctest(*([] if label else ["--end-hangs"]), "-I", numbers.absolute(),
                           tests=tests, check=False, **seed)
    finally:  # also after Ctrl-C: junit.xml then has the finished tests
        passes.note(build / "junit.xml")


@command("regress", [
    TEST_NAME, LABEL, BLOCK,
    Option("changed", SWITCH, "only tests with files that have changed since the tests passed"),
    Option("failed", SWITCH, "only tests that failed last time"),
    Option("kept", SWITCH, "only tests that failed earlier and have not passed since, each with "
                           "the seeds with which it failed"),
    Option("seed", matching(r"\d{1,18}|random", "a whole number, or random", metavar="N|random"),
           "first seed", "1"),
    Option("repeat", COUNT, "number of seeds to run", 1), WAVES, FRESH, TESTS, CORE_FOLDERS,
    BUILD, JOBS],
         make="regress",
         brief="regress --block bus", examples=[
             "regress --changed",
             "regress --name Burst --seed random --repeat 20",
             "regress --block fir --waves 3"])
def regress(values):
    """run tests, with history, causes and waveforms of failures

    Builds what the tests need first. Writes build/regress/report.html, a page with the state of
    every test, requirement and block.
    """
    build = configured(values, "regress", tests=True)
    switches = [
        f"--{word}" for word, on in (("changed", values.changed), ("rerun-failed", values.failed),
                                     ("kept", values.kept), ("by-make", spelling.IS_MAKE)) if on]
    return run([build / "tests/regress/regress", "--make", "--build", build.folder, "--jobs",
                at_once(values), "--seed", values.seed, "--repeat", values.repeat, "--waves",
                values.waves, *selection(values, "block"), *switches], check=False,
               env={"FRESH": "1" if values.fresh else ""})


def last_good(test):
    """Returns the last commit at which the test passed. Runs with uncommitted changes are ignored,
    because a bisection cannot start there."""
    good = [each["commit"] for each in History().runs if "dirty" not in each["commit"]
            and {end[1] for end in each["ends"] if end[0] == test} == {"p"}]
    if not good:
        raise Stop(f"no recorded run has a commit at which {test} passed; name one with GOOD= "
                   "(--good)", 2)
    return good[-1]


@command("bisect", [
    Option("test", TEXT, "CTest name of the test", "", positional=True),
    Option("good", TEXT, "commit at which the test passes; default: the last commit at which it "
                         "passed here", ""),
    Option("bad", TEXT, "commit at which the test fails", "HEAD"),
    Option("list", SWITCH, "only list the commits to search"), SEED, BUILD, JOBS],
         make="bisect", brief="bisect test_fifo.Fifo.Wraps --good HEAD~3 --list", examples=[
             "bisect test_fifo.Fifo.Wraps --good HEAD~20",
             "bisect test_fifo.Fifo.Wraps --good main~30 --bad main",
             "bisect test_fifo.Fifo.Wraps --good HEAD~20 --seed 7"])
def bisect(values):
    """find the commit that broke a test, in a separate checkout

    Skips commits that do not build or do not have the test. The last line of output is the commit.
    Exit status: 0 found, 1 not found, 2 the search could not start.
    """
    test = values.test
    if not test:
        raise Stop("TEST: expected the CTest name of a test: ./icesoc bisect test_fifo.Fifo.Wraps",
                   2)
    bad = commit(values.bad, "BAD")
    good = commit(values.good or last_good(test), "GOOD")
    if run(["git", "merge-base", "--is-ancestor", good, bad], check=False):
        raise Stop(f"GOOD: expected an ancestor of {values.bad}, got {values.good or good}", 2)
    if values.list:
        return run(["git", "log", "--oneline", f"{good}..{bad}"])
    program = (configured(values, "regress", tests=True) / "tests/regress/regress").absolute()
    tree = Path("build/bisect/tree").absolute()
    with lock("build/bisect/lock", refuse="bisect: another one runs in this folder; wait until it "
                                          "ends"):
        run(["git", "worktree", "remove", "--force", tree], check=False, stderr=-3)
        run(["git", "worktree", "prune"])
        run(["git", "worktree", "add", "-q", "--detach", tree, bad])
        try:
            return search(program, values, good, bad, tree)
        finally:
            run(["git", "worktree", "remove", "--force", tree], check=False)


# Script that tests the current commit; exit status 125: no result. The build is kept for the next
# commit.
STEP = """mkdir -p build
([ -e build/main/build.ninja ] || cmake -S . -B build/main -G Ninja || exit 125
exec setpriv --pdeathsig TERM "$0" "$@") >build/step.log 2>&1
status=$?
case $status in 0) result=passes ;; 1) result=fails ;; *) result='no result' status=125 ;; esac
git log -1 --format="%h %s: $result" >&2
exit $status
"""


def search(program, values, good, bad, tree):
    """Runs git bisect until it finds the first bad commit."""
    step = [
        "setpriv", "--pdeathsig", "TERM", "sh", "-c", STEP, program, "--make", "--name",
        f"^{re.escape(values.test)}$", "--seed", values.seed, "--jobs", values.jobs, "--waves", 0]

    def git(*words):
        run(["git", "bisect", *words], check=False, cwd=tree, stdout=-3)

    if run(step, check=False, cwd=tree) == 0:
        raise Stop(f"BAD: expected a commit at which the test fails, but it passes at {bad}", 2)
    git("start", bad, good)
    git("run", *step)
    log = output(["git", "bisect", "log"], cwd=tree)
    git("reset")
    first = re.search(r"^# first bad commit: \[(.*?)\]", log, re.M)
    if not first:
        raise Stop("the first bad commit was not found, because the test could not run at the "
                   "commits between the last good and the first known bad one")
    say("since " + output(["git", "log", "-1", "--format=%h %s (%an, %as)", first[1]]).strip())
    return 0


@command("nightly", [
    Option("nightly", COUNT, "number of new random seeds", 3),
    Option("steps", WORDS, "names of the steps to run, as listed in build/nightly.md (default: "
                           "all)", []), TEST_NAME, LABEL,
    WAVES, TESTS, BUILD, JOBS], make="nightly",
         brief="nightly --steps kept random --nightly 1 --name ^tree[.]pages", examples=[
             "nightly",
             "nightly --steps kept check-mutants",
             "nightly --nightly 5 --name fir"])
def nightly(values):
    """run the nightly suite: failing seeds, new seeds, slow commands

    Runs the tests with seeds that failed before and with new seeds. Then runs ZeroC's test suites,
    the longest missions, and the slow variants of some commands (docs/regression.md). Writes a
    table of the steps, build/nightly.md."""
    build, tests = BuildFolder(values.build, values), at_once(values)
    # Longer tests: COMPARE_MS is the simulated time that test_sim_quiet compares, in ms; HOSTILE is
    # the number of packets in test_link.
    long = {"FRESH": "1", "COMPARE_MS": "1000", "HOSTILE": "10000000"}
    program = [build / "tests/regress/regress", "--build", build.folder, "--jobs", tests, "--waves",
               values.waves, *selection(values)]

    def regression(*words):
        return run([*program, *words], check=False, env=long)

    def suite(name):
        return build.ctest("-C", name, "-L", name, tests=tests, check=False, **long)

    def whole(lines):
        day = time.strftime("%Y%m%d")
        return max([run(["./icesoc", *shlex.split(line.format(day=day))], check=False,
                        env=long) for line in lines])

    steps: dict[str, typing.Callable] = {
        "kept": lambda: regression("--kept"),
        "random": lambda: regression("--seed", "random", "--repeat", values.nightly),
        "zeroc": lambda: suite("zeroc"), "missions": lambda: suite("nightly"), **{
            each.name.replace(' ', '-'): functools.partial(whole, each.long)
            for each in COMMANDS.values() if each.long}}
    for name in values.steps:
        if name not in steps:
            raise Stop(f"unknown step '{name}': expected one of {', '.join(steps)}"
                       f"{nearest(name, steps)}", 2)
    build.prepare(tests=True).ninja()
    table = Table("build/nightly")
    for name in values.steps or steps:  # every step runs, even if an earlier one failed
        begin = time.monotonic()
        table.add(name, steps[name](), time.monotonic() - begin)
    return table.end()
