#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Replaces Verilator when tests are run with drawn mutants. A model contains all mutants of its
modules. When a test begins, the environment variable MUTANT selects one by number. Without MUTANT
the module is unchanged.

drawn.py draws a mutant in the module as the proof reads it: a change of one bit of one cell. In the
model, the same cell is found by its kind, its source line, its signal (flip-flops only), and its
position among the cells with the same three properties. If the cell has fewer bits in the model,
the last bit is changed. The environment variable DRAWN is the path of the results that drawn.py has
written.
"""
import collections, json, os, pathlib, re, shutil, subprocess, sys, tempfile

from icesoc.mutants import results
from icesoc.util.rooms import RTL

NUMBER = """module mutant_number(output reg [15:0] number);
    initial number = $c("(std::getenv(\\"MUTANT\\") ? std::atoi(std::getenv(\\"MUTANT\\")) : 0)");
endmodule
"""
READ = """verilog_defaults -add -sv {includes}
read_verilog {sources}
{parameters}hierarchy -top {top}{folders}
proc
write_rtlil {folder}/plain.il
write_json {folder}/plain.json
"""
CHOICE = r"""  wire width 16 \mutant
  cell \mutant_number \u_mutant
    connect \number \mutant
  end
"""
MODULES = "modules"  # file in a model's folder with the names of the model's modules
WRITE = """read_rtlil {folder}/plain.il
{mutations}opt_expr
opt_reduce
opt_merge
splitnets w:*_EN*
opt_clean
write_verilog -noattr {folder}/{top}.v
"""


def module_of(name):
    """Returns the name of a module without the suffix for its parameters."""
    return re.sub(r"^\$paramod(\$[0-9a-f]+)?\\(\w+).*", r"\2", name)


def cells(path):
    """Returns the cells of a design in Yosys' JSON as {module: {kind and source line: [(cell, width
    of each port)]}}. The cells are in the order of their creation. The kind of a flip-flop includes
    its signal, because the order of the flip-flops of a line depends on other modules."""
    def made(item):
        return int((re.findall(r"\$(\d+)$", item[0]) or [0])[0])

    found = {}
    for module, content in json.loads(pathlib.Path(path).read_text())["modules"].items():
        alike = found[module] = collections.defaultdict(list)
        signals = {}  # bit -> its name and index; if it has several names, the first one
        for name, net in sorted(content["netnames"].items()):
            for index, bit in enumerate(net["bits"] if not net["hide_name"] else []):
                signals.setdefault(bit, f" {name}[{index}]")
        for name, cell in sorted(content["cells"].items(), key=made):
            # The cell itself has the last of several locations. Yosys puts the location of a
            # condition that it could not resolve before the cell's location.
            source = cell["attributes"].get("src", "").split("|")[-1]
            source = re.sub(rf".*/(({'|'.join(RTL)})/)", r"\1", source)
            widths = {port: len(bits) for port, bits in cell["connections"].items()}
            signal = signals.get(cell["connections"].get("Q", [""])[0], "")
            alike[f"{module_of(cell['type'])} {source}{signal}"].append((name, widths))
    return found


def place(design, module, cell):
    """Returns the kind and source line of a cell, and the cell's index among the cells with the
    same kind and line."""
    for alike, names in design[module].items():
        for number, (name, _) in enumerate(names):
            if name == cell:
                return alike, number
    return "", 0


def yosys(folder, script):
    with open(f"{folder}/script.ys", "w") as file:
        file.write(script)
    subprocess.run(["yosys", "-q", "-s", f"{folder}/script.ys"], check=True)


def mutated(arguments, folder):
    """Writes a file with a model's modules, including all their mutants, and a list of the modules
    to the model's folder. Returns the path of the file, or None if the modules have no mutants, or
    if Yosys cannot read them."""
    def of(flag):
        return [a.removeprefix(flag) for a in arguments if a.startswith(flag)]

    top = arguments[arguments.index("--top-module") + 1]
    sources = [a for a in arguments if a.endswith(".v")]
    folders = "".join(f" -libdir {arguments[i + 1]}" for i, a in enumerate(arguments) if a == "-y")
    parameters = "".join(f"chparam -set {p.replace('=', ' ')} {top}\n" for p in of("-G"))
    try:
        yosys(folder, READ.format(includes=" ".join(f"-I{d}" for d in of("-I")), top=top,
                                  folder=folder, sources=" ".join(sources), parameters=parameters,
                                  folders=folders))
    except subprocess.CalledProcessError:
        print(f"mutants: Yosys cannot read {top}: its model has no mutants", file=sys.stderr)
        return None
    design = cells(f"{folder}/plain.json")
    made = pathlib.Path(arguments[arguments.index("--Mdir") + 1])
    made.mkdir(parents=True, exist_ok=True)
    (made / MODULES).write_text("\n".join(sorted(set(map(module_of, design)))))
    mutations, has = "", set()
    for number, drawn in enumerate(results.read(os.environ["DRAWN"])[1], 1):
        mutant = drawn.more
        for module in design:
            like = design[module].get(mutant["alike"])
            if not like or module_of(module) != mutant["module"]:
                continue
            cell, ports = like[int(mutant["place"]) % len(like)]
            mode, port = mutant["mode"], mutant["port"]
            bit, control = (min(int(mutant[b]), ports[port] - 1) for b in ("portbit", "ctrlbit"))
            has.add(module)
            mutations += (f"mutate -mode {mode} -module {module} -cell {cell} -port {port} "
                          f"-portbit {bit} -ctrlbit {control} -ctrl mutant 16 {number}\n")
    if not has:
        return None
    lines = []
    for line in open(f"{folder}/plain.il"):
        lines.append(line)
        if line.startswith("module ") and line.split()[1].lstrip("\\") in has:
            lines.append(CHOICE)
    with open(f"{folder}/plain.il", "w") as file:
        file.writelines(lines)
    yosys(folder, WRITE.format(mutations=mutations, top=top, folder=folder))
    with open(f"{folder}/{top}.v", "a") as file:
        file.write(NUMBER)
    return f"{folder}/{top}.v"


def main():
    arguments = sys.argv[1:]
    if "--cc" in arguments:
        with tempfile.TemporaryDirectory() as folder:
            if file := mutated(arguments, folder):
                kept = [a for a in arguments if not re.match(r"-G|.*\.v$|-Wall$", a)]
                given = dict(zip(arguments, arguments[1:]))
                # the file is kept, because the build reads it again (cmake/files.cmake)
                file = shutil.copy(file, given["--Mdir"])
                status = subprocess.call(["verilator", *kept, "-Wno-fatal", "-Wno-lint",
                                          "-Wno-style", file])
                makefile = pathlib.Path(given["--Mdir"], given["--prefix"] + ".mk")
                # -O1, because the model is compiled once and runs only for seconds
                makefile.write_text("override OPT_FAST = -O1\n" + makefile.read_text())
                return status
    os.execvp("verilator", ["verilator", *arguments])


if __name__ == "__main__":
    sys.exit(main())
