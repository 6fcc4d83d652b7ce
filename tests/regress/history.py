# SPDX-License-Identifier: MIT
"""history: keeps the results of each run, a line of JSON a run, in history.jsonl, and in
seeds.jsonl the seeds that made tests fail, until the tests pass with them."""
import collections
import json
import time

from tool import write

KEPT_RUNS = 300


def lines_of(path, *keys):
    """The objects of a file, and the number of its damaged lines."""
    found, damaged = [], 0
    for line in path.read_text(errors="replace").splitlines() if path.exists() else []:
        try:
            found.append(json.loads(line))
            [found[-1][key] for key in keys]
        except (ValueError, KeyError, TypeError):
            found = [each for each in found if isinstance(each, dict) and keys[0] in each]
            damaged += 1
    return found, damaged


class History:
    """A run's `tests` are {name: [how, seconds, print, seed]}, how: "p", "f" or "s"."""

    def __init__(self, path):
        self.path = path
        self.runs, self.damaged = lines_of(path, "tests")
        self._index()

    def _index(self):
        self.ends = collections.defaultdict(list)  # of a test, the newest last: (end, run)
        for run in self.runs:
            for name, end in run["tests"].items():
                self.ends[name].append((end, run))

    def add(self, run):
        """Adds a run and writes the file anew, complete or not at all."""
        self.runs = (self.runs + [run])[-KEPT_RUNS:]
        self._index()
        write(self.path, "".join(json.dumps(each, separators=(",", ":")) + "\n"
                                 for each in self.runs))

    def last(self, name):
        """How a test ended in the newest run that had it, or ""."""
        return self.ends[name][-1][0][0] if self.ends[name] else ""

    def now(self, test):
        """How a test ended last with these sources; without such a run, "f" if it failed last."""
        return next((end[0] for end, _ in reversed(self.ends[test.name]) if end[2] == test.print),
                    "f" if self.last(test.name) == "f" else "")

    def last_pass(self, name):
        """(end, run) of the newest run in which a test passed, or None."""
        return next((each for each in reversed(self.ends[name]) if each[0][0] == "p"), None)

    def passed_with(self, test):
        """Whether a test's last pass was with these sources."""
        passed = self.last_pass(test.name)
        return bool(passed) and passed[0][2] == test.print

    def seconds(self, name):
        """Seconds that a test took in the newest run that had it, or None."""
        return self.ends[name][-1][0][1] if self.ends[name] else None

    def flaky(self):
        """Tests that both passed and failed with one fingerprint and one seed."""
        names = []
        for name, ends in sorted(self.ends.items()):
            how = collections.defaultdict(set)
            for end, _ in ends:
                how[tuple(end[2:])].add(end[0])
            names += [name] * any({"p", "f"} <= each for each in how.values())
        return names


def make_run(tests, results, commit, seconds):
    prints = {test.name: test.print for test in tests}
    ends, counts = {}, {"passed": 0, "failed": 0, "skipped": 0}
    for result in results:
        counts[result.status] += 1
        if ends.get(result.name, "p")[0] != "f":  # repeated: one failure counts
            ends[result.name] = [result.status[0], result.seconds, prints.get(result.name, ""),
                                 result.seed]
    return {"time": int(time.time()), "commit": commit, "seconds": seconds, "tests": ends, **counts}


class FailingSeeds:
    """[{"test", "seed", "since" (seconds, Unix), "commit", "times" (how often it failed)}]"""

    def __init__(self, path):
        self.path = path
        entries, _ = lines_of(path, "test", "seed", "times")
        self.kept = {(each["test"], each["seed"]): each for each in entries}

    def forget_others(self, tests):
        """Drops tests that are not in the list any more; returns their names."""
        names = {test.name for test in tests}
        gone = sorted({test for test, _ in self.kept if test not in names})
        self.kept = {key: each for key, each in self.kept.items() if key[0] in names}
        return gone

    def update(self, results, commit):
        """Adds failures, drops tests that passed with their seed, and writes the file anew."""
        for result in results:
            key = (result.name, result.seed)
            if result.status == "passed":
                self.kept.pop(key, None)
            elif result.status == "failed":
                entry = self.kept.setdefault(key, {
                    "commit": commit, "seed": result.seed, "since": int(time.time()),
                    "test": result.name, "times": 0})
                entry["times"] += 1
        write(self.path, "".join(json.dumps(each, separators=(",", ":"), sort_keys=True) + "\n"
                                 for each in self.list()))

    def list(self):
        return [self.kept[key] for key in sorted(self.kept)]

    def rounds(self, chosen):
        """(seed, tests) of each seed that made one of these tests fail."""
        for seed in sorted({seed for _, seed in self.kept}):
            if tests := [test for test in chosen if (test.name, seed) in self.kept]:
                yield seed, tests
