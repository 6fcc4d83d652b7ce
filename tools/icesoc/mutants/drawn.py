# SPDX-License-Identifier: MIT
"""drawn: draws mutants of each proven module with Yosys' `mutate`, and expects the module's proof
or its tests to fail (docs/regression.md#drawn-mutants).

The score of a module is the share of mutants that its proofs and tests detect; mutants that are not
bugs do not count. Writes build/mutants/drawn.xml (JUnit). Exit status 1: the score of a module is
too low.
"""
import argparse, collections, functools, json, os, pathlib, re, shutil, subprocess, sys, time
from icesoc import TREE
from icesoc.mutants import model, results, run
from icesoc.mutants.results import GATE
from icesoc.proof import prove
from icesoc.util.cmake import shown_tests
from icesoc.util.lock import only_one
from icesoc.util.process import tool
from icesoc.util.progress import clock, is_tenth
from icesoc.util.rooms import PLATFORM, RTL
from icesoc.util.tree import tree_state
from concurrent.futures import ThreadPoolExecutor

PROVE = "icesoc.proof.prove"  # word of a test command that is a proof
# Programs that test a module; the first expression that matches the module name applies.
TESTS = {
    "bus_": "test_ip_new_foreign", "npi_stream": "test_ip_foreign_axis test_ip_fir",
    "npi_|mcb_": "test_ddr_memory", "axis_filter": "test_ip_foreign_axis",
    "modem_api_": "test_modem_api",
    "modem_": "test_modem test_modem_api", "camera_|async_fifo": "test_ip_camera",
    "fsmc_": "test_fsmc_bridge test_fsmc_modes", "cdc_": "test_fsmc_bridge"}
# s; lower bound of the CPU-time limit for each step of a mutant's proof
SECONDS = "20"
DRAW = """setattr -set keep 1 w:f_*
opt_clean
write_rtlil plain.il
write_json plain.json
select -set proof {module}/t:$ass* {module}/t:$cover {module}/t:$check {module}/t:$any* {lines}
select -set source {module}/c:* @proof %d
mutate -list {number} -seed {seed} -o list @source"""
# Yosys script that prepares the module or its mutant for the comparison. Signals without a driver
# become inputs, so that both sides get the same values.
SIDE = """{change}
chformal -assert -cover -live -fair -remove
{assume}flatten
delete t:$anyseq t:$anyconst t:$allseq t:$allconst
setundef -undriven -expose
{seen}{to_state}memory_map
setundef -zero
setundef -zero -init
rename {module} {name}
design -stash {name}_side
"""
MITER = """design -copy-from plain_side -as plain plain
design -copy-from mutant_side -as mutant mutant
miter -equiv -flatten -make_assert plain mutant pair
hierarchy -top pair
{to_gates}opt_clean
abc -g AND -fast
opt_clean
write_aiger -zinit same.aig
"""


