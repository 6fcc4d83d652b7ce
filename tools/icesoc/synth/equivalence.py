# SPDX-License-Identifier: MIT
"""equivalence: proves that a netlist behaves like its RTL in each clock, starting with the first.

Yosys puts the netlist and the RTL side by side, with one output that is high if any of their
outputs differ (synth/yosys/equivalence.ys). abc first finds registers that are always equal
(lcorr), then other equal signals (scorr). It then looks for a clock in which an output differs
(bmc3), and for a proof (pdr). Initial values that the RTL leaves undefined are taken from the
netlist's flip-flops; other undefined values are 0. If there are several clocks, their edges are
inputs of the problem, so the proof covers any order of edges.
"""
import json
import pathlib
import re
import sys
import time
import xml.etree.ElementTree

from icesoc.synth import batch
from icesoc.synth import netlist
from icesoc.synth import report
from icesoc.synth import synthesis
from icesoc.util.errors import Stop
from icesoc.util.files import digest, write
from icesoc.util.process import collect as command

# clock primitives; they are the same in RTL and netlist, and the logic around them is proven
BOXES = {"DCM_CLKGEN", "BUFGCE"}
SOLVE = """read_rtlil {file}
splitnets
setattr -unset init w:*
{initial}
{clocks}
setundef -init -zero
setundef -zero
opt_clean
simplemap
techmap
simplemap
setundef -zero
dfflegalize -cell $_DFF_P_ 01
aigmap
opt_clean
write_aiger -zinit {file}.aig
"""
# Simulates one clock in reset. Otherwise a one-hot state register might begin with no state, which
# never happens in the RTL.
IN_RESET = "sim -clock in_clk_i -reset in_rst_i -rstlen 1 -n 1 -zinit -w miter"


def attributes_of(module):
    """Returns the Yosys commands that set registers to 1 initially, and whether all registers use
    the rising edge of one clock. The initial value of a register comes from the RTL, or from the
    netlist if the RTL does not define it."""
    begin, ones, nets = {}, {}, module["netnames"]
    for net in nets.values():
        for bit, value in zip(net["bits"], reversed(net["attributes"].get("init", ""))):
            if value in "01":
                begin[bit] = value
    for name, net in nets.items():
        twin = nets.get(name.replace("gold.", "gate.", 1), net)
        for place, bit in enumerate(net["bits"]):
            other = twin["bits"][place] if len(twin["bits"]) == len(net["bits"]) else bit
            if begin.get(bit, other if other in ("0", "1") else begin.get(other)) == "1":
                index = net.get("offset", 0) + place
                ones[bit] = f"{name}[{index}]" if len(net["bits"]) > 1 else name
    commands = [f"setattr -set init 1'1 w:{name}" for bit, name in ones.items() if bit != "1"]
    kinds = {(*c["connections"].get("CLK", [None]), c["parameters"].get("CLK_POLARITY", "")[-1:])
             for c in module["cells"].values() if re.match(r"\$a?l?dff", c["type"])}
    plain = not any(re.match(r"\$(a|al)dff|\$dlatch", c["type"]) for c in module["cells"].values())
    return commands, len(kinds) <= 1 and plain and all(kind[1] == "1" for kind in kinds)


def prove(design, family, library, options, models, seconds):
    """Proves a design within this number of seconds. Returns (result, whether the netlist is
    equivalent, seconds used). Decided results are stored for the next run."""
    begin, run = time.monotonic(), synthesis.mapped(design, family, library, options)
    files = (run.netlist, *models, pathlib.Path(__file__), pathlib.Path(netlist.__file__),
             options.scripts / "equivalence.ys", options.scripts / "product.v")
    known = digest([library.hash_of(design.top), synthesis.version_of(options.yosys),
                    *(file.read_text() for file in files)])
    kept = run.netlist.with_suffix(f".{known}.proof")
    if kept.exists():
        return json.loads(kept.read_text())
    said, good = proof(run.netlist, design, family, library, options, models, seconds)
    result = said, good, time.monotonic() - begin
    if not said.startswith("undecided"):
        write(kept, json.dumps(result))
    return result


