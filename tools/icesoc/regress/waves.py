# SPDX-License-Identifier: MIT
"""waves: repeats a failed RTL test, or a failed flight, and records a waveform of the clocks around
the failure. Also prepares the end of a waveform for the drawing on the page."""
import collections
import dataclasses
import json
import os
import pathlib
import re

from icesoc.util import vcd
from icesoc.util.errors import Stop, reason_of
from icesoc.util.files import write
from icesoc.util.process import collect
from icesoc.util.rooms import RTL
from icesoc.util.rows import read as read_rows

CLOCKS_PER_SECOND = 1e8  # frequency of the chip in a flight, Hz
SECONDS = {"ms": 1e-3, "us": 1e-6, "ns": 1e-9, "ps": 1e-12, "fs": 1e-15}  # GHDL's units of time
END_OF_FLIGHT = re.compile("(?:REPLAY=|--replay )('[^']+'|[^ ]+) (?:FROM=|--from )[0-9.]+ "
                           "(?:TO=|--to )([0-9.]+)")  # in the log of a failed flight
FIRST_CORE = 2  # slot
SOURCES = (".v", ".sv", ".vh", ".vhd", ".vhdl")
MOST_CHANGES, FEWEST_CHANGES, MOST_SIGNALS = 400, 25, 200  # limits of a drawing: changes and
                                                           # signals


@dataclasses.dataclass
class Scene:
    """The run to repeat, around a clock: the program of a test, or the recording of a flight."""
    program: str  # target in the build with waveforms; "" for a test under GHDL
    clock: int
    flight: str = ""  # folder of the recording
    slot: int = 0  # slot of the core that last reported an event to the processor; 0: no core
    before: int = 2000
    after: int = 20


def scene_of(failure, test):
    """Returns the Scene of a failure, or None if no waveform of the failure can be recorded."""
    log = failure.result.log
    if failure.result.end.startswith("Hang"):  # the repetition would hang as well
        return None
    if match := END_OF_FLIGHT.search(log):
        scene = Scene("icesoc-sim", int(float(match[2]) * CLOCKS_PER_SECOND), match[1].strip("'"))
        for event in read_rows(pathlib.Path(scene.flight, "events.jsonl")):
            # the core that last reported an event to the processor is shown or, without one, the
            # modem
            slot = event.get("slot", -1)
            if slot >= FIRST_CORE or slot >= 0 and not scene.slot:
                scene.clock = event["ns"] // 10
                scene.slot = slot if slot >= FIRST_CORE else 0
    elif match := re.search("at clock cycle ([0-9]+)", log):
        scene = Scene(failure.result.name.split(".")[0], int(match[1]))
    elif failure.result.name.endswith(".vhdl") and \
            (match := re.search(r"@(\d+)([munpf]s):", log)):
        # GHDL simulates up to the failure, and its waveform contains all clocks
        scene = Scene("", int(int(match[1]) * CLOCKS_PER_SECOND * SECONDS[match[2]]))
    else:
        return None
    # a mission runs longer than the test of a block, so more clocks are recorded
    if "e2e" in test.labels:
        scene.before, scene.after = 150_000, 50_000
    return scene


def instance_in(slot, build):
    """Returns the instance name of the core in a slot, from the generated soc_cores.vh, or of the
    modem controller if the slot has no core."""
    cores = build / "gen/soc_cores.vh"
    match = re.search(rf"(u_\w+) \([^;]*bus_valid_i\(slot_valid\[{slot}\]\)",
                      cores.read_text() if cores.exists() else "")
    return match[1] if match else "u_modem"


def instances(changed, source, build):
    """Yields the names of all instances of the modules and entities in changed files. `changed`:
    text with the paths of these files. At the end, yields the names of the modules, because the top
    of a model is named after its module."""
    texts, rooms = None, "|".join(RTL)
    for path in re.findall(rf"((?:{rooms})/[^\s:,]*\.(?:sv|vhdl|v|vhd))(?=[:, ]|$)", changed):
        file = source / path
        text = file.read_text(errors="replace") if file.is_file() else ""
        kind = "entity" if file.suffix.startswith(".vhd") else "module"
        modules = re.findall(rf"^\s*{kind}\s+(\w+)", text, re.M | re.I) or [file.stem]
        if texts is None:
            texts = [each.read_text(errors="replace")
                     for folder in (*(source / room for room in RTL), build / "gen")
                     for each in sorted(folder.rglob("*")) if each.suffix in SOURCES]
        for module in modules:
            use = re.compile(rf"^\s*{module}\s+(?:#\s*\([^;]*?\)\s*)?(\w+)\s*\(|"  # Verilog
                             rf"\b(\w+)\s*:\s*(?:entity\s+|component\s+)?(?:\w+\.)?{module}\s",
                             re.M | re.I)
            yield from (match[1] or match[2] for text in texts for match in use.finditer(text))
        yield from modules


