# SPDX-License-Identifier: MIT
"""synth: commands that report the utilisation of the chip and the registers of its blocks, and the
changes of both between commits."""
import contextlib
import subprocess
from pathlib import Path

from icesoc.cli import choices
from icesoc.cli.build_folder import configured
from icesoc.cli.command import DEFAULTS, GROUPS, command
from icesoc.cli.options import BUILD, CORE_FOLDERS, FILE, FOLDER, JOBS, TEXT, WORDS, Option
from icesoc.regress.history import History
from icesoc.util.console import warn
from icesoc.util.errors import Stop
from icesoc.util.files import write
from icesoc.util.lock import lock
from icesoc.util.process import logged, output, run, tool
from icesoc.util.tree import commit

GROUPS["synth"] = "synthesis: LUTs, flip-flops, clock"
DEFAULTS["synth"] = "synth report"
GROUPS["contract"] = "compare registers with an earlier commit, import SystemRDL"
SHOWN = 10  # number of tests listed in one line of the report for a pull request
DESIGN = Option("design", WORDS,
                "designs to measure, such as modem, table1 or soc; for all other designs, the "
                "report shows the last figures", choices=choices.designs)
DIFF = tool("chip.contract_diff")
GIT = ["git", "-c", "advice.detachedHead=false"]


def with_name(option, names):
    return [word for name in names for word in (option, name)]


def utilisation(build, values, *words):
    return run([build / "synth/utilisation", "--generated", build / "gen", "--jobs", values.jobs,
                *words], check=False)


@command("synth report", [
    DESIGN,
    Option("family", WORDS, "additional FPGA families, such as xc7 or ecp5"),
    Option("base", TEXT, "commit to compare with; prints Markdown. 'COMMIT1..COMMIT2' prints "
                         "only the differences between two commits; 'COMMIT..' prints those "
                         "between COMMIT and the last report", ""),
    CORE_FOLDERS, BUILD, JOBS], make="synth", brief="synth report --design npi_arbiter",
         long="synth report", examples=[
             "synth report --design modem", "synth report --family xc7 ecp5",
             "synth report --base main..mine"])
def synth(values):
    """report LUTs, flip-flops, slices and clock of the chip and each part

    Uses Yosys to synthesise every design that has changed. Compares the figures with the baseline,
    with the limits in synth/designs.json and with the paper. Writes build/synth/report.html.
    """
    first, between, last = values.base.partition("..")
    commits = [commit(name) for name in (first, last) if name]
    build = configured(values, "synth_inputs", *["slice2c"] * bool(commits), tests=True)
    status = 0
    if not between:
        status = utilisation(build, values, *with_name("--design", values.design),
                             *with_name("--family", values.family))
    if commits and status <= 1:  # status 1: a design exceeds its budget
        compare(build, values.jobs, *commits)
    return status


@command("synth accept", [DESIGN, BUILD, JOBS], make="synth-accept", examples=[
             "synth accept",
             "synth accept --design modem",
             "synth accept --design modem fir"], brief="synth accept --design npi_arbiter")
def accept(values):
    """accept the current utilisation as baseline (synth/baseline.json)

    Later reports compare with the baseline, and fail if a design grows beyond it. Commit the
    file with the change that explains the growth.
    """
    return utilisation(configured(values, "synth_inputs"), values, "--accept",
                       *with_name("--design", values.design))


@command("synth edif", [Option("design", TEXT, "design to export", "soc",
                             choices=choices.designs), BUILD, JOBS],
         make="synth-edif", brief="synth edif --design npi_arbiter",
         examples=[
             "synth edif",
             "synth edif --design modem",
             "synth edif --build build/other"])
def edif(values):
    """write the chip as EDIF for Xilinx ISE (build/synth/ise)

    Also writes the netlist as Verilog into this folder. docs/utilisation.md describes how to make
    a bitstream from these files.
    """
    build = configured(values, "synth_inputs")
    return run([build / "synth/utilisation", "--generated", build / "gen", "--edif", values.design],
               check=False)


def synthesise(program, jobs, base, folder):
    """Builds and synthesises a commit in a separate checkout; the current checkout is not
    changed."""
    folder = folder.absolute()
    if (folder / ".git").exists():
        run([*GIT, "-C", folder, "checkout", "-q", "--detach", base])
    else:
        run([*GIT, "worktree", "add", "-q", "--detach", folder, base])
    warn(f"building the files needed to synthesise {named(base)} ...")
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
        # both checkouts share the cache, so a design that is equal in both is synthesised only once
        Path("build/synth/cache").absolute())
    with open(folder / "build.log", "w") as log:
        # Status 1 means that the commit exceeds its budget, which does not matter here.
        if run([program, "--jobs", jobs], check=False, cwd=folder, stdout=log) > 1:
            raise Stop(status=2)


