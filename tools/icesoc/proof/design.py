# SPDX-License-Identifier: MIT
"""design: converts a module and its properties to the models on which the engines work.

A model of the module for AIGER has one flip-flop type and no initial values other than 0. Its files
in the work folder are assert.aig, with the assertions, and cover.aig, in which each cover statement
is an assertion that must fail; model.il and model.smt2 have all properties."""
import re
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from icesoc import TREE

# Converts a hierarchy to one module with flip-flops of one clock. Undefined values, such as the
# value of a flip-flop without a clock, become unconstrained, because newer AIGER backends reject
# them.
TO_STATE = """\
flatten
prep -top {module} -nordff
memory_nordff
{clocks}
dffunmap
chformal -early
{change}
setundef -anyseq -undriven
opt_clean
check -assert
"""
# Converts flip-flops to AIGER's gates. -nosdff -nodffe: AIGER has only plain flip-flops. The
# module's outputs are removed, because abc would treat them as properties.
TO_GATES = """\
memory_map; opt -full; setundef -anyseq; techmap; opt -fast -nosdff -nodffe
dfflegalize -cell $_DFF_P_ 01; delete -output w:*
"""
MODELS = """\
verilog_defaults -add -formal -sv -DRULES {includes}
read_verilog {read} {files}
{commands}
{parts}
hierarchy -top {module} -libdir {generated}
proc
{mutant}
script state.ys
write_smt2 -wires model.smt2
write_rtlil model.il
script gates.ys
design -save gates
chformal -cover -remove
opt_clean; abc -g AND -fast; opt_clean; write_aiger -zinit -map assert.map assert.aig
design -load gates
select -write cover.names t:$cover
chformal -assert -live -fair -remove
techmap -map cover.v t:$cover
simplemap
opt_clean; abc -g AND -fast; opt_clean; write_aiger -zinit -map cover.map cover.aig
"""
COVER = """\
module \\$cover (input A, input EN);
    \\$assert _TECHMAP_REPLACE_ (.A(~A), .EN(EN));
endmodule
"""


@dataclass
class Header:
    """The header of an AIGER file."""
    inputs: int
    latches: int


def header(path):
    with open(path, "rb") as file:
        words = file.readline().split()
    return Header(int(words[2]), int(words[3]))


def named_files(files, modules, folders):
    """Returns the given files and all files to which they refer, directly or through other files:
    files of the modules whose names they contain, and included files (*.vh) of the folders."""
    found, todo = set(), list(files)
    while todo:
        file = todo.pop()
        if file in found:
            continue
        found.add(file)
        for word in re.findall(r"//.*|(\w+(?:\.vh\b)?)", file.read_text()):
            if word in modules:
                todo.append(modules[word])
            elif word.endswith(".vh"):
                todo += [path for folder in folders if (path := folder / word).exists()]
    return found


class Module:
    """The module to prove: its file, and the files of the modules that it instantiates. `read`:
    files and macros that read_verilog gets in addition."""
    def __init__(self, name, source, generated, read):
        self.name = name
        self.source, self.generated = Path(source).absolute(), Path(generated).absolute()
        bus, system, cdc, ddr, sim = (self.source / folder for folder in (
            "bus", "hdl/system", "hdl/cdc", "hdl/ddr", "testbench/sim"))
        self.includes = [self.generated, bus, ddr, system, sim]
        found = [file for folder in (bus, self.source / "hdl", self.source / "ip", sim)
                 for file in folder.rglob(f"{name}.v")]
        if not found and (self.generated / f"{name}.v").exists():
            self.file, folders = self.generated / f"{name}.v", [bus]
        elif not found:
            print(f"{name}: no {name}.v below bus, hdl, ip or testbench/sim", file=sys.stderr)
            sys.exit(2)
        else:
            self.file = found[0]
            # a proof of the simulator uses the modules of the memory controller
            folders = [bus, system, cdc, ddr if self.file.parent == sim else self.file.parent]
        # Only files that the proof needs are read, because Yosys is slow, and because a cached
        # result is lost if any of its files changes.
        modules = {file.stem: file for folder in [self.generated, *folders]
                   for file in folder.glob("*.v")}
        extra = {Path(word) for word in read if word.endswith(".v")}
        named = named_files({self.file, *extra}, modules, [self.file.parent, *self.includes])
        self.files = sorted(file for file in named - extra if file.suffix == ".v" and
                            (file == self.file or file.parent in folders))
        # In a proof with several clocks (`gclk`), every edge is a separate input.
        self.has_clocks = "gclk" in self.file.read_text()

    def core(self, name, files):
        """Returns the arguments of read_verilog for the proof of a core in idle_proof.v."""
        words = [f"-DCORE={name}", *files, str(self.source / "hdl/ddr/npi_stream.v")]
        if any(re.search("memory_ports|npi_addr_o", Path(file).read_text()) for file in files):
            words.insert(0, "-DMEMORY")
        rules = self.source / "ip" / name / "idle_rules.vh"  # invariants of a core in VHDL
        if rules.exists():
            words.insert(0, f'-DIDLE_RULES="{rules}"')
        return words

    def parts(self, without, only):
        """Returns the Yosys commands that remove parts, and the properties of modules that do not
        count. A removed part leaves its outputs unconstrained. Both are patterns of Yosys'
        command `select`."""
        commands = [f"hierarchy -top {self.name}"] if without or only else []
        if without:
            commands.append(f"delete {without}")
        if only:
            union = " %u" * (len(only.split()) - 1)
            commands.append(f"chformal -remove * {only}{union} %d")
        return "\n".join(commands)

    def convert(self, work, read, o):
        """Writes the models to the work folder, for the options of prove.py. Ends the program with
        Yosys' messages if it fails. The parts of the Yosys script, state.ys and gates.ys, can be
        used for other models."""
        for kind in "aig", "map", "aiw", "vcd":
            for old in work.glob(f"*.{kind}"):
                old.unlink()
        if o.script:
            for part in "idle_registers.v", "idle.ys":
                shutil.copy(TREE / "tests/hdl/formal" / part, work)
        (work / "state.ys").write_text(TO_STATE.format(
            module=self.name, change=f"script {o.script}" if o.script else "",
            clocks="memory_map; clk2fflogic" if self.has_clocks else "async2sync"))
        (work / "gates.ys").write_text(TO_GATES)
        (work / "cover.v").write_text(COVER)
        (work / "prove.ys").write_text(MODELS.format(
            module=self.name, generated=self.generated, commands=o.commands, mutant=o.mutant,
            parts=self.parts(o.without, o.only),
            includes=" ".join(f"-I{folder}" for folder in self.includes),
            read=" ".join(read), files=" ".join(map(str, self.files))))
        ran = subprocess.run(["yosys", "-q", "prove.ys"], cwd=work, text=True, errors="replace",
                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        (work / "yosys.log").write_text(ran.stdout)
        if ran.returncode:
            print(ran.stdout, end="")
            print(f"{self.name}: Yosys cannot read the module (above)", file=sys.stderr)
            sys.exit(2)