def scope_in(signals, names):
    """Returns the first of these names that is an instance in the waveform, spelled as in the
    waveform (GHDL writes lower-case letters); "" without such an instance."""
    scopes = {scope.lower(): scope for signal in signals for scope in signal.scopes}
    return next((scopes[name.lower()] for name in names if name.lower() in scopes), "")


def rows_below(scope, signals):
    """Returns the rows of a save file for the signals of an instance."""
    return [signal.row for signal in signals if signal.scopes[-1:] == [scope] and signal.is_shown]


def save_file(wave, build, folder, first):
    """Returns the text of GTKWave's save file: the rows `first`, then the ports of the test's
    models. The models are below the test's folder, such as tests/hdl/fifo, or below the folder of
    the tested block, such as hdl/fifo."""
    rows = [*first]
    for place in sorted({folder, folder.removeprefix("tests/")}) if folder else []:
        for header in sorted((build / place).rglob("verilated_*/V*.h")):
            if header.parent.name == "verilated_" + header.stem[1:]:
                ports = re.findall(r"VL_(?:IN|OUT)[0-9W]*\(&(\w+),(\d+),(\d+)", header.read_text())
                rows += [f"TOP.{name}" + (f"[{high}:{low}]" if int(high) > int(low) else "")
                         for name, high, low in ports]
    return f'[dumpfile] "{wave}"\n[size] 1600 900\n[treeopen] TOP.\n' + \
        "".join(row + "\n" for row in rows)


def repeat(failure, scene, source, tested, jobs, wave):
    """Repeats a failed test with a waveform. Returns the build folder, and names of instances to
    show; the first one in the waveform is used."""
    first, last = max(0, scene.clock - scene.before), scene.clock + scene.after
    build = (source / "build/trace").resolve() if scene.program else tested
    if scene.program:
        if not (build / "build.ninja").exists():
            collect(["cmake", "-S", source, "-B", build, "-G", "Ninja", "-DTRACE=ON"])
        status, text = collect(["ninja", "-C", build, "-j", jobs, scene.program])
        if status:
            raise Stop(f"the build with waveforms failed:\n{text}")
    names = [*instances(failure.changed, source, build)]
    if scene.flight:
        collect([build / "testbench/sim/icesoc-sim", "--replay", scene.flight, "--out",
             f"{failure.log.removesuffix('.log')}.replay", "--wave", wave, "--from",
             f"{first / CLOCKS_PER_SECOND:.6f}", "--to", f"{last / CLOCKS_PER_SECOND:.6f}"])
        return build, [*names, instance_in(scene.slot, build)]
    collect(["ctest", "--test-dir", build, "--no-tests=error", "-R",
         "^" + re.sub(r"([.+*?()\[\]{}|^$\\])", r"\\\1", failure.result.name) + "$"],
        {"SEED": failure.result.seed, "WAVE": wave, "WAVE_FROM": str(first),
         "WAVE_TO": str(last)})
    return build, names


def add_wave(failure, test, scene, source, tested, jobs):
    """Writes a waveform of a failure, or prints the reason why this is impossible. For Verilog,
    uses the build in build/trace."""
    base = failure.log.removesuffix(".log")
    wave = os.path.abspath(f"{base}.fst")
    build, names = repeat(failure, scene, source, tested, jobs, wave)
    if not os.path.exists(wave):
        raise Stop("the test uses no model that can write a waveform")
    rows = ["program.task", "program.interrupt", "program.function"] \
        if os.path.exists(wave + ".program.vcd") else []
    collect([source / "testbench/common/join_waves.sh", wave])
    signals = vcd.read(collect(["fst2vcd", "-f", wave])[1])[1]
    failure.scope = scope_in(signals, names)
    failure.wave, failure.clock, failure.save = f"{base}.fst", scene.clock, f"{base}.gtkw"
    folder = "testbench/sim" if scene.flight else os.path.relpath(test.folder, tested) \
        if scene.program else ""
    write(failure.save, save_file(wave, build, folder,
                                  rows + rows_below(failure.scope, signals)))


