# SPDX-License-Identifier: MIT
"""check: commands that run proofs, sanitizers, seeded bugs, faults, hours of radio, and
measurements."""
import dataclasses
import re
import shutil
import sys
from pathlib import Path

from icesoc.cli import choices
from icesoc.cli.build_folder import ROOMS_OF_PROGRAMS, BuildFolder, configured, netlists
from icesoc.cli.command import GROUPS, command
from icesoc.cli.options import (BLOCK, BUILD, COUNT, FAMILY, FRESH, JOBS, MINUTES, NAME, PATH, SEED,
                                TESTS, WORDS, Option)
from icesoc.regress.tests import list_tests
from icesoc.synth.sources import read_designs
from icesoc.util.console import say, warn
from icesoc.util.errors import Stop
from icesoc.util.lock import lock
from icesoc.util.process import output, run, tool
from icesoc.util.rooms import MEASURED
from icesoc.util.tree import tree_state, write_state

GROUPS["check"] = "proofs, sanitizers, fuzzing, faults, coverage"
# Test programs that are built with sanitizers: name -> folder of the test, and the programs that
# the test starts.
GUARDED: dict[str, tuple[str, list[str]]] = {
    "test_icec": ("icec", []), "test_ground_engine": ("ground", []),
    "test_ground_ice": ("ground/ice", ["gateway"])}


# Sanitizers: build folder below build/, and value of CMake's SANITIZE.
SANITIZERS = {"address": ("sanitized", "ON"), "thread": ("thread", "thread")}


@choices.expecting("a sanitizer")
def kinds(values=None):  # pylint: disable=unused-argument
    return list(SANITIZERS)


@choices.expecting("a test program that is built with sanitizers")
def guarded(values=None):  # pylint: disable=unused-argument
    """Returns the test programs that `check sanitizers` accepts."""
    return list(GUARDED)


def one_more(status, other):
    """Returns `status`, or `other` if `status` is 0."""
    return status or other


@command("check proofs", [NAME, BUILD, JOBS], make="proofs", brief="check proofs --name cdc_bus",
         examples=[
             "check proofs",
             "check proofs --name cdc_bus",
             "check proofs --name 'bus|modem'"])
def proofs(values):
    """run the formal proofs again and print their total CPU time

    Runs every proof, even if nothing has changed since the proof passed. A failed proof leaves a
    waveform in build/main/tests/hdl/formal.
    """
    build = configured(values, "regmaps")
    chosen = ["-R", values.name] if values.name else []
    build.ctest("-L", "formal", *chosen, tests=values.jobs, FRESH="1")
    spent = [float(path.read_text()) for path in (build / "tests/hdl/formal").glob("*/cpu")
             if re.search(values.name or "", f"formal.{path.parent.name}")]
    say(f"{len(spent)} proofs, {sum(spent):.0f} s of CPU time")


@command("check netlist", [NAME, FAMILY, TESTS, JOBS], make="netlist",
         brief="check netlist --name 'cdc_bit|probe'",
         long=("check netlist", "check netlist --family ecp5 --name "
               "'^(cdc_bit|modem_uart_tx|bus_wrapper|modem_at_rows)$'"),
         examples=[
             "check netlist",
             "check netlist --name 'fir|modem'",
             "check netlist --family ecp5"])
def netlist(values):
    """prove each netlist equivalent to its RTL

    Yosys and abc prove the netlists of small designs. For a large design, the tests of the block
    run on its netlist. Exit status 1: a netlist differs.
    """
    simulated = read_designs()["simulated"]
    build = netlists(values, "-DCLK_HZ=2000000", tests=True)
    build.ninja("synth_inputs")
    program = [build / "synth/utilisation", "--generated", build / "gen", "--jobs", values.jobs,
               "--output", build / "netlists", "--family", values.family]
    names = output([*program, "--list"]).split()
    chosen = [name for name in names if re.search(values.name or "", name)]
    if not chosen:
        raise Stop(f"no netlist matches '{values.name}': expected one of {', '.join(names)}", 2)
    tests = [test for name in chosen for test in simulated.get(name, "").split()]
    words = ["--equivalent", *(f"--design={name}" for name in chosen)]
    if tests:
        # Proofs run first, because they are short and cached; the table reads their results from
        # the cache.
        proven = [f"--design={name}" for name in chosen if name not in simulated]
        if proven:
            output([*program, "--equivalent", *proven], check=False)
        build.ninja(*{test.partition(".")[0] for test in tests})
        build.ctest("-R", f"^({'|'.join(tests)})[^a-z_]", tests=values.tests or values.jobs,
                    check=False)
        words += ["--junit", build / "junit.xml"]
    return run([*program, *words], check=False)


@command("check sanitizers",
         [Option("kinds", WORDS, f"sanitizers to use: {', '.join(SANITIZERS)}", list(SANITIZERS),
                 choices=kinds),
          Option("programs", WORDS, f"test programs to run: {', '.join(GUARDED)}", list(GUARDED),
                 choices=guarded),
          BUILD, JOBS],
         make="sanitizers", brief="check sanitizers --kinds address --programs test_icec",
         long="check sanitizers", examples=[
             "check sanitizers",
             "check sanitizers --kinds thread",
             "check sanitizers --kinds address --programs test_icec"])
