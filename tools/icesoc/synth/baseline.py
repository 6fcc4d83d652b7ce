# SPDX-License-Identifier: MIT
"""baseline: the accepted figures of all designs (synth/baseline.json), the growth of each design
since then, and the state of each design (see STATES)."""
import json
import subprocess

from icesoc.synth import timing
from icesoc.synth.owners import Cost
from icesoc.synth.sources import read_json
from icesoc.util import measured
from icesoc.util.errors import Stop, reason_of
from icesoc.util.files import write

KEYS = ("lut", "ff", "slices", "carry", "dsp", "ram", "mhz")
NAMED_CHANGES = 6

MEASURED, ACCEPTED, CHANGED, NEVER = STATES = (
    # the figures of the current sources are known, from this run or from the cache
    measured.NOW,
    # not measured in this build folder, but the accepted figures belong to the current sources
    "as accepted",
    "changed since",        # not measured with the current sources, only with other ones
    # never measured here, and the sources of accepted figures are unknown
    "never measured here")


def state_of(run, source_hash, accepted):
    if run.figures or run.wanted:
        return MEASURED
    if accepted and accepted["sources"] == source_hash:
        return ACCEPTED
    return CHANGED if run.known or (accepted and accepted["sources"]) else NEVER


def lut_budget(accepted):
    return accepted + accepted * 3 // 100 + 4


def ff_budget(accepted):
    return accepted + accepted // 100 + 2


def short_version(yosys):
    return " ".join(yosys.split()[:2])


def clock_text(mhz):
    """Returns a clock frequency in MHz as text, rounded as on the terminal, on the page and in the
    accepted figures."""
    return f"{mhz:.1f}"


def accepted_from(figures, sources=""):
    accepted = {key: figures[key] for key in KEYS} | {"mhz": round(figures["mhz"], 1)}
    return accepted | {"sources": sources, "costs": figures["costs"]}


def parse(j):
    """Returns {"yosys", "designs": {name: accepted figures}}; raises an exception if the file is
    malformed."""
    designs = {}
    for name, d in j["designs"].items():
        costs = {path: {signal: Cost(lut=c[0], ff=c[1], **dict(zip(("ram", "dsp"), c[2:])))
                        for signal, c in signals.items()} for path, signals in d["signals"].items()}
        designs[name] = {key: d[key] for key in KEYS} | {"sources": d.get("sources", ""),
                                                         "costs": costs}
    return {"yosys": j["yosys"], "designs": designs}


def read_baseline(file):
    if not file.exists():
        return {"yosys": "", "designs": {}}
    j = read_json(file)
    try:
        return parse(j)
    except (KeyError, TypeError, AttributeError) as error:
        raise Stop(f"{file}: expected accepted figures: {reason_of(error)}") from None


def written(baseline):
    """Returns the text of the file. Each instance has one line, so that differences between commits
    are readable."""
    def compact(value):
        return json.dumps(value, separators=(",", ":"))

    designs = []
    for name, a in sorted(baseline["designs"].items()):
        lines = []
        for path, signals in sorted(a["costs"].items()):
            kept = {signal: [c.lut, c.ff] + [c.ram, c.dsp] * bool(c.ram or c.dsp)
                    for signal, c in sorted(signals.items()) if c.lut or c.ff or c.ram or c.dsp}
            if kept:
                lines.append(f"\n {json.dumps(path)}: {compact(kept)}")
        head = "".join(f'"{key}": {a[key]:g}, ' for key in KEYS)
        designs.append(f'\n{json.dumps(name)}: {{{head}"sources": "{a["sources"]}", '
                       f'"signals": {{{",".join(lines)}}}}}')
    yosys = json.dumps(baseline["yosys"])
    return f'{{\n"yosys": {yosys},\n"designs": {{{",".join(designs)}}}\n}}\n'


def accept(report, file):
    """Replaces the accepted figures of the measured designs, keeps the figures of others (unless
    another version of Yosys has measured them), and drops designs that no longer exist. Rejects
    figures above a limit of synth/designs.json; a limit can only be changed there."""
    old = report.baseline
    # Figures of two versions of Yosys are not comparable.
    same = short_version(old["yosys"]) == short_version(report.yosys)
    designs = {}
    for row in report.rows:
        name = row.design.name
        if not row.main.wanted:
            if same and name in old["designs"]:
                designs[name] = old["designs"][name]
            continue
        if row.main.error:
            raise Stop(f"{name} failed, so no figures were accepted")
        above = above_limits(row)
        if above:
            raise Stop(f"{above[0]}, so no figures were accepted; limits are in synth/designs.json")
        designs[name] = accepted_from(row.figures, row.sources)
    write(file, written({"yosys": report.yosys, "designs": designs}))
    print(f"Accepted: {file}; commit it.")


def by_instance(costs):
    return {path: sum(signals.values(), Cost()) for path, signals in costs.items()}


def by_signal(costs):
    return {f"{path}.{signal}" if path else signal: cost
            for path, signals in costs.items() for signal, cost in signals.items()}


