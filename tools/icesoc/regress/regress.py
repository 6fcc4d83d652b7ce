# SPDX-License-Identifier: MIT
"""Runs the regression: chosen tests, in parallel, with history, waveforms of failures and a page.
Exit status 0: all passed; 1: some failed; 2: it could not run; 130: stopped by Ctrl-C, with a
report of the finished tests."""
import argparse
import collections
import datetime
import functools
import pathlib
import random
import re
import sys
import time

from icesoc.util import spelling
from icesoc.util.errors import Interrupted, Stop, nearest
from icesoc.util.lock import lock, only_one
from icesoc.util.ninja import run_ninja
from icesoc.util.process import (adopt_orphans, collect, end_descendants, end_orphans, hear_signals,
                                 signals_held)
from icesoc.regress.changes import Changes
from icesoc.regress.failures import examine
from icesoc.regress.history import History, make_run
from icesoc.regress.lights import text_of
from icesoc.regress.report import gather, write_reports
from icesoc.regress.junit import write_junit
from icesoc.regress.execution import run_tests
from icesoc.regress.tests import (Finder, Graph, Name, fingerprint, list_tests, read_plan,
                                  targets_of, unmatched, write_numbers)
from icesoc.regress.waves import add_waves


def regex(text, kind=re.compile):
    try:
        return kind(text)
    except re.error:
        raise argparse.ArgumentTypeError(
            f"'{text}': expected a regular expression; .* matches any text") from None


class Parser(argparse.ArgumentParser):
    def error(self, message):
        print(f"regress: {message}; see --help", file=sys.stderr)
        sys.exit(2)


def parse(words):
    parser = Parser("regress", description=__doc__, allow_abbrev=False,
                    formatter_class=argparse.RawDescriptionHelpFormatter)
    add, folder = parser.add_argument, pathlib.Path
    add("--source", type=folder, default=folder("."), help="root of the tree (default: .)")
    add("--build", type=folder, default=folder("build/main"), help="build folder with the tests")
    add("--out", type=folder, default=folder("build/regress"), help="output folder of reports")
    add("--name", type=functools.partial(regex, kind=Name), default=Name(""),
        help="whole word in test names, or a regular expression")
    add("--folder", default="", help="tests of this folder, such as hdl/fsmc or ip/fir")
    add("--select", type=folder, metavar="FILE",
        help="only write the numbers of the chosen tests, for ctest -I")
    add("--block", help="one block: modem, link, bus, ...")
    add("--label", type=regex, default=regex(""), help="labels: rtl, formal, lint, firmware, ...")
    only = parser.add_mutually_exclusive_group()
    only.add_argument("--changed", action="store_true", help="only tests that failed in their "
                      "last run, and tests with a program or sources changed since they passed")
    only.add_argument("--rerun-failed", action="store_true", help="only tests that "
                      "failed in their last run")
    only.add_argument("--kept", action="store_true", help="only tests that failed earlier and "
                      "have not passed since, each with the seeds with which it failed")
    add("--seed", default="1", help="seed of the random tests, or `random`")
    add("--repeat", type=int, default=1, help="number of runs, each with the next seed")
    add("--jobs", type=int, default=2, help="number of tests run in parallel")
    add("--waves", type=int, default=3, help="number of failures for which waveforms are "
        "recorded")
    add("--make", action="store_true", help="build what the chosen tests need first")
    add("--prepare", action="store_true", help="only build what the chosen tests need; with "
        "--list, only print it")
    add("--plan", action="store_true", help="only check that each pattern of tests/plan.toml "
        "matches a test")
    add("--list", action="store_true", help="only print the chosen tests")
    add("--by-make", action="store_true", help="print commands of make in place of ./icesoc")
    options = parser.parse_args(words)
    spelling.IS_MAKE = options.by_make
    return options


