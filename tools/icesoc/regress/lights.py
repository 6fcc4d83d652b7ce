# SPDX-License-Identifier: MIT
"""lights: summarises a run in seven statuses: tests, proofs, plan, mutants, coverage, size, speed.
A status is green, red, or grey (not measured, or the sources have changed since). Each status is
computed from separate figures, so that one kind of bug turns only one status red."""
from icesoc.util.spelling import command
from icesoc.util.tree import tree_state


def light(name, state, text):
    return {"name": name, "state": state, "text": text}


def missing(name, command):
    return light(name, "grey", f"not measured: {command}")


def judge(name, good, wrong, bad):
    """Returns a green status with the text `good` if the list `bad` is empty. Otherwise returns a
    red status with the first few entries of `bad`."""
    if not bad:
        return light(name, "green", good)
    return light(name, "red", f"{len(bad)} {wrong}: {', '.join(bad[:3])}{', ...' * (len(bad) > 3)}")


def of_tests(data, name):
    """Returns the status of the tests. Rows of `results` are [name, status, ...]; proofs are the
    tests named formal.*"""
    rows = [r for r in data["results"] if r[0].startswith("formal.") == (name == "proofs")]
    bad = [row[0] for row in rows if row[1] == "failed"]
    passed = sum(row[1] == "passed" for row in rows)
    if not bad and not passed:
        return missing(name, "none ran")
    if not bad and data["stopped"]:
        return light(name, "grey", f"stopped {data['stopped']}: {passed} passed")
    good = f"{passed} {'hold' if name == 'proofs' else 'passed'}"
    if kept := data["kept"][name]:
        good += f", {kept} of them as before, from unchanged files"
    if left := data["left"][name]:
        good += f", {left} did not run"
    return judge(name, good, "failed", bad)


def of_mutants(rows, drawn, source):
    """Returns the status of mutants. The scores of drawn mutants count only if the sources have not
    changed since the mutants were drawn."""
    tree = drawn.get("tree", "")
    if tree and tree_state(source, tree.split(":")[0]) == tree:
        if bad := [m for m, s in drawn["modules"].items() if s["score"] < drawn["gate"]]:
            return judge("mutants", "",
                         "modules with drawn mutants that proofs and tests miss", bad)
    if not rows:
        return missing("mutants", "./icesoc check mutants")
    return judge("mutants", f"{len(rows)} of {len(rows)} caught", f"of {len(rows)} not caught",
                 [row[0] for row in rows if row[1] != "caught"])


def below_gate(f):
    """Returns whether the coverage of a file (lines, cover points or toggles) is below its gate."""
    return f["value"] < f["limit"] or f.get("point_percent", 100) < f.get("point_gate", 0) or \
        bool(f.get("toggle_points", 0)) and f.get("toggles", 100) < f.get("toggle_gate", 0)


def of_coverage(coverage):
    if not coverage:
        return missing("coverage", "./icesoc check coverage")
    bad = [f["name"] for f in coverage["entries"] if below_gate(f)]
    return judge("coverage", f"{coverage['total']:.1f} % of lines, "
                 f"{coverage.get('toggles', 0):.1f} % of toggles, "
                 f"{coverage.get('points', 0)} of {coverage.get('points_total', 0)} cover points",
                 "files below their gate", bad)


def of_entries(name, entries, command):
    """Returns the status of the entries that have a limit. A limit is a minimum if the unit
    contains "at least", otherwise a maximum."""
    limits = [each for each in entries if "limit" in each]
    bad = []
    for each in limits:
        value, limit, least = each["value"], each["limit"], "at least" in each.get("unit", "")
        if value < limit if least else value > limit:
            bad.append(f"{each['name']} {value:g} (at {'least' if least else 'most'} {limit:g})")
    return judge(name, f"{len(limits)} figures within their limits", "beyond their limits", bad) \
        if limits else missing(name, command)


def of_size(utilisation):
    """Returns the status of size, from the result of `make synth`. Designs that failed turn it red;
    designs that were not measured with the current sources turn it grey."""
    if not utilisation:
        return missing("size", command("synth"))
    if utilisation["failures"]:
        return judge("size", "", "designs failed", utilisation["failures"])
    states = list(utilisation["states"].values())
    counts = [f"{states.count(state)} {state}" for state in ("changed since", "never measured here")
              if state in states]
    if counts:
        number, _, state = counts[0].partition(" ")
        text = ", ".join([f"{number} of {len(states)} designs {state}", *counts[1:]])
        return light("size", "grey", f"{text}: {command('synth')}")
    return of_entries("size", utilisation["entries"], command("synth"))


def of_plan(plan):
    bad = [each["text"] for each in plan if each["state"] == "failed"]
    proven = sum(each["state"] == "proven" for each in plan)
    if not bad and proven < len(plan):
        return light("plan", "grey", f"{proven} of {len(plan)} requirements of docs/ are proven; "
                     "tests of the others have not run with these sources")
    return judge("plan", f"{proven} requirements of docs/ are proven",
                 f"of {len(plan)} requirements of docs/ are not proven", bad)


def lights_of(data, source):
    """Returns the status lights for the data of report.py: [{name, state, text}]."""
    measured = [of_mutants(data["mutants"], data.get("drawn", {}), source),
                of_coverage(data.get("coverage")), of_size(data.get("utilisation")),
                of_entries("speed", data.get("speed", {"entries": []})["entries"],
                           "./icesoc bench")]
    for each in measured:  # a measurement records the state of the tree in which it was made
        tree = data["trees"].get(each["name"], "")
        if each["state"] != "grey" and tree_state(source, tree.split(":")[0]) != tree:
            each["text"] = f"sources have changed since it was {each['state']}: {each['text']}"
            each["state"] = "grey"
    return [of_tests(data, "tests"), of_tests(data, "proofs"),
            *([of_plan(data["plan"])] if data["plan"] else []), *measured]


def text_of(lights):
    return "".join(f"{each['name']:<9} {each['state']:<6} {each['text']}\n" for each in lights)
