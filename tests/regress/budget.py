# SPDX-License-Identifier: MIT
"""budget: the tests that are worth most within so many seconds."""
import re

from tests import may_match

LATELY = 10  # runs
SHORTEST = 0.02  # seconds: what a process costs that CTest calls 0.00


def within_budget(tests, seconds, jobs, build, history, plan):
    """First what failed lately, then what has not passed with these sources, then the rest; among
    each first what brings most per second of what none before it had: its program, its folder, its
    lines of the plan. A test costs what sets up its fixtures, too."""
    notes = build / "Testing/Temporary/CTestCostData.txt"  # "name runs seconds", up to "---"
    noted = dict(re.findall(r"^(\S+) \d+ (\S+)$", notes.read_text(), re.M)) if notes.exists() else {}

    def takes(test):
        return max(SHORTEST, history.seconds(test.name) or float(noted.get(test.name, 0)) or 1)
    lately = {name for run in history.runs[-LATELY:] for name, end in run["tests"].items()
              if end[0] == "f"}
    left, candidates = seconds * jobs, []
    for test in tests:
        cost = takes(test) + sum(takes(other) for other in tests for f in other.sets
                                 if f in test.needs)
        rank = 0 if test.name in lately else 2 if history.passed_with(test) else 1
        brings = {test.program, test.place} | {(each.text, pattern) for each in plan
                                               for pattern in each.patterns
                                               if may_match(pattern, test)}
        candidates.append((test, cost, rank, brings))
    chosen, had = [], set()
    while fitting := [each for each in candidates if each[1] <= min(left, seconds)]:
        # One that brings nothing new is not worthless.
        best = max(fitting, key=lambda each: (-each[2], (0.01 + len(each[3] - had)) / each[1]))
        candidates.remove(best)
        chosen.append(best[0])
        left -= best[1]
        had |= best[3]
    return chosen