def named(base):
    return output([*GIT, "log", "-1", "--format=%h (%s)", base]).strip()


def tests_of(names):
    """Returns lines that compare the test results of two commits. The counts for a commit are from
    the run of this commit with the most tests in the history. The last lines list the tests with
    different results."""
    kept = History().runs
    runs = [max((each for each in kept if each["commit"] == name), default={},
                key=lambda each: each["passed"] + each["failed"]) for name in names]
    lines = ["| commit | tests |", "|---|---|"]
    for name, best in zip(names, runs):
        tests = f"{best['passed']} passed, {best['failed']} failed" if best else "not measured"
        lines.append(f"| {name} | {tests} |")
    then, now = ({end[0]: end[1] for end in run.get("ends", [])} for run in runs)
    if then and now:
        for text, some in (
            ("fail now", [test for test in now if now[test] == "f" != then.get(test)]),
            ("pass again", [test for test in now if now[test] == "p" and then.get(test) == "f"]),
            ("new", now.keys() - then.keys()), ("did not run", then.keys() - now.keys())):
            if some:
                more = f" and {len(some) - SHOWN} more" if len(some) > SHOWN else ""
                lines += ["", f"Tests that are {text}" if text == "new" else f"Tests that {text}"]
                lines[-1] += f": {', '.join(sorted(some)[:SHOWN])}{more}"
    return lines


def compare(build, jobs, base, head=None):
    """Returns the changes of utilisation, registers and tests since a commit, or between two, as
    Markdown for a pull request."""
    program, folder = (build / "synth/utilisation").absolute(), Path("build/synth")
    with lock(folder / "base.lock", busy="waiting for another comparison in this folder ..."):
        run([*GIT, "worktree", "prune"])
        synthesise(program, jobs, base, folder / "base")
        after = folder
        if head:
            synthesise(program, jobs, head, folder / "head")
            after = folder / "head/build/synth"
        registers = subprocess.run(  # status 1: a change breaks existing software
            [*DIFF, build / "slice/slice2c", folder / "base", folder / "head" if head else "."],
            stdout=subprocess.PIPE, text=True).stdout
        lines = [
            f"Utilisation since {named(base)}{f', at {named(head)}' if head else ''}:", "",
            output([
                program, "--output", after, "--compare",
                folder / "base/build/synth/report.json"]).rstrip("\n"), "",
            "Registers:", "", "```", registers.rstrip("\n"), "```", "",
            *tests_of([
                output([*GIT, "describe", "--always", "--abbrev=10", which]).strip()
                for which in (base, head or "--dirty=+")])]
        text = "\n".join(lines) + "\n"
        write("build/summary.md", text)
        print(text, end="")
    return 0


@command("contract diff",
         [Option("base", TEXT, "commit to compare with", "", positional=True), BUILD, JOBS],
         make="contract-diff", brief="contract diff HEAD", examples=[
             "contract diff main",
             "contract diff HEAD~1",
             "contract diff HEAD --build build/other"])
def contract_diff(values):
    """list changes of the cores' registers since a commit

    Compares the registers of all cores in the chip with the registers at another commit. Exit
    status 1: software for that commit would not work with these registers.
    """
    if values.base:
        commit(values.base)
    build = configured(values, "slice2c")
    return run([*DIFF, build / "slice/slice2c", ".", values.base], check=False)


@command("contract from-rdl", [Option("rdl", FILE, "SystemRDL file", "", positional=True),
                               Option("out", FOLDER, "output folder", "")],
         make="from-rdl", brief="contract from-rdl build/main/gen/icesoc.rdl --out build/brief/rdl",
         examples=[
             "contract from-rdl spi.rdl --out ip/spi",
             "contract from-rdl ../regs/uart.rdl --out ip/uart",
             "contract from-rdl build/main/gen/icesoc.rdl --out /tmp/regs"])
def from_rdl(values):
    """convert SystemRDL into register descriptions (*.regs.json)

    Reads a flat subset of SystemRDL 2.0: addrmap, reg, field and their properties, without
    parameters and expressions. Error messages contain file and line.
    """
    if not values.rdl or not values.out:
        raise Stop("from-rdl: expected a SystemRDL file and an output folder: ./icesoc contract "
                   "from-rdl spi.rdl --out ip/spi", 2)
    return run([*tool("regs.rdl"), values.rdl, values.out], check=False)
