# SPDX-License-Identifier: MIT
"""waves: repeats a failed test of RTL, or a failed flight, with a waveform of the clocks around the
failure, for GTKWave."""
import dataclasses
import json
import os
import pathlib
import re

from tool import Stop, run, write

CLOCKS_PER_SECOND = 1e8  # of a flight's chip
FIRST_CORE = 2  # slot


@dataclasses.dataclass
class Scene:
    """A repetition: a test's program, or a flight's recording, around a clock."""
    program: str
    clock: int
    flight: str = ""  # folder of the recording
    slot: int = 0  # of the last core that the processor heard of; 0: none
    before: int = 2000
    after: int = 20


def scene_of(failure, test):
    """None: the failure has no waveform."""
    log = failure.result.log
    if match := re.search(r"make run REPLAY='([^']+)' FROM=[0-9.]+ TO=([0-9.]+)", log):
        scene = Scene("icesoc-sim", int(float(match[2]) * CLOCKS_PER_SECOND), match[1])
        events = pathlib.Path(scene.flight, "events.jsonl")
        for line in events.read_text().splitlines() if events.exists() else []:
            try:
                event = json.loads(line)
            except ValueError:
                continue
            # The last place where the processor heard of a core, or else of the modem
            slot = event.get("slot", -1)
            if slot >= FIRST_CORE or slot >= 0 and not scene.slot:
                scene.clock = event["ns"] // 10
                scene.slot = slot if slot >= FIRST_CORE else 0
    elif match := re.search("at clock cycle ([0-9]+)", log):
        scene = Scene(failure.result.name.split(".")[0], int(match[1]))
    else:
        return None
    if "e2e" in test.labels:  # a mission's program works for longer than a block
        scene.before, scene.after = 150_000, 50_000
    return scene


def instance_in(slot, build):
    """The name of a slot's instance in the chip's list of cores."""
    cores = build / "gen/soc_cores.vh"
    match = re.search(rf"(u_\w+) \([^;]*`SLOT\({slot}\)",
                      cores.read_text() if cores.exists() else "")
    return match[1] if match else "u_modem"


def save_file(wave, build, folder, has_program, clock, instance):
    """GTKWave's save file: the marker at a clock, of which a file of ours counts halves; an open
    instance; the program's rows, and the ports of the models below `folder` and below the folder of
    the tested block: tests/hdl/fifo, hdl/fifo."""
    rows = ["program.task", "program.interrupt", "program.function"] * has_program
    for place in sorted({folder, folder.removeprefix("tests/")}):
        for header in sorted((build / place).rglob("verilated_*/V*.h")):
            if header.parent.name == "verilated_" + header.stem[1:]:
                ports = re.findall(r"VL_(?:IN|OUT)[0-9W]*\(&(\w+),(\d+),(\d+)", header.read_text())
                rows += [f"TOP.{name}" + (f"[{high}:{low}]" if int(high) > int(low) else "")
                         for name, high, low in ports]
    rows = [f'[dumpfile] "{wave}"', "[size] 1600 900", f"*-6.0 {2 * clock}", "[treeopen] TOP.",
            *([f"[treeopen] TOP.soc.{instance}."] if instance else []), *rows]
    return "".join(row + "\n" for row in rows)


def add_wave(failure, test, scene, source, tested, jobs):
    """Makes a failure's waveform by the build in build/trace, or prints why there is none."""
    build = (source / "build/trace").resolve()
    if not (build / "build.ninja").exists():
        run(["cmake", "-S", source, "-B", build, "-G", "Ninja", "-DTRACE=ON"])
    status, text = run(["ninja", "-C", build, "-j", jobs, scene.program])
    if status:
        raise Stop(f"it does not build with waveforms:\n{text}")
    base = failure.log.removesuffix(".log")
    wave = os.path.abspath(f"{base}.fst")
    first, last = max(0, scene.clock - scene.before), scene.clock + scene.after
    if scene.flight:
        run([build / "testbench/sim/icesoc-sim", "--replay", scene.flight, "--out",
             f"{base}.replay", "--wave", wave, "--from", f"{first / CLOCKS_PER_SECOND:.6f}",
             "--to", f"{last / CLOCKS_PER_SECOND:.6f}"])
    else:
        run(["ctest", "--test-dir", build, "--no-tests=error", "-R",
             "^" + re.sub(r"([.+*?()\[\]{}|^$\\])", r"\\\1", failure.result.name) + "$"],
            {"SEED": failure.result.seed, "WAVE": wave, "WAVE_FROM": str(first),
             "WAVE_TO": str(last)})
    if not os.path.exists(wave):
        raise Stop("the test drove no traced model")
    has_program = os.path.exists(wave + ".program.vcd")
    run([source / "testbench/common/join_waves.sh", wave])
    failure.wave, failure.save = f"{base}.fst", f"{base}.gtkw"
    folder = "testbench/sim" if scene.flight else os.path.relpath(test.folder, tested)
    write(failure.save, save_file(wave, build, folder, has_program, scene.clock,
                                  scene.flight and instance_in(scene.slot, build)))


def add_waves(failures, tests, source, build, jobs, limit):
    """Prints its steps on the terminal; a test that cannot be traced has no waveform."""
    made = 0
    for failure in failures:
        test = tests.get(failure.result.name)
        scene = test and scene_of(failure, test)
        if not scene:
            continue
        if made == limit:
            print(f"No waveforms for more than {limit} failures (WAVES=n for more)")
            return
        made += 1
        print(f"Waveform of {failure.result.name} around clock {scene.clock} ...", flush=True)
        try:
            add_wave(failure, test, scene, source, build, jobs)
        except (Stop, OSError) as error:  # the report is worth more than a waveform
            print(f"  none: {error}")
