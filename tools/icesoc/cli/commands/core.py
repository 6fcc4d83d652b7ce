# SPDX-License-Identifier: MIT
"""core: commands that test, synthesise and inspect a core (docs/guides/core-test.md)."""
import dataclasses
import os
import re
import shutil
from pathlib import Path

from icesoc.cli import choices
from icesoc.cli.build_folder import BuildFolder
from icesoc.cli.command import GROUPS, command
from icesoc.cli.commands.synth import utilisation
from icesoc.cli.options import BUILD, CORE_FOLDERS, JOBS, SEED, SWITCH, TEXT, Option, matching
from icesoc.util import vcd
from icesoc.util.console import say, warn
from icesoc.util.errors import Stop, nearest
from icesoc.util.process import collect, output, run
from icesoc.util.spelling import option

GROUPS["core"] = "cores: create, test, view waveforms, remove"
CORE = Option("ip", matching(r"\w+", "the name of a core"), "name of the core", "", positional=True,
              choices=choices.cores)
CHIP = Option("chip", SWITCH,
              "synthesise the current chip (takes minutes); default: use the accepted figures")


def known(values, core_tests=False):
    """Returns the build folder that contains the core. With `core_tests`, a new folder is
    configured for the tests of cores only."""
    if not values.ip:
        raise Stop("expected the name of a core: ./icesoc core test fir", 2)
    build = BuildFolder(values.build, values).prepare(core_tests=core_tests)
    cores = build.known_cores()
    if not values.built and (values.ip not in cores or
                             not (build.core(values.ip) / "core.toml").is_file()):
        # CMake may not have found folders that were created or removed after its last run
        build.ninja("build.ninja")
        cores = build.known_cores()
    if values.ip not in cores:
        raise Stop(f"unknown core '{values.ip}': expected one of {' '.join(cores)}"
                   + nearest(values.ip, cores), 2)
    return build


@command("core test", [CORE, CORE_FOLDERS, SEED, BUILD, JOBS], make="ip-test",
         brief="core test fir", examples=[
             "core test fir",
             "core test fir --seed 7",
             "core test my_core --core-folders ~/my_core"])
def test(values):
    """build and test one core: its block test, and its VHDL under GHDL

    Builds only the targets that the tests of this core need. The core need not be in the chip.
    Exit status 8: a test failed.
    """
    core, build = values.ip, known(values, core_tests=True)
    build.ninja(f"tests_of_{core}")
    if core not in build.cached("TESTED_CORES").split(";"):
        raise Stop(f"{core} has no test: {core}_test.cpp not found in the core's folder")
    return build.ctest("--end-hangs", "-R", rf"^(test_ip_{core}[.]|{core}[.]vhdl$)",
                       tests=values.jobs, junit=f"junit-{core}.xml", SEED=values.seed)


@command("core synth", [CORE, CORE_FOLDERS, CHIP, BUILD, JOBS], make="ip-synth",
         brief="core synth fir", examples=[
             "core synth fir",
             "core synth fir --chip",
             "core synth my_core --core-folders ~/my_core"])
def synth(values):
    """report the utilisation of one core, and its cost in the chip

    Prints LUTs, flip-flops, block RAM and DSP blocks of the core and of its parts, and the cost
    that its slot and memory port add to the chip.
    """
    build = known(values)
    build.ninja("synth_inputs")
    return utilisation(build, values, "--design", values.ip) or \
        utilisation(build, values, "--core", values.ip,
                    *(["--design", "soc"] if values.chip else []))


def one_test(program, text):
    """Returns the name of a test. `text` is the full name, or an expression that matches only this
    test."""
    listed = output([program, "--gtest_list_tests"])
    suite, names = "", []
    for line in listed.splitlines():
        if line.startswith(" "):
            names.append(suite + line.split()[0])
        else:
            suite = line.split()[0]
    found = [name for name in names if text in (name, name.partition(".")[2])] or [
        name for name in names if re.search(text, name)]
    if len(found) != 1:
        raise Stop(f"{option('test', text)}: expected an expression that matches one test, got "
                   f"{len(found)} matches; the tests are:\n{listed}"
                   + nearest(text, names), 2)
    return found[0]


def ports(build, core):
    """Returns the ports of the core's model, in the notation of GTKWave."""
    for header in build.folder.rglob(f"verilated_{core}_slot/V{core}_slot.h"):
        for name, high, low in re.findall(r"VL_(?:IN|OUT)[0-9W]*\(&(\w+),(\d+),(\d+)",
                                          header.read_text()):
            yield f"TOP.{name}" + (f"[{high}:{low}]" if int(high) > int(low) else "")


def rows_of(fst, build, core):
    """Returns the rows of GTKWave's save file, at most 200: the ports, then the signals of the
    instances, outermost first. The signals of an instance follow a comment with its name."""
    status, text = collect(["fst2vcd", "-f", fst]) if shutil.which("fst2vcd") else (0, "")
    if status:
        raise Stop(f"{fst}: the waveform is incomplete: the test was aborted (its output is in "
                   f"{fst.with_suffix('.log')}), or the disk is full")
    _, signals, _ = vcd.read(text)
    rows, most, last = [*ports(build, core)], 200, []
    for signal in sorted(filter(lambda s: s.is_shown, signals), key=lambda s: len(s.scopes)):
        if signal.scopes == ["TOP"] and rows and not last:
            continue  # the port is already in the list
        if signal.scopes != last:
            last = signal.scopes
            rows.append("-" + ".".join(last))
        rows.append(signal.row)
    return rows[:most]