def add_waves(failures, tests, source, build, jobs, limit):
    """Adds waveforms to failures, and prints the steps. A test that cannot be traced gets no
    waveform."""
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
        # the report must be written even if a waveform cannot be made
        except (Stop, OSError) as error:
            print(f"  none: {reason_of(error)}")


class Signal:
    def __init__(self, scopes, name, bits):
        self.name, self.depth = ".".join([*scopes, name]), len(scopes)
        self.bits = bits  # 0: text
        self.order: tuple = ()  # the name with the lowest order is shown if there are several
        self.changes = collections.deque(maxlen=MOST_CHANGES)  # (time, value), newest last


def shown(bits, width):
    """Returns a value as a hexadecimal number, or "x" or "z" if any of its bits is x or z. A single
    bit is returned unchanged. VCD omits leading bits that are 0, or that repeat a first bit x or z;
    they are added."""
    bits = bits.rjust(width, bits[0] if bits[0] in "xz" else "0")
    strange = bits.lstrip("01")
    digits = (len(bits) + 3) // 4
    return bits if len(bits) <= 1 else strange[0] if strange else f"{int(bits, 2):0{digits}x}"


def read_vcd(text, scope=""):
    """Returns the signals of a VCD file that change, and the first and last time of the file. A
    signal with several names gets the outermost name below `scope`, or else the outermost name."""
    signals, moments = {}, []
    _, variables, changes = vcd.read(text)
    for each in variables:
        if not each.name.startswith("smt_"):  # names that begin with smt_ are signals of the solver
            signal = Signal(each.scopes, each.name, each.width * (each.kind != "string"))
            signal.order = scope not in each.scopes, signal.depth
            known = signals.get(each.key)
            if not known or signal.order < known.order:
                signals[each.key] = signal
    for now, key, value in changes:
        signal = signals.get(key)
        if key is None:
            moments = [moments[0] if moments else now, now]
        # The trace of a proof repeats unchanged values at each step.
        elif signal and not (signal.changes and signal.changes[-1][1] == value):
            signal.changes.append((now, value))
    return [signal for signal in signals.values() if signal.changes], moments


def drawing_of(failure, room):
    """Returns the drawing of a failure's waveform: {from, to, signals: [[name, bits, [time, value,
    ...]], ...], first: number of signals listed before the tree of instances, more: number of
    signals left out}.

    The first signals belong to the program, are named in the failure's text, or change below the
    failure's instance, except for words of memories. They are followed by the
    other signals that change, and by constant signals. Each group begins with the outermost
    signals. Signals with names that a converter has invented are left out. If the drawing exceeds
    `room` bytes, its older changes are left out, then the last signals."""
    try:
        text = collect(["fst2vcd", "-f", failure.wave])[1] if failure.wave.endswith(".fst") \
            else pathlib.Path(failure.wave).read_text()
        signals, moments = read_vcd(text, failure.scope)
    except (ValueError, IndexError, StopIteration, RuntimeError) as error:
        print(f"{failure.wave} is damaged, so the page does not draw it ({error})")
        return None
    if not moments:
        return None
    words = set(re.findall(r"[A-Za-z_]\w+", failure.about))

    def rank(signal):
        within = f".{failure.scope}." in signal.name if failure.scope else signal.depth <= 3
        named = signal.name.rpartition(".")[2] in words and (within or signal.depth <= 3)
        moves = len(signal.changes) > 1
        blamed = bool(moves and failure.scope and within and not signal.name.endswith("]"))
        return (signal.bits != 0, not named, not blamed, not moves, signal.depth, signal.name)
    total = len(signals)
    signals = sorted((s for s in signals if not vcd.NAMELESS.search(s.name)), key=rank)
    first = sum(not all(rank(s)[:3]) for s in signals)

    def rows(count, changes):
        return [[s.name, s.bits, [each for time, value in list(s.changes)[-changes:]
                                  for each in (time, shown(value, s.bits) if s.bits else value)]]
                for s in signals[:count]]
    count, changes = min(len(signals), MOST_SIGNALS), MOST_CHANGES
    drawn = rows(count, changes)
    while len(json.dumps(drawn)) > room and count > 1:
        if changes > FEWEST_CHANGES:
            changes //= 2
        else:
            count //= 2
        drawn = rows(count, changes)
    return {"from": moments[0], "to": moments[1], "signals": drawn, "first": min(first, count),
            "more": total - count}
