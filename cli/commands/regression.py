# SPDX-License-Identifier: MIT
"""regression: the tests, with selection, history and a page; what a timer runs."""
import functools
import shlex
import sys
import time

from cli.build_folder import ROOMS_OF_PROGRAMS, BuildFolder, configured
from cli.command import COMMANDS, command
from cli.options import (BLOCK, BUILD, COUNT, FRESH, JOBS, LABEL, NAME, SEED, SWITCH, TESTS, UCOS2,
                         WORDS, Option, matching, number)
from cli.runner import Stop, run
from cli.table import Table

WAVES = Option("waves", number(0), "failures of which a waveform is written", 3)


def at_once(values):
    return values.tests or values.jobs + 2


def selection(values, *more):
    """Options of the regression tool that choose tests."""
    return [
        word for name in ("name", "label", *more) if getattr(values, name)
        for word in (f"--{name}", getattr(values, name))]


@command("test", [LABEL, NAME, SEED, FRESH, TESTS, UCOS2, BUILD, JOBS], make="test",
         brief="test --name ^tree[.]", examples=[
             "test", "test --label rtl", "test --name 'Burst' --seed 7"])
def test(values):
    """run all tests; firmware, models and IceC once more with sanitizers"""
    build = BuildFolder(values.build, values).prepare(tests=True)
    some, tests, seed = values.name or values.label, at_once(values), {
        "SEED": values.seed, "FRESH": "1" if values.fresh else ""}
    if not some or values.label == "zeroc":
        build.ninja()
    elif not values.built:
        build.ninja("regress")
        run([
            build / "tests/regress/regress", "--prepare", "--build", build.folder,
            *selection(values)])
    chosen = [
        *(["-L", values.label] if values.label else []),
        *(["-R", values.name] if values.name else []),
        *(["-C", "zeroc"] if values.label == "zeroc" else [])]
    build.ctest(*chosen, tests=tests, **seed)
    if not some:
        sanitized = BuildFolder("build/sanitized", values)
        sanitized.configure("-DSANITIZE=ON", f"-DROOMS={ROOMS_OF_PROGRAMS}")
        sanitized.ninja("sanitized")
        sanitized.ctest("-L", "sanitized", tests=tests, **seed)


@command("regress", [
    NAME, LABEL, BLOCK,
    Option("changed", SWITCH, "tests that what has changed since they passed can fail"),
    Option("failed", SWITCH, "tests that failed the last time"),
    Option("kept", SWITCH, "failed tests with the seeds that are kept"),
    Option("seed", matching(r"\d{1,18}|random", "a whole number, or random", metavar="N|random"),
           "the first seed", "1"),
    Option("repeat", COUNT, "seeds", 1), WAVES, FRESH, TESTS, BUILD, JOBS], make="regress",
         brief="regress --block bus", examples=[
             "regress --changed", "regress --name Burst --seed random --repeat 20"])
def regress(values):
    """run the regression, write build/regress/report.html"""
    build = configured(values, "regress", tests=True)
    switches = [
        f"--{word}" for word, on in (("changed", values.changed), ("rerun-failed", values.failed),
                                     ("kept", values.kept)) if on]
    return run([
        build / "tests/regress/regress", "--make", "--build", build.folder, "--jobs",
        at_once(values), "--seed", values.seed, "--repeat", values.repeat, "--waves", values.waves,
        *selection(values, "block"), *switches], check=False, env={
            "FRESH": "1" if values.fresh else ""})


@command("nightly", [
    Option("nightly", COUNT, "seeds that are drawn", 3),
    Option("steps", WORDS, "these alone, by their names in the table", []), NAME, LABEL, WAVES,
    TESTS, BUILD, JOBS], make="nightly",
         brief="nightly --steps kept random --nightly 1 --name ^tree[.]pages", examples=[
             "nightly", "nightly --steps kept check-mutants"])
def nightly(values):
    """what a timer runs: seeds that have failed, fresh seeds, ZeroC's own suites, the long form of
    every command

    Failing seeds stay in build/regress/seeds.jsonl until their tests pass with them. Writes a table
    of the steps, build/nightly.md."""
    build, tests = BuildFolder(values.build, values), at_once(values)
    # COMPARE_MS: test_quiet compares a second; FUZZ: times as many inputs of fuzzers; HOSTILE:
    # packets of test_link.
    long = {"FRESH": "1", "FUZZ": "10", "COMPARE_MS": "1000", "HOSTILE": "10000000"}
    tool = [
        build / "tests/regress/regress", "--build", build.folder, "--jobs", tests, "--waves",
        values.waves, *selection(values)]

    def regression(*words):
        return run([*tool, *words], check=False, env=long)

    def suite(name):
        return build.ctest("-C", name, "-L", name, tests=tests, check=False, **long)

    def whole(lines):
        day = time.strftime("%Y%m%d")
        return max([
            run([sys.executable, "icesoc", *shlex.split(line.format(day=day))], check=False,
                env=long) for line in lines])

    steps = {
        "kept": lambda: regression("--kept"),
        "random": lambda: regression("--seed", "random", "--repeat", values.nightly),
        "zeroc": lambda: suite("zeroc"), "missions": lambda: suite("nightly"), **{
            each.name.replace(' ', '-'): functools.partial(whole, each.long)
            for each in COMMANDS.values() if each.long}}
    for name in values.steps:
        if name not in steps:
            raise Stop(f"there is no step '{name}': {', '.join(steps)}", 2)
    build.prepare(tests=True).ninja()
    table = Table("build/nightly")
    for name in values.steps or steps:  # each runs, even if an earlier one failed
        begin = time.monotonic()
        table.add(name, steps[name](), time.monotonic() - begin)
    return table.end()