class Regression:
    def __init__(self, options):
        self.options = options
        options.build = options.build.resolve()
        self.history = History(options.out / "history.jsonl",
                               options.source / "tests/costs.txt")
        self.changes = options.changed and self._changes()

    @functools.cached_property
    def graph(self):
        return Graph(self.options.source, self.options.build)

    def _changes(self):
        return Changes(self.options.source, self.options.build, self.options.out)

    def choose(self, tests, built=True):
        """Returns the tests that the options select. The cases of a program that is not built are
        unknown, so all of the program is selected."""
        o, chosen = self.options, []
        exact = any(test.name == o.name.text for test in tests)
        for test in tests:
            if o.block and o.block not in test.blocks():
                continue
            if o.folder and not test.is_in(o.folder):
                continue
            if o.label.pattern and not any(map(o.label.search, test.labels)) and \
                    (test.labels or not test.unbuilt):
                continue
            if test.unbuilt:  # the cases of this program are not known yet
                named = not exact and (not o.name.text or
                                       test.may_hold(o.name, self._sources(test)))
            else:
                named = test.name == o.name.text if exact else o.name.search(test.name)
            if named and not (o.changed and not self._changed(test, built)) and \
                    not (o.rerun_failed and self.history.last(test.name) != "f"):
                chosen.append(test)
        if not built and o.name.text and not exact:
            chosen += self._outdated(tests, {test.program for test in chosen})
        return chosen

    def _outdated(self, tests, known):
        """Finds programs, other than those in `known`, that are older than their sources, if these
        may contain a case with the requested name. Returns one test of each of these
        programs, so that the program is built."""
        o, found, known = self.options, {}, set(known)
        for test in tests:
            if test.program in known or test.unbuilt \
                    or not test.is_program(o.build) or (o.folder and not test.is_in(o.folder)):
                continue
            known.add(test.program)
            program = pathlib.Path(test.command[0])
            age = program.stat().st_mtime if program.exists() else 0
            files = [o.source / file for file in self.graph.inputs(test.program)]
            if any(file.exists() and file.stat().st_mtime > age for file in files) \
                    and test.may_hold(o.name, self._sources(test)):
                found[test.program] = test
        return list(found.values())

    def _sources(self, test):
        """Returns the texts of a program's C++ files."""
        files = [self.options.source / file for file in self.graph.inputs(test.program)]
        return [file.read_text(errors="replace") for file in files
                if file.suffix == ".cpp" and file.exists()]

    def _changed(self, test, built):
        """Returns whether --changed selects a test. It selects a test that failed in its last run,
        and a test that has passed, but not with the current sources. A test that has never passed
        here is selected if its files differ from the last commit."""
        passed = self.history.last_pass(test.name)
        if self.history.last(test.name) == "f":
            return True
        if passed and built:
            return self.history.now(test) != "p"
        return self.changes.touched(test, passed)

    def build(self):
        """Builds the targets of the chosen tests or, with --list, only lists them. After the build,
        the cases of these programs are known."""
        o = self.options
        tests = list_tests(o.build)
        outputs = {line.rpartition(":")[0] for line in collect(
            ["ninja", "-C", o.build, "-t", "targets", "all"])[1].splitlines()}
        chosen, found = self.choose(tests, built=False), set()
        # tests that set up the fixtures of chosen tests are appended, and the loop visits them as
        # well
        for test in chosen:
            found.update(targets_of(test, o.build, outputs))
            chosen += [other for other in tests if set(other.sets) & set(test.needs) and
                       other not in chosen]
        targets = ["all"] if "all" in found else sorted(found)
        if o.list or not targets:
            print("".join(target + "\n" for target in targets), end="")
            return
        print(f"Building {len(targets)} targets ..." if len(targets) > 8 else
              f"Building {' '.join(targets)} ...", flush=True)
        log = o.build / "build.log"
        with lock(o.build, busy=f"waiting for another build in {o.build} ..."):
            if run_ninja(["ninja", "-C", o.build, *targets], log, check=False):
                raise Stop(f"the build failed (above); the whole output is in {log}")
        if self.changes:
            self.changes.forget_graph()

    def nothing(self, tests):
        """Prints the reason why no test is selected. Returns the exit status."""
        o = self.options
        if o.changed or o.rerun_failed:
            print(f"Nothing to run: no test {'changed' if o.changed else 'failed'} since the last "
                  "run.")
            return 0
        given = "".join(f" {name} '{value}'" for name, value in (
            ("--block", o.block), ("--label", o.label.pattern), ("--name", o.name.text),
            ("--folder", o.folder)) if value)
        labels = sorted({label for test in tests for label in test.labels})
        similar = nearest(o.block, {word for test in tests for word in test.blocks()}) \
            if o.block else ""
        regress = o.build / "tests/regress/regress"
        print(f"regress: no test matches{given}{similar}; `{regress} --build {o.build} --list` "
              "lists the names. A plain word is a whole word of a name; --name 'fir.*' also "
              "matches parts of words.\n"
              f"labels: {' '.join(labels)}\n"
              f"folders: {' '.join(sorted({test.place for test in tests}))}", file=sys.stderr)
        return 2

    def run(self):
        o, history = self.options, self.history
        if o.make or o.prepare:
            self.build()
        tests = list_tests(o.build)
        if not (o.prepare or o.select) or o.changed:
            fingerprint(tests, o.source, o.build)
        chosen = self.choose(tests)
        if chosen and o.select:
            write_numbers(o.select, chosen)
        # with --prepare or --select, CTest runs the tests later, without history
        if not chosen or o.prepare or o.select:
            return 0 if chosen else self.nothing(tests)
        if o.list:
            print("\n".join(test.name for test in chosen))
            return 0
        first = random.getrandbits(32) if o.seed == "random" else int(o.seed)
        rounds = [(str(first + i), chosen) for i in range(o.repeat)]
        if o.kept:
            failing = history.failing(chosen)
            rounds = [(seed, [test for test in chosen if (test.name, seed) in failing])
                      for seed in sorted({seed for _, seed in failing})]
        rounds = [each for each in rounds if each[1]]
        if not rounds:
            print("Nothing to run: no failing seed of these tests is known.")
            return 0
        return self._run_rounds(rounds, chosen, tests)

    def _run_rounds(self, rounds, chosen, tests):
        o, history = self.options, self.history
        changes, start = self.changes or self._changes(), time.monotonic()
        begin = datetime.datetime.now().astimezone().isoformat(timespec="seconds")
        adopt_orphans()
        results, interrupted = [], None
        for seed_, some in rounds:
            more, interrupted = run_tests(some, o.build, o.out, seed_, o.jobs, history)
            results += more
            if interrupted:
                break
        stopped = interrupted and \
            f"after {len(results)} of {sum(len(some) for _, some in rounds)}" or ""
        known = {test.name: test for test in tests}
        try:
            with signals_held():
                failures = self._examine(results, known, changes)
                commit = self._note(chosen, results, failures, changes, stopped,
                                    time.monotonic() - start)
                # waveforms may take minutes, so a report without them is written first
                if failures and not interrupted:
                    write_reports(gather(history, tests, results, failures, o.source), failures,
                                  o.build / "page", o.out)
                    print(f"{o.out}/report.html is written; waveforms are added to it later, if "
                          "any can be made",
                          flush=True)
            if not interrupted:
                add_waves(failures, known, o.source, o.build, o.jobs, o.waves)
        except Interrupted as stop:  # the report is still written, without waveforms
            interrupted = stop
            end_descendants()
        with signals_held():
            data = gather(history, tests, results, failures, o.source)
            try:
                write_reports(data, failures, o.build / "page", o.out)
                of = {id(failure.result): failure for failure in failures}
                write_junit(o.out / "junit.xml", results, begin, lambda each: of[id(each)].entry(),
                            commit=commit, stopped=stopped)
            finally:  # the summary is printed even if the disk is full
                summary(data, failures, o.out)
        return interrupted.status if interrupted else 1 if failures else 0

    def _examine(self, results, known, changes):
        """Returns the failures, with the changes that may have caused them. Prints the names of
        processes that tests left, and of files that changed while the tests ran."""
        for each in end_orphans():
            print("Ended a process that a test left behind:", each)
        for each in changes.meanwhile():
            print("Changed while the tests ran, by a test or by you:", each)
        failures = examine(results, known, self.options.out)
        for failure in failures:
            if test := known.get(failure.result.name):
                failure.changed = changes.since(self.history.last_pass(test.name), test,
                                                failure.result.seed)
        return failures

    def _note(self, chosen, results, failures, changes, stopped, seconds):
        """Adds the run to the history; returns the commit."""
        git = ["git", "-C", self.options.source]
        status, commit = collect([*git, "describe", "--always", "--dirty", "--abbrev=10"])
        commit = "unknown" if status else commit.strip()
        subject = collect([*git, "log", "-1", "--format=%s"])
        reasons = {f.bucket: f"{f.result.name}: {f.reason[:120]}" for f in reversed(failures)}
        self.history.add({**make_run(chosen, results, commit, seconds), "stopped": stopped,
                          "subject": "" if subject[0] else subject[1].strip(),
                          "tree": changes.tree, "reasons": list(reversed(reasons.values()))[:5]})
        return commit