def sanitizers(values):
    """run programs with AddressSanitizer and ThreadSanitizer

    Builds IceC, and the radio engine, gateway and plugin of the ground station, with both
    sanitizers, and runs their tests. Then fuzzes the simulator's GDB stub.
    """
    build, status = configured(values, tests=True), 0
    # the programs of each sanitizer are built in a separate build folder
    for name in values.kinds:
        kind, option = SANITIZERS[name]
        folder = BuildFolder(f"build/{kind}", values)
        folder.configure(f"-DSANITIZE={option}", f"-DROOMS={ROOMS_OF_PROGRAMS}")
        environment = {
            "ASAN_OPTIONS": "detect_leaks=0",  # libmcpp leaks
            "TSAN_OPTIONS": f"suppressions={Path('tests/sw/ground/threads.supp').absolute()}"}
        folder.ninja(*(target for program in values.programs
                       for target in (program, *GUARDED[program][1])), env=environment)
        # ThreadSanitizer skips Python's libraries, because Python's locks are not instrumented.
        left = ["--gtest_filter=-*Python*"] if kind == "thread" else []
        for program in values.programs:
            path = folder / "tests/sw" / GUARDED[program][0] / program
            status = one_more(status, run([path, "--gtest_brief=1", *left], check=False,
                                          env=environment))
    build.ninja("fuzz_gdb")
    return one_more(status, build.ctest("-R", "^testbench[.]fuzz[.]gdb$", tests=1, check=False))


@command("check fuzz", [
    Option("minutes", MINUTES, "run time of each fuzzer", 10.0), NAME, SEED, TESTS, BUILD, JOBS],
         make="fuzz", brief="check fuzz --minutes 0.05 --name 'update$|rdl$'",
         long="check fuzz --seed {day}", examples=[
             "check fuzz",
             "check fuzz --name slice --minutes 60",
             "check fuzz --seed 7"])
def fuzz(values):
    """fuzz every parser

    Starts with the inputs in tests/, and with inputs of earlier runs, which are stored in
    ~/.cache/icesoc/fuzz. For an input that fails, prints its bytes and the command that repeats the
    failure.
    """
    build = configured(values, "regress", tests=True)
    chosen = f"[.]fuzz[.].*({values.name or ''})"
    if not values.built:
        run([build / "tests/regress/regress", "--prepare", "--build", build.folder,
             "--label", "^fuzz$", "--name", chosen])
    return build.ctest("-R", chosen, tests=values.tests or values.jobs, check=False,
                       FUZZ=max(1, round(60 * values.minutes)), SEED=values.seed)


@command("check mutants", [
    dataclasses.replace(BLOCK, help="block whose seeded bugs are planted, or one bug as BLOCK/BUG",
                        choices=choices.seeded, is_checked=True),
    Option("draw", COUNT,
           "instead of the bugs in tests/mutants, plant this number of random mutants per proof"),
     SEED,
    FRESH, BUILD, JOBS], make="mutants", brief="check mutants --block bus/decoder_error_of_all",
         long=("check mutants", "check mutants --draw 8 --seed {day}"), examples=[
             "check mutants",
             "check mutants --block bus",
             "check mutants --draw 20 --seed 7"])
def mutants(values):
    """plant faults into the sources and expect the tests to fail

    Plants each fault of tests/mutants in a copy of the sources, and runs the test that must detect
    it. With --draw, Yosys plants random faults instead, and the proofs or tests of the module must
    detect each of them. Exit status 1: a fault was not detected.
    """
    build = configured(values, tests=True)
    build.ninja("regress", *(["regmaps"] if values.draw else []))
    drawn = [*tool("mutants.drawn"), "--build", build.folder, "--number", values.draw, "--seed",
             values.seed]
    return run([*(drawn if values.draw else tool("mutants.run")), "--jobs", values.jobs,
                *(["--block", values.block] if values.block else [])], check=False,
               env={"FRESH": "1" if values.fresh else ""})


@command("check faults", [
    Option("moments", COUNT, "number of flights for each fault and seed; each flight gets the "
           "fault at another moment", 10), SEED,
    Option("seeds", COUNT, "number of seeds, starting with --seed", 1),
    Option("name", NAME.kind, "only faults with this text in their name, such as killed", ""),
     BUILD, JOBS],
         make="faults", brief="check faults --name killed --moments 1",
         long="check faults --seed {day}", examples=[
             "check faults",
             "check faults --name killed --moments 2",
             "check faults --seed 7 --seeds 3"])