def proof(mapped, design, family, library, options, models, seconds):
    file, text = options.cache / f"{design.name}.{family}.miter", netlist.with_models(mapped)
    write(file.with_suffix(".netlist"), text)
    boxes = BOXES & set(re.findall(r'"type": "(\w+)"', text))
    words = {
        "NETLIST": file.with_suffix(".netlist"), "MODELS": " ".join(map(str, models)),
        "SIMULATION": synthesis.SIMULATION[family], "PRODUCT": options.scripts / "product.v",
        "BOXES": "read_verilog -lib +/xilinx/cells_xtra.v" if boxes else ""}

    def script(part):
        return synthesis.filled(synthesis.script_of(
            synthesis.Run(design, "equivalence", netlist=file), library, options, part), words)

    synthesis.yosys_by(script, file, options)
    part = json.loads((file.parent / f"{file.name}.part.json").read_text())["modules"]["miter"]
    commands, is_plain = attributes_of(part)
    said = solved(file, commands, is_plain, options, seconds)
    if said and is_plain and "in_rst_i" in part["ports"]:
        again = solved(file, [*commands, IN_RESET], is_plain, options, seconds)
        return again or "proven after a reset", not again
    return said or "proven", not said


def solved(file, commands, is_plain, options, seconds):
    """Returns "" if the output is never high, otherwise a text with the result of the solvers."""
    write(solve := file.with_suffix(".solve.ys"),
          SOLVE.format(file=file, initial="\n".join(commands),
                       clocks="" if is_plain else "clk2fflogic"))
    status, said = command([options.yosys, "-q", "-s", solve])
    if status:
        raise Stop(said)
    with open(f"{file}.aig", "rb") as aiger:
        has_state = aiger.readline().split()[3] != b"0"
    # bmc3 finds most differences within a second, scorr proves most netlists that are equal, and
    # bmc3 and pdr then decide the others. If scorr has removed all registers, newer versions of
    # pdr give no result, and sat is used instead. The option -T limits only the wall-clock time,
    # which depends on the load of the machine; ulimit limits the CPU time.
    whole, less = f"{file}.aig", f"{file}.less.aig"
    steps = ([(whole, "bmc3 -F 20 -T 1"),
              (whole, f"lcorr -C 30000; scorr; write_aiger {less}; bmc3 -F 50 -T {seconds // 5}"),
              (less, f"pdr -T {9 * seconds}; sat")] if has_state else
             [(whole, "ifraig; iprove; sat")])
    for source, step in steps:
        said = command(["sh", "-c", f"ulimit -t {seconds + 60}; {options.yosys}-abc -c "
                        f"'read_aiger {source}; strash; {step}'"])[1]
        write(file.with_suffix(".abc.log"), said)
        differs = re.search(r"asserted in frame (\d+)", said)
        if differs:
            return f"differs after {differs[1]} clocks"
        if re.search("Property proved|UNSATISFIABLE", said):
            return ""
    return "differs" if "SATISFIABLE" in said else f"undecided in {seconds} s"


def simulated(tests, junit):
    """Evaluates the tests with these prefixes in a JUnit file. Returns (text with the result,
    whether tests of every prefix ran and all passed, duration in s)."""
    cases = list(xml.etree.ElementTree.parse(junit).iter("testcase")) if junit else []
    of = {prefix: [case for case in cases if re.match(f"{prefix}[^a-z_]", case.get("name"))]
          for prefix in tests.split()}
    cases = [case for some in of.values() for case in some]
    red = sum(case.get("status") != "run" for case in cases)
    missing = [prefix for prefix, some in of.items() if not some]
    said = f"simulated by {tests}: {len(cases)} tests" + f", {red} failed" * bool(red)
    return (said + f", none of {', '.join(missing)}" * bool(missing), not red and not missing,
            sum(float(case.get("time")) for case in cases))


def table_of(plan, library, options, models, o):
    """Returns (rows, number of failures). A row is a design with the result of its proof, or of the
    tests of its block on its netlist. Small designs come first; each result is printed when it is
    known."""
    rows, failed = {}, []

    def work(design):
        begin = time.monotonic()
        try:
            tests = plan.simulated.get(design.name)
            said, good, spent = simulated(tests, o.junit) if tests else prove(
                design, o.family[-1], library, options, models, o.seconds)
        except (Stop, ValueError) as error:
            said, good, spent = str(error).partition("\n")[0], False, time.monotonic() - begin
        rows[design.name] = [design.name, said, f"{spent:.1f}"]
        failed.extend([design.name] * (not good))
        print(f"[{len(rows)}/{len(designs)}] {design.name}: {said} ({spent:.1f} s)",
              file=sys.stderr)

    designs = [design for design in plan.designs if plan.has(design, o.family[-1])
               and (not o.design or design.name in o.design)]
    batch.in_parallel(options.jobs, work, sorted(
        designs, key=lambda design: options.luts.get(design.name, 0)))
    return report.Table(["module", "proof or tests", "seconds"],
                        [rows[name] for name in sorted(rows)]), len(failed)
