# SPDX-License-Identifier: MIT
"""history: stores the results of each run in history.jsonl, one line of JSON per run."""
import collections
import json
import pathlib
import time

from icesoc.util.files import write

KEPT_RUNS = 300
HISTORY = pathlib.Path("build/regress/history.jsonl")


class History:
    """The stored runs. The list `ends` of a run has an entry [name, how, seconds, print, seed] for
    each test and seed, failures last. `how` is "p" (passed), "f" (failed) or "s" (skipped); `print`
    is the fingerprint of the test."""

    def __init__(self, path=HISTORY, costs=None):
        """`costs`: a file in the format of CTestCostData.txt, for `usual`."""
        self.path, self.runs, self.damaged = path, [], 0
        lines = costs.read_text().splitlines() if costs and costs.exists() else []
        self.costs = {name: [float(seconds)] for name, _, seconds in map(str.split, lines)}
        for line in path.read_text(errors="replace").splitlines() if path.exists() else []:
            try:
                run = json.loads(line)
                self.runs += [run] if run["ends"] else []
            except (ValueError, KeyError, TypeError):
                self.damaged += 1
        self._index()

    def _index(self):
        self.ends = collections.defaultdict(list)  # name of a test -> [(end, run)], newest last
        for run in self.runs:
            for name, *end in run["ends"]:
                self.ends[name].append((end, run))

    def add(self, run):
        """Adds a run, and rewrites the file atomically."""
        self.runs = (self.runs + [run])[-KEPT_RUNS:]
        self._index()
        write(self.path, "".join(json.dumps(each, separators=(",", ":")) + "\n"
                                 for each in self.runs))

    def last(self, name):
        """Returns how a test ended in the newest run that included it, or ""."""
        return self.ends[name][-1][0][0] if self.ends[name] else ""

    def now(self, test, seed=None):
        """Returns how a test ended in its last run with the current sources and, if given, with
        this seed. Without such a run, returns "f" if the test failed in its last run, otherwise
        ""."""
        return next((end[0] for end, _ in reversed(self.ends[test.name])
                     if end[2] == test.print and seed in (None, end[3])),
                    "f" if self.last(test.name) == "f" else "")

    def last_pass(self, name):
        """Returns (end, run) of the newest run in which a test passed, or None."""
        return next((each for each in reversed(self.ends[name]) if each[0][0] == "p"), None)

    def seconds(self, name):
        """Returns the duration of a test in s, from the newest run that included it; None without
        such a run."""
        return self.ends[name][-1][0][1] if self.ends[name] else None

    def usual(self, name):
        """Returns the usual duration of a test in s. It is the longest duration of a passing run,
        but at least the value in tests/costs.txt, because the history also contains runs that only
        printed a stored result. Returns None if neither is known."""
        times = [end[1] for end, _ in self.ends[name] if end[0] == "p"]
        return max([*times, *self.costs.get(name, [])], default=None)

    def flaky(self):
        """Returns the tests that both passed and failed with the same fingerprint and seed."""
        names = []
        for name, ends in sorted(self.ends.items()):
            how = collections.defaultdict(set)
            for end, _ in ends:
                how[tuple(end[2:])].add(end[0])
            names += [name] * any({"p", "f"} <= each for each in how.values())
        return names

    def failing(self, tests):
        """Returns the seeds with which these tests have failed, as {(test, seed): {"test", "seed",
        "since" (seconds, Unix), "commit", "times" (how often it failed)}}. A seed is left out if
        the test has passed with it after the failure, or if the last run with this seed and the
        current sources passed."""
        known, found = {test.name: test for test in tests}, {}
        for run in self.runs:
            for name, how, _, _, seed in run["ends"]:
                if how == "p":
                    found.pop((name, seed), None)
                elif how == "f":
                    entry = found.setdefault((name, seed), {
                        "test": name, "seed": seed, "since": run["time"], "commit": run["commit"],
                        "times": 0})
                    entry["times"] += 1
        return {key: entry for key, entry in sorted(found.items())
                if key[0] in known and self.now(known[key[0]], key[1]) != "p"}


def make_run(tests, results, commit, seconds):
    prints = {test.name: test.print for test in tests}
    ends, counts = [], {"passed": 0, "failed": 0, "skipped": 0}
    for result in sorted(results, key=lambda result: result.status == "failed"):
        counts[result.status] += 1
        ends.append([result.name, result.status[0], result.seconds, prints.get(result.name, ""),
                     result.seed])
    return {"time": int(time.time()), "commit": commit, "seconds": seconds, "ends": ends, **counts}
