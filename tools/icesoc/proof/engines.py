# SPDX-License-Identifier: MIT
"""engines: searches for failed assertions with Yosys' SAT solver, abc and CaDiCaL, each with a
limit of CPU time."""
import re
import subprocess
from pathlib import Path

from icesoc.proof import ahead
from icesoc.proof.design import header

INDUCTION = """\
read_rtlil model.il
memory_map
opt_clean
chformal -cover -remove
sat -tempinduct -prove-asserts -set-assumes -seq 1 -maxsteps 4
"""
NO_FAILURE = re.compile("No output failed|No output asserted|Explored all reachable states")
ANSWER = re.compile("output failed|output asserted|was asserted|Explored all reachable states")
ASSERTED = re.compile("was asserted")
PROVED = re.compile("Property proved|UNSATISFIABLE")


class Engines:
    """The engines in a work folder with the models of design.py. Each method returns the log of
    its program, or what it found in the log."""
    def __init__(self, work, seconds):
        self.work, self.seconds = Path(work), seconds

    def run(self, log, *words):
        """Runs a program until the limit of CPU time. Returns its exit status and writes its output
        to a file."""
        with open(self.work / log, "w") as out:
            return subprocess.run(["prlimit", f"--cpu={self.seconds}", *words], cwd=self.work,
                                  stdout=out, stderr=subprocess.STDOUT).returncode

    def read(self, name):
        return (self.work / name).read_text(errors="replace")

    def abc(self, commands, log):
        self.run(log, "yosys-abc", "-c", commands)
        return self.read(log)

    def without_state(self):
        """Returns whether the assertions of a module without flip-flops hold for all inputs."""
        return "UNSATISFIABLE" in self.abc("read_aiger assert.aig; strash; orpos; sat",
                                           "induction.log")

    def k_induction(self):
        """Returns the number of clocks over which the assertions are inductive, with MiniSat; 0 if
        they are not. This takes only a second if they are."""
        (self.work / "induct.ys").write_text(INDUCTION)
        self.run("induct.out", "yosys", "-q", "-l", "induct.log", "induct.ys")
        said = self.read("induct.log")
        return said.count("Induction step failed") + 1 \
            if "Induction step proven: SUCCESS" in said else 0

    def step(self, clocks):
        """Returns whether the assertions are inductive over a number of clocks, with CaDiCaL: no
        assertion fails after this number of clocks without a failure, from any state and under the
        assumptions of all clocks."""
        self.abc(f"read_aiger assert.aig; fold; strash; orpos; frames -F {clocks + 1}; comb; "
                 "write_blif frames.blif", "step.log")
        (self.work / "step.blif").write_text(fails_last(self.read("frames.blif"), clocks + 1))
        (self.work / "step.cnf").unlink(missing_ok=True)
        self.abc("read_blif step.blif; strash; write_cnf step.cnf", "step.log")
        return self.run("step.log", "cadical", "-q", "step.cnf") == 20  # unsatisfiable

    def bounded(self, clocks, seconds=None):
        """Returns whether no assertion fails within a number of clocks, or as many as abc can check
        in this time; None if abc has no answer. The log is bounded.log."""
        limit = f" -T {seconds}" if seconds else ""
        said = self.abc(f"read_aiger assert.aig; fold; strash; bmc3 -F {clocks}{limit}; "
                        "write_cex -a assert.aiw", "bounded.log")
        return bool(NO_FAILURE.search(said)) if ANSWER.search(said) else None

    def reachability(self, options, has_clocks):
        """Returns the size of an inductive invariant that property-directed reachability has found
        and checked; None if it has not found any. The log is induction.log."""
        if has_clocks:
            model = ahead.ahead(ahead.read(self.work / "assert.aig"))
            ahead.write(model, self.work / "ahead.aig")
            said = self.pdr("ahead.aig; fold; retime -M 3 -f", options)
        if not has_clocks or ASSERTED.search(said):  # a counterexample needs the original model
            said = self.pdr("assert.aig; fold", options)
        found = re.search(r"^Invariant[^:]*: (\d* clauses with \d* flops)", said, re.M)
        return (found[1] if found else "no clause needed") if PROVED.search(said) else None

    def pdr(self, model, options):
        # sat: scorr may already find that the output is constant; newer versions of abc then have
        # nothing left to prove
        return self.abc(f"read_aiger {model}; strash; scorr -F 2; pdr {options}; "
                        "write_cex -a assert.aiw; sat", "induction.log")

    def covers(self, clocks):
        """Returns the names of the cover statements, and of those that are not reached within a
        number of clocks."""
        names = [line for line in self.read("cover.names").splitlines() if line]
        if not names:
            return [], []
        # -g selects the solver glucose, which needs a quarter of the time for deep covers
        solve = f"bmc3 -g -F {clocks}" if header(self.work / "cover.aig").latches else "sat"
        # older versions of abc need -s, otherwise they drop the flip-flops of a cone; newer
        # versions have no -s
        has_s = re.search(r"-s  ", self.abc("cone -h", "cone.log"))
        cone = "cone -s" if has_s else "cone"
        # one output at a time, because bmc3 -a can crash with several outputs
        said = self.abc("".join(
            f" echo cover {index}; read_aiger cover.aig; fold; strash; {cone} -O {index}; {solve};"
            for index in range(len(names))), "cover.log")
        parts = re.split(r"^cover (\d+) *$", said, flags=re.M)
        reached = {int(index) for index, part in zip(parts[1::2], parts[2::2])
                   if re.search("was asserted|^SATISFIABLE", part, re.M)}
        return names, [name.partition("/")[2] for index, name in enumerate(names)
                       if index not in reached]

    def replay(self):
        """Replays abc's counterexample with smtbmc, which gives the names of signals and the
        waveform trace.vcd. Returns the failed assertions."""
        try:
            state, *steps = self.read("assert.aiw").splitlines()
        except (OSError, ValueError):
            return []
        inputs = header(self.work / "assert.aig").inputs
        (self.work / "replay.aiw").write_text(
            "\n".join(["1", state, *(line[:inputs] for line in steps)]) + "\n")
        with open(self.work / "trace.log", "w") as log:
            subprocess.run(["timeout", "100", "yosys-smtbmc", "-s", "z3", "--unroll",
                            "--noprogress", "--aig", "assert.map:replay.aiw", "--dump-vcd",
                            "trace.vcd", "model.smt2"], cwd=self.work, stdout=log,
                           stderr=subprocess.STDOUT)
        return re.findall("^.*Assert failed.*$", self.read("trace.log"), re.M)


def fails_last(blif, bads):
    """Returns a circuit with one output, which is 1 if an assertion failed in the last clock and in
    no earlier clock. The first outputs of `blif` show for each clock whether an assertion fails."""
    lines = []
    for line in blif.replace("\\\n", "").splitlines():
        words = line.split()
        if words[:1] == [".outputs"]:
            inputs, line = words[1:1 + bads], ".outputs step"
        elif words[:1] == [".end"]:
            lines += [f".names {' '.join(inputs)} step", f"{'0' * (bads - 1)}1 1"]
        lines.append(line)
    return "\n".join(lines) + "\n"