def check_wave(values):
    """Fails if the core or the test is unknown. Called before anything is configured or built,
    because that takes minutes."""
    core, text = values.ip.removesuffix(".vhdl"), values.test
    is_program = core.startswith("test_")
    cores = choices.cores(values)
    if not is_program and core not in cores:
        raise Stop(f"unknown core '{core}': expected one of {' '.join(cores)}"
                   + nearest(core, cores), 2)
    try:
        re.compile(text)
    except re.error:
        raise Stop(f"{option('test', text)}: expected a regular expression; .* matches any text",
                   2) from None
    folder = BuildFolder(values.build, values).core(core)
    folders = choices.SEARCHED if is_program else (str(folder),)
    if not values.ip.endswith(".vhdl") and not choices.may_be_case(text, folders):
        names = [name.rpartition(".")[2] for name in choices.cases(folders=folders)]
        parts = [word for name in names
                 for words in ("{1}", "{2}")
                 for word in re.findall(rf"(?=((?:[A-Z][a-z0-9]*){words}))", name)]
        raise Stop(f"{option('test', text)}: expected the name of a test, or a part of it, got no "
                   f"test of this name{'' if is_program else f' in {folder}'}"
                   + nearest(text.rpartition(".")[2], [*names, *parts]), 2)


def traced(values):
    """Returns the build folder of a test with a waveform, and the command that runs the test."""
    what = values.ip
    if what.endswith(".vhdl"):  # GHDL writes the waveform itself
        build = BuildFolder(values.build, values).prepare()
        build.ninja("ghdl", f"{what[:-5]}_vectors")
        return build, ["ctest", "--test-dir", build.folder, "--no-tests=error", "-R",
                       f"^{re.escape(what)}$"]
    if what.startswith("test_"):
        main, target = BuildFolder(values.build, values).prepare(), what
    else:
        main, target = known(values), f"test_ip_{what}"
        source = main.core(what) / f"{what}_test.cpp"
        if not source.exists():
            raise Stop(f"{source} not found; it is the core's test")
    build = BuildFolder("build/trace", values)
    if not values.built:
        build.configure("-DTRACE=ON")
        build.follow(main)
    build.ninja(target)
    program = next(path for path in sorted(build.folder.rglob(target))
                   if path.is_file() and os.access(path, os.X_OK)).absolute()
    return build, [program, f"--gtest_filter={one_test(program, values.test)}"]


@command("core wave", [dataclasses.replace(
    CORE, kind=matching(r"\w+(\.vhdl)?", "a core, test_... or CORE.vhdl"), is_checked=False,
    help="core, test program (such as test_fsmc_bridge), or VHDL test bench that runs in GHDL "
         "(such as fir.vhdl)"), Option(
    "test", TEXT, "name of the test, or an expression that matches only this test", "",
    positional=True), CORE_FOLDERS, BUILD, JOBS], make="wave", brief="core wave fir Impulse",
         examples=["core wave fir Impulse", "core wave test_fsmc_bridge TooEarly",
                   "core wave fir.vhdl"])
def wave(values):
    """write the waveform of one test for GTKWave, build/wave/NAME.fst

    The save file NAME.gtkw lists the ports, then internal signals. For a core in VHDL,
    `NAME.vhdl` in place of the core name selects GHDL's waveform, which has the names and types
    of the source."""
    what = values.ip
    if not what or not (values.test or what.endswith(".vhdl")):
        raise Stop("core wave: expected a core or test program, and a test: ./icesoc core "
                   "wave fir Impulse; or only CORE.vhdl: ./icesoc core wave fir.vhdl", 2)
    if not values.built:
        check_wave(values)
    build, words = traced(values)
    folder = Path("build/wave").absolute()
    folder.mkdir(parents=True, exist_ok=True)
    fst, save, log = (folder / f"{what}{end}" for end in (".fst", ".gtkw", ".log"))
    fst.unlink(missing_ok=True)
    with open(log, "w") as file:
        status = run(words, check=False, stdout=file, stderr=file, env={"WAVE": fst})
    name = str(words[-1]).rpartition("=")[2]
    if not fst.exists() or not fst.stat().st_size:
        raise Stop(f"{log.read_text()}{name} wrote no waveform")
    save.write_text("\n".join([
        f"[*] {name}: generated by ./icesoc core wave", f'[dumpfile] "{fst}"',
        f'[savefile] "{save}"', *rows_of(fst, build, what)]) + "\n")
    if status:
        warn(f"{name} failed: {log}")
    if os.environ.get("DISPLAY") and shutil.which("gtkwave"):
        return run(["gtkwave", fst, save], check=False)
    if not shutil.which("gtkwave"):
        return say(f"{fst}: open it with a viewer, such as GTKWave, which ./icesoc setup --tests "
                   "installs")
    say(f"gtkwave {fst} {save}")
