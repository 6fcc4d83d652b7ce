#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""edits: measures how long a developer waits after an edit: until the test of the core has ended,
and until a flight has ended. Also measures the first test of a core in a fresh clone, compared with
the time that Verilator itself takes.

    edits.py OUTPUT.json [--brief] [WORD...]

Everything runs in a clone of this tree, without the compiler cache. With words, only the edits
whose names contain one of the words are measured. --brief only checks that each edit fits the
sources.
"""
import os
import resource
import subprocess
import sys
import tempfile
import time
import typing
from pathlib import Path

from figures import figure, leave

SOURCE = Path(__file__).resolve().parents[2]
# A minimal program that runs a Verilated model by advancing its clock.
PROGRAM = """#include "Vfir.h"
int main() {
    Vfir top;
    for (int i = 0; i < 20000; ++i, top.clk_i = i & 1) top.eval();
}
"""
TEST_FIR, TEST_ASCON = ["core", "test", "fir"], ["core", "test", "ascon"]
FLIGHT = ["run", "--cores", "fir", "--out", "build/edited"]
LINE = ("ip/fir/fir.v", ("clear && !busy;", "clear && (!busy || refused);"))
REGISTER = ("ip/fir/fir.v",
            ("clear && !busy;", "clear && (!busy || late);\n        late <= refused;"),
            ("    integer r;\n", "    reg late;\n    integer r;\n"))
VHDL = ("ip/fir/fir_filter.vhd",
        ("result_ready_i or not full(5);", "result_ready_i or not full(5) or (rst_i and full(4));"))
OWN = "OWN/low_pass/"  # a core that `core new` has created in a separate repository
TEST_OWN = ["core", "test", "low_pass", "--core-folders", OWN]
# Name, command, file and replacements of each edit, and the wanted time in seconds. The edits
# leave the behaviour as it is, but the edited files have to be compiled again.
EDITS = (
    ("no edit, fir to its verdict", TEST_FIR, (), None),
    ("line of Verilog in fir to its verdict", TEST_FIR, LINE, 2),
    ("new register in fir to its verdict", TEST_FIR, REGISTER, 2),
    ("line of VHDL in fir to its verdict", TEST_FIR, VHDL, 2),
    ("line of VHDL in vision to its verdict", ["core", "test", "vision"],
     ("ip/vision/vision_window.vhd",
      ("39 downto 0) & pixel;", "39 downto 0) & (pixel or (pixel and pixel_i));")), 2),
    ("line of Verilog in a core of a separate repository to its verdict", TEST_OWN,
     (OWN + "low_pass.v", ("left != 32'd0) begin", "left != 32'd0 && !core_rst) begin")), 2),
    ("line of the Slice file of fir to its verdict", TEST_FIR,
     ("ip/fir/fir.ice", ("hw:long:1000", "hw:long:1001")), None),
    ("line of the registers of ascon to its verdict", TEST_ASCON,
     ("ip/ascon/ascon.regs.json", ("every address, bytes", "each address, bytes")), None),
    ("line of C in the servant of ascon to its verdict", TEST_ASCON,
     ("ip/ascon/ascon_servant.c", ("TIMEOUT_MS 100U", "TIMEOUT_MS 101U")), 3),
    ("line of the test of fir to its verdict", TEST_FIR,
     ("ip/fir/fir_test.cpp", ("round < 60", "round < 61")), None),
    ("line of Verilog in fir to the end of a flight", FLIGHT, LINE, 6),
    ("new register in fir to the end of a flight", FLIGHT, REGISTER, 6),
    ("line of VHDL in fir to the end of a flight", FLIGHT, VHDL, 6),
    ("line of C in the vehicle's firmware to the end of a flight", FLIGHT,
     ("sw/hw/hw_core.c", ("#include \"hw_core.h\"\n", "#include \"hw_core.h\"\nint edited(void);\n"
                          "int edited(void) {\n    return 1;\n}\n")), None))


class Spent(typing.NamedTuple):
    """The duration of a command and its CPU time, in seconds. On a loaded machine, only CPU times
    can be compared."""
    wall: float
    cpu: float

    def __str__(self):
        return f"{self.wall:.1f} s ({self.cpu:.1f} s of CPU time)"


def spent_by(*words, cache=False):
    """Runs a command without ccache, and returns the time that it took."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    begin = time.monotonic()
    done = subprocess.run(list(map(str, words)), stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True,
                          env={**os.environ, **({} if cache else {"CCACHE_DISABLE": "1"})})
    wall, after = time.monotonic() - begin, resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return sys.exit(done.stdout[-4000:]) if done.returncode else Spent(wall, cpu)


def verilator_alone(clone, work):
    """Measures how long Verilator takes for the core fir with a minimal program."""
    program = Path(work, "main.cpp")
    program.write_text(PROGRAM)
    model = spent_by(*"verilator --cc --exe --build -Wno-fatal --top-module fir --Mdir".split(),
                     f"{work}/model", "-f", f"{clone}/build/main/files/fir_slot.f", program)
    run = spent_by(f"{work}/model/Vfir")
    return Spent(model.wall + run.wall, model.cpu + run.cpu)


def edited(text, replacements, name):
    """Returns a text after an edit. Each replacement must fit exactly once."""
    for old, new in replacements:
        if text.count(old) != 1:
            sys.exit(f"edits: {name}: expected '{old}' once, got it {text.count(old)} times")
        text = text.replace(old, new)
    return text


def check():
    """Checks that the edits fit the sources of this tree."""
    for _, _, edit, _ in EDITS:
        if edit and not edit[0].startswith("OWN/"):
            edited((SOURCE / edit[0]).read_text(), edit[1:], edit[0])


def measure(clone, own, words):
    """Measures the edits, each from a tree without other edits. Returns their entries."""
    prepared, entries = set(), []
    for name, command, edit, wanted in EDITS:
        if words and not any(word in name for word in words):
            continue
        command = [str(own / "low_pass") if word == OWN else word for word in command]
        run = [clone / "icesoc", *command]
        if "low_pass" in command and not own.exists():
            spent_by(clone / "icesoc", "core", "new", "low_pass", "--lang", "verilog",
                     "--repository", own)
        if str(command) not in prepared:  # builds everything; an earlier flight needs no cache
            spent_by(*run, cache=True)
            prepared.add(str(command))
        if not edit:
            spent = spent_by(*run)
        else:
            path = own / edit[0].removeprefix("OWN/") if edit[0].startswith("OWN/") \
                else clone / edit[0]
            before = path.read_text()
            path.write_text(edited(before, edit[1:], path))
            spent = spent_by(*run)
            path.write_text(before)
            spent_by(*run)
        print(f"{name}: {spent}", flush=True)
        entries.append(figure(name, round(spent.wall, 1), "s", limit=wanted))
    return entries


def main(output, *words):
    check()
    if "--brief" in words:
        return leave(output, [])
    with tempfile.TemporaryDirectory() as work:
        clone = Path(work, "icesoc")
        spent_by("git", "clone", "--quiet", SOURCE, clone)
        first = spent_by(clone / "icesoc", *TEST_FIR)
        alone = verilator_alone(clone, work)
        print(f"first test of fir in a fresh clone: {first}\nVerilator alone: {alone}", flush=True)
        entries = [figure("first test of fir in a fresh clone", round(first.wall, 1), "s",
                          peer=f"Verilator and a program of one loop: {alone.wall:.1f} s",
                          ratio=first.wall / alone.wall)]
        return leave(output, entries + measure(clone, Path(work, "cores"), words))


main(*sys.argv[1:]) if len(sys.argv) > 1 else sys.exit(__doc__)