def changes(before, after):
    """Returns (name, additional LUTs, additional flip-flops) for each change, largest growth
    first."""
    names = sorted({*before, *after})
    rows = [(name, after.get(name, Cost()).lut - before.get(name, Cost()).lut,
             after.get(name, Cost()).ff - before.get(name, Cost()).ff) for name in names]
    return sorted((row for row in rows if row[1] or row[2]), key=lambda row: -row[1] - row[2])


def grown(title, changed):
    """Returns a title and a line for each of the first changes that is a growth; an empty text if
    nothing grew."""
    lines = []
    for name, luts, ffs in changed[:NAMED_CHANGES]:
        if luts + ffs > 0:
            parts = [f"{n:+d} {kind}" for n, kind in ((luts, "LUT"), (ffs, "FF")) if n]
            lines.append(f"\n      {name or 'the top itself'} {', '.join(parts)}")
    return "".join([f"\n    {title}", *lines]) if lines else ""


def above_limits(row):
    """Returns one sentence for each limit of synth/designs.json that is exceeded."""
    return [f"{row.design.name}: {row.figures[key]} {key}, {row.figures[key] - limit} above the "
            f"limit of {limit}" for key, limit in row.design.limits.items()
            if row.figures[key] > limit] + [
        f"{row.design.name}: {ns:.2f} ns from a pad to {port}; the limit is {limit} ns (-2)"
        for port, limit in row.design.pads.items()
        if (ns := timing.SLOW_GRADE * timing.slowest_pad(row.figures["timing"]["pads"], port))
        > limit]


def judge(row, baseline, yosys, goal):
    """Returns (failures, notes) of a design. It may exceed its accepted figures by a margin,
    because the results of optimisation vary: 3 % + 4 LUTs, 1 % + 2 flip-flops. It must never exceed
    the limits of synth/designs.json. If the accepted clock reaches `goal` (MHz), the clock must
    still reach it; a lower accepted clock may fall by a tenth."""
    name, f = row.design.name, row.figures
    if row.main.error:
        return ([f"{name}: synthesis failed"] if row.main.wanted else []), []
    failures = [f"{name}: synthesis for {other.family} failed" for other in row.others
                if other.wanted and other.error]
    # Versions of Yosys give different figures. A design is therefore only judged if the same
    # version measured the accepted figures; otherwise exceeded limits are notes.
    comparable = short_version(baseline["yosys"]) in ("", short_version(yosys))
    if not comparable:
        return failures, [f"{text} (by another Yosys than the limit was set with)"
                          for text in above_limits(row)]
    failures += above_limits(row)
    a = baseline["designs"].get(name)
    if not a:
        return failures, []
    budgets = lut_budget(a["lut"]), ff_budget(a["ff"])
    if f["lut"] > budgets[0] or f["ff"] > budgets[1]:
        failures.append(
            f"{name}: {f['lut']} LUT, {f['ff']} FF; accepted were {a['lut']} and {a['ff']}, "
            f"the budget is {budgets[0]} and {budgets[1]}"
            + grown("modules that grew:", changes(by_instance(a["costs"]), by_instance(f["costs"])))
            + grown("signals that grew:", changes(by_signal(a["costs"]), by_signal(f["costs"]))))
    least = goal if a["mhz"] >= goal else 0.9 * a["mhz"]
    if 0 < f["mhz"] < least:
        path = f["timing"]["paths"][0]
        failures.append(f"{name}: {f['mhz']:.1f} MHz; accepted were {a['mhz']:g}, the least is "
                        f"{least:g}\n    the longest path:\n      {path['from']} to {path['to']} "
                        f"{path['pin']}, {path['levels']} levels")
    return failures, []


def git(source, *words):
    """Returns the output of git, or "" if git fails or is missing."""
    try:
        done = subprocess.run(["git", "-C", source, *words], text=True, stdout=subprocess.PIPE,
                              stderr=subprocess.DEVNULL)
    except OSError:
        return ""
    return done.stdout if done.returncode == 0 else ""


def history(source, count=30):
    """Returns the commits that changed synth/baseline.json, newest first: {"id", "date", "subject",
    "designs": {name: {key: figure}}}."""
    commits = []
    lines = git(source, "log", f"-n{count}", "--format=%h%x09%cs%x09%s", "--",
                "synth/baseline.json")
    for line in lines.splitlines():
        id, date, subject = line.split("\t", 2)
        try:
            text = git(source, "show", f"{id}:synth/baseline.json")
            designs = {name: {key: design[key] for key in KEYS}
                       for name, design in json.loads(text)["designs"].items()}
        except (ValueError, LookupError, TypeError, AttributeError):
            continue  # the file has another format or was removed, so this commit is left out
        if designs:
            commits.append({"id": id, "date": date, "subject": subject, "designs": designs})
    return commits


def current_commit(source):
    """Returns the current commit such as "1a2b3c4", followed by "+" if the tree has uncommitted
    changes; "" without git."""
    id = git(source, "rev-parse", "--short", "HEAD").strip()
    return id and id + "+" * bool(git(source, "status", "--porcelain", "--untracked-files=no"))
