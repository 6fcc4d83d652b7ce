# SPDX-License-Identifier: MIT
"""prove: proves the assertions of a module, and shows that its cover statements are reached.

1. Induction: no assertion ever fails. If the assertions are inductive, k-induction (MiniSat) proves
   this; otherwise property-directed reachability finds and checks an inductive invariant (z3's
   k-induction did not end on 64-bit data).
2. Bounded: if step 1 finds no proof, bounded model checking (BMC) looks for the shortest
   counterexample within DEPTH clocks.
3. Cover: every cover statement is reached within 4 * DEPTH clocks.

The module may instantiate modules of its folder, of bus/, hdl/system/ and hdl/cdc/; in
testbench/sim/, modules of hdl/ddr/ instead of those of its folder. If an assertion fails, the work
folder contains a waveform, trace.vcd. The file `cpu` there has the CPU time, s.
"""
import argparse
import os
import shutil
import sys
from pathlib import Path

from icesoc.proof.design import Module, header
from icesoc.proof.engines import Engines


def parser():
    options = argparse.ArgumentParser(description=__doc__, allow_abbrev=False,
                                      formatter_class=argparse.RawDescriptionHelpFormatter)
    add = options.add_argument
    add("module", metavar="MODULE")
    add("depth", metavar="DEPTH", type=int)
    add("source", metavar="SOURCE", help="folder of the source tree")
    add("work", metavar="WORK", type=Path, help="folder of the results")
    add("commands", metavar="COMMANDS", nargs="?", default="",
        help="Yosys commands that set parameters")
    add("--without", metavar="PATTERNS", default="",
        help="parts to remove, such as */u_arbiter; their outputs are then unconstrained")
    add("--only", metavar="MODULES", default="",
        help="modules whose properties count (default: all)")
    add("--generated", metavar="FOLDER", default=".", help="folder of generated modules")
    add("--bounded", action="store_true", help="prove only that no assertion fails within DEPTH")
    add("--step", metavar="CLOCKS", type=int,
        help="the assertions are inductive over CLOCKS or fewer, but there are too many for "
             "MiniSat: use CaDiCaL for the induction step")
    add("--pdr", metavar="OPTIONS", default="", help="options of abc's pdr that make it faster")
    add("--covered-by", metavar="PROOF", default="",
        help="proof that shows that the cover statements are reached; everything that can happen "
             "in it can happen here as well")
    add("--read", metavar="WORDS", default="", help="further files and macros for read_verilog")
    add("--core", metavar="NAME", help="prove the core NAME in idle_proof.v; --read has its files")
    add("--script", metavar="FILE",
        help="Yosys script that changes the flattened design; it may use idle_registers.v "
             "and idle.ys")
    add("--seconds", metavar="N", type=int, default=300,
        help="limit of CPU time, s; a proof that takes longer fails (default: 300)")
    add("--mutant", metavar="COMMANDS", default="",
        help="Yosys commands that change the module; a failure then has no waveform")
    return options


def words(options, **changed):
    """Returns the words of a command line with these options, some of which are changed."""
    values = {**vars(options), **changed}
    names = "module", "depth", "source", "work", "commands"
    return [*(str(values.pop(name)) for name in names),
            *(f"--{name.replace('_', '-')}" + ("" if value is True else f"={value}")
              for name, value in values.items() if value)]


class Prover:
    """The proof of one module."""
    def __init__(self, options, module):
        self.o, self.module = options, module
        self.engines = Engines(options.work, options.seconds)

    def say(self, text, to=sys.stdout):
        print(f"{self.o.module}: {text}", file=to, flush=True)

    def fail(self, text, log="", status=1):
        """Ends the program. `log`: the engine's output, which is printed first."""
        if log:
            print(self.engines.read(log), end="", flush=True)
        if log and status == 1 and not self.o.mutant:
            for line in self.engines.replay():
                print(line, flush=True)
            if (self.o.work / "trace.vcd").exists():
                self.say(f"trace: {self.o.work.absolute()}/trace.vcd", sys.stderr)
        self.say(text, sys.stderr)
        sys.exit(status)

    def bounded(self, clocks, seconds=None):
        """Fails if an assertion fails within a number of clocks, or as many as can be checked in
        this time."""
        answer = self.engines.bounded(clocks, seconds)
        if answer is None:
            self.fail(f"abc has no answer (see above): is another proof at work in {self.o.work}?",
                      "bounded.log", 2)
        if not answer:
            self.fail(f"an assertion fails within {clocks} clocks", "bounded.log")
        if not seconds:
            self.say(f"bounded, {clocks} clocks")

    def induction(self):
        """Tries to prove that the assertions are inductive. Returns the kind of the proof, or an
        empty text."""
        if self.o.step:
            if not shutil.which("cadical"):
                self.fail("--step needs cadical, which is missing: run ./icesoc setup", status=2)
            # A step of fewer clocks needs a fraction of the time, and is also a proof.
            for clocks in [*(n for n in (4, 8) if n < self.o.step), self.o.step]:
                if self.engines.step(clocks):
                    self.bounded(clocks + 1)
                    return f"induction step of {clocks} clock(s)"
            self.bounded(self.o.step + 1)
            return ""
        steps = 0 if self.module.has_clocks else self.engines.k_induction()
        if not steps:
            return ""
        self.bounded(2)  # the base case begins after the first clock
        return f"{steps - 1} + 1 steps"

    def reachability(self):
        """Proves the assertions by an invariant. Returns the kind of the proof."""
        # an existing failure is found in seconds here; pdr may take minutes
        self.bounded(self.o.depth, 5)
        found = self.engines.reachability(self.o.pdr, self.module.has_clocks)
        if found is None:
            deep = self.o.work / "assert.aiw"
            counterexample = deep.read_text() if deep.exists() else None
            self.bounded(self.o.depth)  # looks for the shortest counterexample
            if counterexample is not None:
                deep.write_text(counterexample)
            self.fail(f"not proven (--seconds {self.o.seconds})", "induction.log")
        return found

    def assertions(self):
        if not header(self.o.work / "assert.aig").latches:
            if not self.engines.without_state():
                self.fail("an assertion fails", "induction.log")
            self.say("proven (it has no state)")
        elif self.o.bounded:
            self.bounded(self.o.depth)
        else:
            self.say("proven, " + (self.induction() or self.reachability()))

    def covers(self):
        names, missing = self.engines.covers(self.o.depth * 4)
        if not names:
            self.fail("no cover statement: nothing shows that the properties are reached")
        for name in missing:
            self.say(f"not reached in {self.o.depth * 4} clocks: {name}", sys.stderr)
        if missing:
            sys.exit(1)
        self.say(f"{len(names)} covers reached")


def main():
    options = parser().parse_args()
    options.work.mkdir(parents=True, exist_ok=True)
    read = options.read.split()
    module = Module(options.module, options.source, options.generated, read)
    module.convert(options.work, module.core(options.core, read) if options.core else read,
                   options)
    prover = Prover(options, module)
    prover.assertions()
    if not options.covered_by:
        prover.covers()
    times = os.times()
    seconds = times.user + times.system + times.children_user + times.children_system
    (options.work / "cpu").write_text(f"{seconds:.1f}\n")  # ./icesoc check proofs adds these up
    prover.say(f"{seconds:.1f} s of CPU time")


if __name__ == "__main__":
    main()
