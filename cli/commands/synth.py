# SPDX-License-Identifier: MIT
"""synth: utilisation of the chip, and its changes between commits."""
import contextlib
import json
from pathlib import Path

from cli.build_folder import configured
from cli.command import DEFAULTS, GROUPS, command
from cli.options import BUILD, JOBS, TEXT, WORDS, Option
from cli.runner import Stop, commit, lock, logged, output, run, warn

GROUPS["synth"] = "utilisation of the chip"
DEFAULTS["synth"] = "synth report"
DESIGN = Option("design", WORDS,
                "these designs only, such as modem, table1 or soc; of the others what is known")
GIT = ["git", "-c", "advice.detachedHead=false"]


def with_name(option, names):
    return [word for name in names for word in (option, name)]


def utilisation(build, values, *words):
    return run([build / "synth/utilisation", "--generated", build / "gen", "--jobs", values.jobs,
                *words], check=False)


@command("synth report", [
    DESIGN,
    Option("family", WORDS, "these chips, too, such as xc7 or ecp5"),
    Option("base", TEXT, "a commit: and what has changed since, as Markdown; COMMIT..COMMIT or "
           "COMMIT..: only what has changed between these, or until the last report", ""),
    BUILD, JOBS], make="synth", brief="synth report --design npi_arbiter",
         long="synth report", examples=[
             "synth report --design modem", "synth report --family xc7 ecp5",
             "synth report --base main..mine"])
def synth(values):
    """LUTs, flip-flops, slices of the chip and each part, against limits and paper"""
    first, between, last = values.base.partition("..")
    commits = [commit(name) for name in (first, last) if name]
    build = configured(values, "synth_inputs", tests=True)
    status = 0
    if not between:
        status = utilisation(build, values, *with_name("--design", values.design),
                             *with_name("--family", values.family))
    if commits and status <= 1:  # 1: a design is beyond its budget
        compare(build, values.jobs, *commits)
    return status


@command("synth accept", [DESIGN, BUILD, JOBS], make="synth-accept", examples=[
    "synth accept --design modem"], brief="synth accept --design npi_arbiter")
def accept(values):
    """record today's utilisation as what is wanted (synth/baseline.json)"""
    return utilisation(configured(values, "synth_inputs"), values, "--accept",
                       *with_name("--design", values.design))


@command("synth edif", [Option("design", TEXT, "the design", "soc"), BUILD, JOBS],
         make="synth-edif", brief="synth edif --design npi_arbiter")
def edif(values):
    """the chip as EDIF for Xilinx ISE, in build/synth/ise"""
    build = configured(values, "synth_inputs")
    return run([build / "synth/utilisation", "--generated", build / "gen", "--edif", values.design],
               check=False)


def synthesise(program, jobs, base, folder):
    """Builds and synthesises a commit in its own checkout; this one does not change."""
    folder = folder.absolute()
    if (folder / ".git").exists():
        run([*GIT, "-C", folder, "checkout", "-q", "--detach", base])
    else:
        run([*GIT, "worktree", "add", "-q", "--detach", folder, base])
    warn(f"building what {named(base)} synthesises ...")
    failed = f"{base} does not build"
    if not (folder / "build/main/build.ninja").exists():
        logged(["cmake", "-S", folder, "-B", folder / "build/main", "-G", "Ninja"],
               folder / "build.log", failed)
    logged(["ninja", "-C", folder / "build/main", "-j", jobs, "synth_inputs"], folder / "build.log",
           failed)
    (folder / "build/synth").mkdir(parents=True, exist_ok=True)
    cache = folder / "build/synth/cache"
    with contextlib.suppress(FileNotFoundError):
        cache.unlink()
    cache.symlink_to(
        Path("build/synth/cache").absolute())  # designs that both have are synthesised once
    with open(folder / "build.log", "w") as log:
        # Status 1: that commit is beyond its own budget, which does not matter here.
        if run([program, "--jobs", jobs], check=False, cwd=folder, stdout=log) > 1:
            raise Stop(status=2)


def named(base):
    return output([*GIT, "log", "-1", "--format=%h (%s)", base]).strip()


def row(name):
    """The commit's name in the regression, its kept run with most tests, and its coverage."""
    def kept(file):
        path = Path("build", file)
        return path.read_text().splitlines() if path.exists() else []

    runs = [
        each for each in map(json.loads, kept("regress/history.jsonl")) if each["commit"] == name]
    best = max(runs, key=lambda each: each["passed"] + each["failed"], default=None)
    covered = [
        line.split(" ", 1)[1] for line in kept("coverage/history") if line.startswith(name + " ")]
    tests = f"{best['passed']} passed, {best['failed']} failed" if best else "not measured"
    return f"| {name} | {tests} | {covered[-1] if covered else 'not measured'} |"


def compare(build, jobs, base, head=None):
    """The changes since a commit, or between two, with tests and coverage, as Markdown for a pull
    request."""
    program, folder = (build / "synth/utilisation").absolute(), Path("build/synth")
    folder.mkdir(parents=True, exist_ok=True)
    with lock(folder / "base.lock", busy="waiting for another comparison in this folder ..."):
        run([*GIT, "worktree", "prune"])
        synthesise(program, jobs, base, folder / "base")
        after = folder
        if head:
            synthesise(program, jobs, head, folder / "head")
            after = folder / "head/build/synth"
        lines = [
            f"Utilisation since {named(base)}{f', at {named(head)}' if head else ''}:", "",
            output([
                program, "--output", after, "--compare",
                folder / "base/build/synth/report.json"]).rstrip("\n"), "",
            "| commit | tests | coverage |", "|---|---|---|",
            *(row(output([*GIT, "describe", "--always", "--abbrev=10", *which]).strip())
              for which in ([base], [head or "--dirty=+"]))]
        text = "\n".join(lines) + "\n"
        (folder / "compare.md").write_text(text)
        print(text, end="")
    return 0