class Proof:
    """A proof in the form in which CTest runs it (tools/icesoc/proof/prove.py)."""
    def __init__(self, test, out):
        self.name, words = test["name"].split(".", 1)[1], test["command"]
        self.options = prove.parser().parse_args(words[words.index(PROVE) + 1:])
        self.module, self.tree = self.options.module, self.options.source
        self.source, self.work = out / "source", out / self.name

    def is_in_tree(self):
        """Returns whether the tree has the module's file, which is otherwise generated."""
        return any(next(pathlib.Path(self.tree, folder).glob(f"**/{self.module}.v"), None)
                   for folder in RTL)

    def run(self, folder, mutant, seconds=None):
        """Runs the proof; `mutant`: Yosys commands that it runs after it has read the files and
        before it converts them. Returns its exit status and output."""
        changed = {"source": self.source, "work": folder, "mutant": mutant}
        changed |= {"seconds": seconds} if seconds else {}
        ran = subprocess.run([*tool("proof.prove"), *prove.words(self.options, **changed)],
                             text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        return ran.returncode, ran.stdout

    def draw(self, number, seed):
        """Proves the unchanged module, and draws its mutants."""
        self.work.mkdir(parents=True, exist_ok=True)
        status, text = self.run(self.work, DRAW.format(
            module=self.module, lines=self.lines_of_proof(), number=4 * number, seed=seed))
        if status:
            sys.exit(f"{text}mutants: formal.{self.name} fails without any mutant; repair this "
                     "first")
        self.design = model.cells(self.work / "plain.json")
        return (self.work / "list").read_text().splitlines()[:number]

    def lines_of_proof(self):
        """Returns the lines of the module's proof in the notation of Yosys' command select. These
        are all lines of the module's file after `ifdef FORMAL or RULES, and all lines of the proof
        files (*_proof.vh) that it includes."""
        lines = next(self.source.glob(f"**/{self.module}.v")).read_text().splitlines()
        first = next((n for n, line in enumerate(lines, 1)
                      if re.fullmatch("`(ifdef|elsif) (FORMAL|RULES)", line)), len(lines))
        return f"{self.module}/a:src=*_proof.vh:* " + " ".join(
            f"{self.module}/a:src=*/{self.module}.v:{n}.*" for n in range(first, len(lines) + 1))

    def differs(self, folder, mutant):
        """Returns whether the mutant's outputs differ from the module's for some input that the
        proof's assumptions allow."""
        # If the proof removes parts of the module, each named wire counts as an output, because a
        # removed part may read the wire.
        seen = "expose w:* w:$* %d\n" if self.options.without else ""
        # commands of the proof that map to flip-flops and gates
        to_state = (self.work / "state.ys").read_text()
        to_gates = (self.work / "gates.ys").read_text()
        side = functools.partial(SIDE.format, module=self.module, seen=seen,
                                 to_state=to_state.replace("setundef -anyseq -undriven\n", ""))
        (folder / "same.ys").write_text(
            f"read_rtlil {self.work}/plain.il\ndesign -save plain\n"
            + side(change="", assume="", name="plain") + "design -load plain\n"
            + side(change=mutant, assume="chformal -assume -remove\n", name="mutant")
            + MITER.format(to_gates=to_gates))

        def limited(command):
            return subprocess.run(["sh", "-c", f"ulimit -t {SECONDS}; exec {command}"], cwd=folder,
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)

        made = limited("yosys -q same.ys")
        (folder / "same.log").write_text(made.stdout)
        if made.returncode:
            return True  # Yosys 0.23 fails on some memories; such a mutant counts as different
        steps = "read_aiger same.aig; fold; strash; scorr -F 2; pdr; sat"
        said = limited(f"yosys-abc -c '{steps}'").stdout
        return not re.search("Property proved|UNSATISFIABLE", said)


def attempt(proof, index, mutant):
    """Tries one mutant, and returns its result."""
    start = time.monotonic()
    folder = proof.work / str(index)
    # A proof that exceeds the limit counts as failed. The limit is four times the CPU time of the
    # proof without a mutant, so that a mutant that only makes the proof slower does not count as
    # caught.
    limit = max(int(SECONDS), int(4 * float((proof.work / "cpu").read_text())))
    status, text = proof.run(folder, mutant, str(limit))
    if status and not re.search("an assertion fails|not proven|not reached", text):
        print(f"{text}mutants: formal.{proof.name}: {mutant}: does not run", file=sys.stderr)
        result = "BROKEN"
    else:
        result = "caught" if status else "SURVIVED" if proof.differs(folder, mutant) else "same"
    said = re.findall(r"-(\w+) (\S+)", mutant)
    first = dict(reversed(said))  # an option may occur more than once; the first value counts
    source = dict(said).get("src")
    line = re.sub(r"(:\d+)\..*", r"\1", os.path.relpath(source, proof.source)) if source else ""
    cell = first["cell"].split("$")
    does = f"{first['mode']} {cell[1 if len(cell) > 1 else 0]}.{first['port']}[{first['portbit']}]"
    if "wire" in first:
        does += f" ({first['wire']}[{first['wirebit']}])"
    alike, number = model.place(proof.design, first["module"], first["cell"])
    facts = {"module": first["module"], "does": does, "alike": alike, "place": number}
    facts |= {name: first.get(name, "0") for name in ("mode", "port", "portbit", "ctrlbit")}
    (folder / "mutant").write_text(mutant + "\n")
    return results.Mutant(f"{first['module']}/{proof.name}.{index}", result,
                          f"formal.{proof.name}", time.monotonic() - start, line, facts)


def programs(row):
    return next((names.split() for module, names in TESTS.items()
                 if re.match(module, row.more["module"])), [])


def modules_of(program, build):
    """Returns the names of the modules in the Verilated models of a program."""
    inputs = subprocess.check_output(["ninja", "-C", build, "-t", "inputs", program], text=True)
    lists = [build / path.rpartition("/")[0] / model.MODULES
             for path in inputs.splitlines() if path.endswith("__ALL.a")]
    return {name for path in lists if path.exists() for name in path.read_text().split()}


def by_tests(rows, copy, pool):
    """Runs the modules' tests on the mutants that the proofs missed. If a test catches a mutant,
    changes the mutant's result and test. Returns the test programs that fail even without a
    mutant, or that do not contain the module that they should test."""
    os.chdir(run.TOP)
    run.prepare(copy, f"-DVERILATOR={TREE}/tools/icesoc/mutants/model.py")
    results.write(copy / "build/drawn.xml", rows)
    needed = sorted({name for row in rows for name in programs(row)})
    environment = {**run.environment(copy), "DRAWN": str(copy / "build/drawn.xml")}
    for old in copy.glob("build/main/**/V*__ver.d"):  # so that each model is written with mutants
        old.unlink()
    with open(copy / "build/log", "w") as log:
        if subprocess.run(["ninja", "-C", "build/main", *needed], cwd=copy, env=environment,
                          stdout=log, stderr=log).returncode:
            print("mutants: the tests' programs do not build with mutants in their models, so they "
                  f"caught none: see {log.name}", file=sys.stderr)
            return needed
    where = {name: next(copy.glob(f"build/main/**/{name}")) for name in needed}

    def fails(name, number):
        log = copy / "build" / f"{name}.{number}.log"
        with open(log, "w") as out:
            limited = 'ulimit -t 300; exec "$0" --gtest_fail_fast --gtest_brief=1'
            failed = subprocess.run(["sh", "-c", limited, where[name]], cwd=where[name].parent,
                                    env={**environment, "MUTANT": str(number)}, stdout=out,
                                    stderr=out).returncode != 0
        if number or not failed:
            log.unlink()
        return failed

    bad = [name for name, failed in zip(needed, pool.map(fails, needed, [0] * len(needed)))
           if failed]

    def caught_by(row, number):
        found = (name for name in programs(row) if name not in bad and fails(name, number))
        return next(found, "")

    for row, test in zip(rows, pool.map(caught_by, rows, range(1, len(rows) + 1))):
        if test:
            row.result, row.test = "caught", test
    contents = {name: modules_of(name, copy / "build/main") for name in needed}
    lacking = sorted({(name, row.more["module"]) for row in rows for name in programs(row)
                      if row.more["module"] not in contents[name]})
    for name, module in lacking:
        print(f"mutants: {name} does not contain {module}, so it cannot catch its mutants: correct "
              "TESTS in tools/icesoc/mutants/drawn.py", file=sys.stderr)
    for name in bad:
        path = copy / "build" / f"{name}.0.log"
        print(f"{path.read_text(errors='replace')}mutants: {name} fails without any mutant, so it "
              f"caught none; repair the test first ({path})", file=sys.stderr)
    return bad + [name for name, _ in lacking]


def progress(tried, number):
    """Returns the results in `tried` as a list. Prints the progress after each tenth."""
    start, rows = time.monotonic(), []
    for row in tried:
        rows.append(row)
        done = len(rows)
        left = round((time.monotonic() - start) / done * (number - done) / 60)
        if is_tenth(done, number):
            missed = sum(row.result == "SURVIVED" for row in rows)
            print(f"{done} of {number} mutants tried, {missed} not detected by a proof, "
                  f"{clock(left)} h left", file=sys.stderr, flush=True)
    return rows


def measure(proofs, options, out):
    source = pathlib.Path(proofs[0].tree)
    # state of the measured tree, for the status of mutants in the regression
    tree = tree_state(source, " ".join((*PLATFORM, "tests")))
    # A copy of the tree is used, because any edit during the run would change the names of cells.
    shutil.rmtree(out / "drawn", ignore_errors=True)
    for folder in RTL:
        shutil.copytree(source / folder, out / "drawn/source" / folder)
    with ThreadPoolExecutor(options.jobs) as pool:
        lists = list(pool.map(lambda proof: proof.draw(options.number, options.seed), proofs))
        tasks = [(p, i, m) for p, drawn in zip(proofs, lists) for i, m in enumerate(drawn)]
        try:
            rows = progress(pool.map(lambda task: attempt(*task), tasks), len(tasks))
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise
        missed = [row for row in rows if row.result == "SURVIVED" and programs(row)]
        failing = by_tests(missed, run.WORK / "model", pool) if missed else []
    for row in rows:
        if row.result in ("SURVIVED", "BROKEN"):
            print(f"{row.result:<9} {row.test:<25} {row.place} {row.more['does']}", flush=True)
    scores = results.scores(rows)
    bad = [module for module, score in scores.items() if score["score"] < GATE]
    results.write(out / "drawn.xml", rows, seed=options.seed, tree=tree)
    line = "{score:5.1f} %  {caught:3} caught of {judged:3}, {by_tests} of them by tests, {same} "
    for module, score in scores.items():
        print(f"{module:<22} {line.format(**score)}the same")
    total = collections.Counter()
    for score in scores.values():
        total.update(score)
    print("mutants: {caught} of {judged} drawn with seed {seed} caught, {by_tests} of them by "
          "tests, {same} the same as the module".format(seed=options.seed, **total)
          + (f"; below {GATE} %: {', '.join(bad)}" if bad else ""))
    broken = sum(row.result == "BROKEN" for row in rows)
    if broken:
        print(f"mutants: {broken} do not run, see above")
    return bool(bad or failing or broken)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build/main", help="build folder with the proofs")
    parser.add_argument("--out", default="build/mutants", help="output folder of results")
    parser.add_argument("--block", default="",
                        help="regular expression of the proofs (default: all)")
    parser.add_argument("--number", type=int, default=20, help="number of mutants per proof")
    parser.add_argument("--seed", default="1", help="seed of the random numbers")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(),
                        help="number of mutants tried in parallel")
    options = parser.parse_args()
    out = pathlib.Path(options.out).resolve()
    status, text = shown_tests(options.build, "--show-only=json-v1", "-R",
                               rf"^formal\.({options.block})")
    if status:
        sys.exit(f"mutants: --build: expected a build folder, got '{options.build}'; run "
                 "`./icesoc build` first")
    proofs = [Proof(test, out / "drawn") for test in json.loads(text[text.index("{"):])["tests"]
              if PROVE in test["command"]]
    # Proofs of several modules together, and proofs of generated modules, are left out.
    proofs = [proof for proof in proofs
              if not proof.module.endswith("_proof") and proof.is_in_tree()]
    if not proofs:
        sys.exit(f"mutants: no proof has a name that begins with {options.block}: "
                 f"{options.build}/tests/regress/regress --list --label formal lists them")
    with only_one(out, "mutants"):
        return measure(proofs, options, out)


if __name__ == "__main__":
    sys.exit(main())
