# SPDX-License-Identifier: MIT
"""report: writes the results of a run as a page and as JSON."""
import json
import pathlib
import re

from icesoc.mutants import results
from icesoc.regress.blocks import blocks_of
from icesoc.regress.lights import lights_of
from icesoc.regress.tests import judge_plan, read_plan
from icesoc.regress.waves import drawing_of
from icesoc.util import measured
from icesoc.util.errors import Stop
from icesoc.util.files import write
from icesoc.util.tree import read_state
from icesoc.web.page import filled, page_parts, script_safe

HERE = pathlib.Path(__file__).resolve().parent
LARGEST = 2_000_000  # largest size of the page, bytes
MEASURED = {"coverage": "coverage/summary.json", "utilisation": "synth/report.json",
            "speed": "bench/simulator.json"}


def read(path):
    """Returns measurements; None if there are none, or if an earlier version wrote the file."""
    try:
        found = measured.read(path)
    except Stop:
        return None
    return found if "entries" in found else None


def proofs_of(results):
    """Returns a row for each proof: [name, status, clocks of a bounded proof, text after "proven",
    number of covers reached, s]. The logs contain lines such as "X: proven, 47 clauses with 33
    flops" and "X: 2 covers reached"."""
    def said(log, what):
        return (re.search(what, log) or ["", "-"])[1]
    return [[r.name[7:], r.status, said(r.log, "bounded, ([0-9]+) clocks"),
             said(r.log, "proven[,]? *([^\n]*)"), said(r.log, "([0-9]+) covers reached"), r.seconds]
            for r in results if r.name.startswith("formal.")]


def measurements(build):
    """Returns the results that other commands have stored in build/, with the state of the tree at
    the time of each measurement."""
    data = {name: found for name, path in MEASURED.items() if (found := read(build / path))}
    # the page lists at most 40 uncovered places of a file; coverage/summary.json has all of them
    for file in data.get("coverage", {}).get("entries", []):
        if (more := len(file["missed"]) - 40) > 0:
            file["missed"][40:] = [f"and {more} more"]
    planted = results.read(build / "mutants/planted.xml")[1]
    data["mutants"] = [[m.name, m.result, m.test, m.seconds, m.place] for m in planted]
    run, drawn = results.read(build / "mutants/drawn.xml")
    if drawn:
        data["drawn"] = {**run, "gate": results.GATE, "modules": results.scores(drawn),
                         "survived": [{"line": m.place, "does": m.more["does"], "proof": m.test}
                                      for m in drawn if m.result == "SURVIVED"]}
    trees = {"mutants": "mutants", "coverage": "coverage", "size": "synth", "speed": "bench"}
    data["trees"] = {name: state for name, folder in trees.items()
                     if (state := read_state(build / folder))}
    return data


def gather(history, tests, results, failures, source):
    data = {**history.runs[-1], **measurements(source / "build"), "flaky": history.flaky(),
            "proofs": proofs_of(results)}
    del data["ends"]
    known = {test.name: test for test in tests}
    # (test, seed) pairs of this run; the list of failing seeds omits them, because the results
    # already contain their failures
    now = {(r.name, r.seed) for r in results}
    data["seeds"] = [kept for test, kept in history.failing(tests).items()
                     if test not in now or len({r.seed for r in results}) > 1]
    data["results"] = []
    for r in results:
        test = known.get(r.name)
        ends = [end[:2] for end, _ in history.ends[r.name][-10:]]  # the last entry is the newest
        data["results"].append([r.name, r.status, r.seconds, test.place if test else "",
                                test.labels[0] if test and test.labels else "", r.seed, ends])
    ran = {r.name for r in results}
    names = {"left": [name for name in known if name not in ran],
             "kept": [r.name for r in results if r.log.startswith("kept: cached result")]}
    for what, all_names in names.items():
        proofs = sum(name.startswith("formal.") for name in all_names)
        data[what] = {"tests": len(all_names) - proofs, "proofs": proofs}
    data["failures"] = [{"name": f.result.name, "tail": f.result.log[-3000:], "drawing": None, **{
        name: getattr(f, name) for name in ("bucket", "reason", "repeat", "log", "wave", "save",
                                            "place", "changed", "clock")}} for f in failures]
    data["history"] = [[run["time"], run["commit"], run["passed"], run["failed"], run["seconds"],
                        run.get("subject", ""), reasons_of(run)] for run in history.runs[-60:]]
    data["plan"] = judge_plan(read_plan(source), tests, history)
    data["lights"] = lights_of(data, source)
    data["blocks"] = blocks_of(data, tests, history, source)
    return data


def reasons_of(run):
    """Returns the reasons why a run in the history is not green: that it was stopped, and its
    failures."""
    stopped = run.get("stopped")
    return [*([f"stopped {stopped}"] if stopped else []), *run.get("reasons", [])]


def write_reports(data, failures, libraries, out):
    style, script = page_parts(libraries)
    # number of bytes that the drawings may take on the page
    rest = LARGEST - len(style) - len(script) - len(json.dumps(data)) - 60_000
    drawn = [i for i, failure in enumerate(failures) if failure.wave]
    for i in drawn:
        data["failures"][i]["drawing"] = drawing_of(failures[i], max(0, rest) // len(drawn))
    page = (HERE / "page.html").read_text()
    write(out / "report.html", filled(page, {"/*COMMON*/": style, "//COMMON": script,
                                             "/*DATA*/null": script_safe(data)}))
    write(out / "report.json", json.dumps(data, indent=1))