def summary(data, failures, out):
    # groups with the same reason, in the order of their first failure
    groups = collections.defaultdict(list)
    for failure in failures:
        groups[failure.bucket].append(failure)
    for members in groups.values():
        print(f"\n{len(members)} x  {members[0].reason[:200]}")
        for failure in members:
            is_new = failure is members[0] or failure.changed != members[0].changed
            print(f"    {failure.repeat}\n        log {failure.log}")
            for text in (failure.place and f"at {failure.place}", is_new and failure.changed,
                         failure.wave and f"gtkwave {failure.save or failure.wave}"):
                if text:
                    print(f"        {text}")
    if data["flaky"]:
        print("\nFlaky:", *data["flaky"])
    longest = sorted(((row[2], row[0]) for row in data["results"]), reverse=True)[:3]
    if longest:
        print("\nThe longest:", *(f"{name} {seconds:.1f} s" for seconds, name in longest))
    if data["seeds"]:
        again = spelling.command("regress", spelling.switch("kept"))
        print(f"\n{len(data['seeds'])} failing seeds are kept: {again} runs them again")
    stopped = f"stopped {data['stopped']}: " if data["stopped"] else ""
    print(f"\n{text_of(data['lights'])}{stopped}{data['passed']} passed, {data['failed']} failed, "
          f"{data['skipped']} skipped in {data['seconds']:.0f} s; {out}/report.html", flush=True)


def main(words):
    options = parse(words)
    hear_signals()
    try:
        if options.plan:
            plan, finder = read_plan(options.source), Finder(list_tests(options.build))
            wrong = [line for each in plan for line in unmatched(each, finder)]
            print("".join(line + "\n" for line in wrong) + f"{len(plan)} requirements")
            return 1 if wrong or not plan else 0
        if options.prepare or options.select:
            return Regression(options).run()
        with only_one(options.out, "regress"):
            regression = Regression(options)
            if damaged := regression.history.damaged:
                print(f"{damaged} damaged lines of {options.out}/history.jsonl are ignored")
            return regression.run()
    except Stop as error:
        print(f"regress: {error}", file=sys.stderr)
        return 2
    except Interrupted as interrupted:
        return interrupted.status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
