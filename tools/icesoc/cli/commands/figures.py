# SPDX-License-Identifier: MIT
"""build figures: measures the figures that README.md and docs/ show, and writes them and their
pictures into the pages."""
import re
import shutil
from pathlib import Path

from icesoc.cli import choices
from icesoc.cli.command import command
from icesoc.cli.options import WORDS, Option
from icesoc.mutants import run as mutants
from icesoc.site import figures
from icesoc.util import measured
from icesoc.util.console import say
from icesoc.util.errors import Stop
from icesoc.util.process import run

STEPS = ["bench", "synth", "regress", "pictures", "pages"]
# Seeded fault that the picture of the regression page shows, and the expression that selects the
# tests of this regression.
FAULT, FOUND_BY = "fsmc/lanes_ignored", r"fsmc_(post|memory)$|^test_fsmc_bridge"
TREE = Path("build/figures/tree")
REPORT = Path("build/synth/report.json")


@choices.expecting("a step")
def steps(values=None):  # pylint: disable=unused-argument
    return STEPS


def regress_with_fault():
    """Runs tests of the FSMC bridge on a copy of the tree with a seeded fault."""
    mutants.prepare(TREE)
    fault, = mutants.bugs(FAULT)
    planted = fault.planted(TREE)
    for file, text in planted.items():
        shutil.copy2(TREE / file, f"{TREE / file}.orig")
        (TREE / file).write_text(text)
    try:
        run(["./icesoc", "regress", "--name", FOUND_BY], cwd=TREE, check=False)
    finally:
        for file in planted:
            mutants.restore(TREE / file)


def whole_report(report=REPORT):
    """Returns a report of the synthesis. Raises Stop if it is missing, or if it lacks figures of
    some designs for the current sources, as the report of a single design may."""
    remedy = "run ./icesoc synth, or add the step synth"
    if not Path(report).exists():
        raise Stop(f"{report} not found; {remedy}")
    content = measured.read(report)
    states = content.get("states", {})
    if missing := [name for name, state in states.items() if state != measured.NOW]:
        listed = ", ".join(missing[:3]) + (f" and {len(missing) - 3} more" if missing[3:] else "")
        raise Stop(f"{report}: expected figures of all designs, measured with the current sources; "
                   f"those of {listed} are missing: {remedy}")
    return content


def figures_of_synth(report):
    """Returns {name: figure} for the LUT sites and slices of the designs of Table I, with the range
    of each."""
    found = {}
    entries = {entry["name"]: entry for entry in report["entries"]}
    for name, design in ("table1", "table1"), ("flown", "table1_flown"):
        for kind, low, high in ("sites", "low", "high"), ("slices", "less", "more"):
            if entry := entries.get(f"{design} {kind}"):
                first, last = re.search(r"(\d+)-(\d+)", entry["unit"]).groups()
                found |= {f"{name}.{kind}": str(entry["value"]), f"{name}.{low}": first,
                          f"{name}.{high}": last}
    return found


@command("build figures", [
    Option("steps", WORDS, f"steps to run: {', '.join(STEPS)}", STEPS, positional=True,
           choices=steps)], make="figures", brief="build figures pages",
         examples=[
             "build figures",
             "build figures synth pictures pages",
             "build figures pages"])
def build_figures(values):
    """make the figures and pictures of README.md and docs/ from one run

    Runs ./icesoc bench, ./icesoc synth accept and a regression with a seeded fault, takes pictures
    of their pages and of two flights, and writes the figures into the documentation. `make test
    NAME=tree.figures` compares pages and pictures with the measured figures.
    """
    if "pictures" in values.steps and "synth" not in values.steps:
        whole_report()
    for step in STEPS:
        if step not in values.steps:
            continue
        say(f"build figures: {step}")
        if step == "bench":
            run(["./icesoc", "bench"])
        elif step == "synth":
            run(["./icesoc", "synth", "accept"])
            run(["./icesoc", "synth", "report"])  # the page for the pictures
        elif step == "regress":
            regress_with_fault()
        elif step == "pictures":
            run(["./icesoc", "build", "pictures", "mission", "live", "utilisation"])
            if (TREE / "build/regress/report.html").exists():
                run(["./icesoc", "build", "pictures", "regression", "--from", TREE / "build"])
        else:
            try:
                synthesised = figures_of_synth(whole_report())
            except Stop as error:
                say(f"the figures from the synthesis report are unchanged: "
                    f"{error}")
                synthesised = {}
            for page in figures.correct(".", synthesised):
                say(f"{page}: figures updated")
            wrong = list(figures.differences("."))
            print("\n".join(wrong))
            return 1 if wrong else 0
    return 0