def faults(values):
    """inject faults into missions and check the consequences

    Kills, stops or starves each process of a mission at random times, and fills the disk.
    docs/regression.md lists the expected consequences.
    """
    build = configured(values)
    build.ninja("mission", "clock_step", "regress", "utilisation", "regmaps")
    if not values.name:
        run([sys.executable, "tests/regress/interrupted.py", ".", build.folder,
             "build/faults/interrupted",
             values.moments, "new_ip", "regress", "synth"], env={"SEED": values.seed})
    return run([
        sys.executable, "tests/e2e/mission/faults.py",
        Path.cwd(), build.folder, "build/faults/missions", "--seed", values.seed, "--seeds",
        values.seeds, "--moments", values.moments, "--jobs", values.jobs, "--deaths", 2,
        *(["--only", values.name] if values.name else [])], check=False)


@command("check soak", [
    Option("minutes", MINUTES, "CPU time of the test, and simulated time of the flight with ten "
                               "vehicles", 4.0),
    Option("fuzzed", COUNT,
           "number of bytes of noise sent to the modem controller; the link layer and the ground "
           "station's radio engine get ten times as many",
           1000000), SEED, BUILD, JOBS], make="soak",
         brief="check soak --minutes 0.01 --fuzzed 1000",
         long="check soak --minutes 60 --seed {day}", examples=[
             "check soak",
             "check soak --minutes 60",
             "check soak --fuzzed 10000000 --seed 7"])
def soak(values):
    """test the radio for a long time: bad channel, restarts, noise

    Spends a quarter of the CPU time on tests of the link layer, a quarter on the link layer under
    attack, and half on calls between stock Ice, which uses the plugin, and IceC on the chip's RTL.
    In addition, ten vehicles and two ground stations fly for --minutes of simulated time. This
    flight takes about 5 % more CPU time.
    """
    build = configured(values, "soak", "test_chip_soak", "test_ground_engine", "test_modem_soak",
                       "test_link")
    seed, noise = {"SEED": values.seed}, {"SEED": values.seed, "BYTES": 10 * values.fuzzed}
    link = [build / "tests/soak/soak", "--minutes", values.minutes / 4, "--seed", values.seed]
    run(link)
    run([*link, "--attacked"])
    run([build / "tests/soak/soak", "--seconds", 60 * values.minutes, "--seed", values.seed,
         "--vehicles", 10, "--grounds", 2])
    run([build / "tests/sw/ground/chip/test_chip_soak", "--gtest_brief=1"],
        env={**seed, "SOAK_SECONDS": 30 * values.minutes})
    run([build / "tests/sw/link/test_link", "--gtest_brief=1", "--gtest_filter=*TenMillion*"],
        env=noise)
    run([build / "tests/sw/ground/test_ground_engine", "--gtest_brief=1",
         "--gtest_filter=Engine.RandomBytes*"], env=noise)
    run([build / "tests/hdl/test_modem_soak", "--gtest_brief=1"],
        env={**seed, "SOAK_BYTES": values.fuzzed})


def benches_of(build):
    """Returns the benches of a build folder: {name: the test that runs a short version of it}."""
    return {test.name.removeprefix("bench."): test for test in list_tests(build.folder)
            if test.name.startswith("bench.")}


def measure(benches, folder):
    """Runs benches one after the other; returns the first status that is not 0. Meanwhile, other
    commands may build in the build folder, but a second run of the benches has to wait."""
    folder.mkdir(parents=True, exist_ok=True)
    status = 0
    with lock("build/bench.lock", busy="waiting for another bench in this folder ..."):
        for name, bench in benches.items():
            words = [folder / f"{name}.json" if word.endswith(f"/{name}.json") else word
                     for word in bench.command if word != "--brief"]
            if failed := run(words, check=False):
                warn(f"bench {name}: exit status {failed}")
            status = one_more(status, failed)
    return status


@command("bench", [
    Option("only", WORDS, "names of the benches to run; the page is then not written",
           choices=choices.benches),
    Option("page", PATH, "output page", "docs/figures.md"), BUILD, JOBS], make="bench",
         brief="bench --only slice", long="bench --page build/bench/figures.md", examples=[
             "bench",
             "bench --only air plugin",
             "bench --page /tmp/figures.md"])
def bench(values):
    """measure the figures of docs/figures.md

    The benches are in tests/bench. Each bench writes build/bench/NAME.json. With --only, the page
    is not written.
    """
    build = configured(values)
    benches = benches_of(build)
    for name in values.only:
        if name not in benches:
            raise Stop(f"bench '{name}' is not in this build: expected one of "
                       f"{', '.join(benches)}", 2)
    folder = Path("build/bench")
    if values.only:
        targets = [target for name in values.only for target in benches[name].targets]
        if targets:
            build.ninja(*targets)
            benches = benches_of(build)  # after the build, CTest lists the commands of the programs
        return measure({name: benches[name] for name in values.only}, folder)
    build.ninja("bench_programs", "regress", "size")
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    write_state(folder, tree_state(".", MEASURED))
    status = measure(benches_of(build), folder)
    return one_more(status, run(["tests/bench/figures.py", values.page,
                                 *sorted(folder.glob("*.json")), "build/size.json"], check=False))
