# SPDX-License-Identifier: MIT
"""Plants each seeded bug in a copy of the tree, and expects the test that the bug names to fail.

The bugs of a block are in tests/mutants/<block>.bugs.json, the bugs of a core in
ip/<core>/<core>.bugs.json:

    "name": {"does": "What the bug does, in a sentence.",
      "test": "the test that catches it, as ctest names it", "file": "hdl/some/file.v",
      "old": "the line of the file that is replaced, or a list of lines",
      "new": "the line, or lines, that replace it",
      "more": [{"old": "...", "new": "..."}]}

The old lines must occur exactly once in the file. "more" changes further places; a "file" in it
names another file.

Writes build/mutants/planted.xml (JUnit).
Exit status 1: a bug survived, is no longer found in its file, or does not build.
"""
import argparse, collections, glob, json, os, pathlib, queue, re, shutil, subprocess, sys
import threading, time
from concurrent.futures import ThreadPoolExecutor

from icesoc.mutants import results
from icesoc.util.cmake import shown_tests
from icesoc.util.errors import reason_of
from icesoc.util.lock import only_one
from icesoc.util.rooms import MEASURED
from icesoc.util.tree import tree_state, write_state

TOP = pathlib.Path.cwd()  # the tree

WORK = TOP / "build/mutants"


class Bug:
    def __init__(self, name, said):
        self.name, self.test, self.does, file = name, said["test"], said["does"], said["file"]
        self.changes = []  # (file, old lines, new lines) of each change
        for change in [said, *said.get("more", [])]:
            file = change.get("file", file)
            self.changes.append((file, *([lines] if isinstance(lines, str) else lines
                                         for lines in (change["old"], change["new"]))))

    def place(self, root):
        """Returns file:line of the first change, in the file without the bug."""
        file, before, _ = self.changes[0]
        lines = (root / file).read_text().split("\n")
        starts = [i for i in range(len(lines)) if lines[i:i + len(before)] == before]
        return f"{file}:{starts[0] + 1}"

    def planted(self, root):
        """Returns the texts of the files with the bug; raises ValueError if the bug does not fit
        the files."""
        texts = {}
        for file, before, after in self.changes:
            text = texts.get(file) or "\n" + (root / file).read_text()
            old, new = ("\n" + "".join(line + "\n" for line in part) for part in (before, after))
            if text.count(old) != 1 or old == new:
                raise ValueError(f"its lines occur {text.count(old)} times in {file}; expected "
                                 "once; update them to the current source")
            texts[file] = text.replace(old, new)
        return {file: text[1:] for file, text in texts.items()}


def read_bugs(block="*"):
    """Returns the bugs of a block; `*`: of all blocks."""
    found = []
    for file in sorted(glob.glob(f"tests/mutants/{block}.bugs.json")
                       + glob.glob(f"ip/{block}/{block}.bugs.json")):
        try:
            found += [Bug(f"{pathlib.Path(file).name.split('.')[0]}/{name}", said)
                      for name, said in json.loads(pathlib.Path(file).read_text()).items()]
        except (ValueError, LookupError, TypeError, AttributeError) as error:
            sys.exit(f"mutants: {file}: expected bugs in the format that `tools/python -m "
                     f"icesoc.mutants.run --help` shows: {reason_of(error)}")
    return found


def bugs(chosen):
    """Returns the bugs of a block (`*`: of all blocks), or the bug block/name."""
    block, _, name = chosen.partition("/")
    found = [bug for bug in read_bugs(block) if not name or bug.name == chosen]
    return found or sys.exit(f"mutants: no {chosen} in tests/mutants/*.json and ip/*/*.bugs.json")


def prepare(copy, *options):
    """Creates a copy of the tree for a worker, with a separate build folder."""
    copy.mkdir(parents=True, exist_ok=True)
    for kept in copy.rglob("*.orig"):  # an interrupted run leaves such files
        restore(kept.with_suffix(""))
    listed = subprocess.run(
        ["git", "grep", "--no-index", "--exclude-standard", "--no-color", "-lz", ""],
        stdout=subprocess.PIPE, check=True)
    there = {name for name in os.fsdecode(listed.stdout).split("\0") if os.path.exists(name)}
    for top in copy.iterdir():
        for file in [top, *top.rglob("*")] if top.name != "build" else []:
            # the tree no longer has this file
            if not file.is_dir() and str(file.relative_to(copy)) not in there:
                file.unlink()
    subprocess.run(["xargs", "-0", "cp", "-pu", "--parents", "-t", copy], input=listed.stdout,
                   stderr=subprocess.DEVNULL)
    if not (copy / "build/main/build.ninja").exists():
        made = subprocess.run(["cmake", "-S", ".", "-B", "build/main", "-G", "Ninja", *options],
                              cwd=copy, env=environment(copy), stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True)
        if made.returncode:
            sys.exit(made.stdout)


def environment(copy):
    return {**os.environ, "CCACHE_BASEDIR": str(copy), "CCACHE_NOHASHDIR": "1"}


def restore(file):
    """Restores a file, and sets its time to the current time, so that the next build compiles it
    again."""
    os.replace(f"{file}.orig", file)
    os.utime(file)


def targets(test, copy):
    """Returns the targets that a test needs."""
    kind, _, rest = test.partition(".")
    if kind.startswith("test_"):
        return [kind]
    if rest.startswith("cdc."):
        return [rest.split(".")[1]]
    if rest == "vhdl":
        return [f"{kind}_vectors"]
    if kind == "slice":
        return ["slice2c"] + ["ghdl"] * rest.startswith("hardware.vhdl.")
    return ["regmaps"]


def attempt(test, copy, log):
    """Builds the targets of a test and runs it: returns "passes", "fails" or "does not build"."""
    build = ["ninja", "-C", "build/main", "-j", "1", *targets(test, copy)]
    run = ["ctest", "--test-dir", "build/main", "-R", f"^{re.escape(test)}(\\.|$)",
           "--no-tests=error", "--output-on-failure", "--stop-on-failure"]
    with open(log, "w") as out:
        for command, otherwise in (build, "does not build"), (run, "fails"):
            if subprocess.run(command, cwd=copy, env=environment(copy), stdout=out,
                              stderr=out).returncode:
                break
        else:
            return "passes"
    # A failed proof counts only if a property failed, not if a file could not be read.
    said = re.search("an assertion fails|not proven|not reached", log.read_text(errors="replace"))
    return "does not build" if test.startswith("formal.") and not said else otherwise


def try_bug(bug, copy):
    start = time.monotonic()
    try:
        planted = bug.planted(copy)
    except (OSError, ValueError):
        planted, result = {}, "does not apply"
    for file, text in planted.items():
        shutil.copy2(copy / file, f"{copy / file}.orig")
        (copy / file).write_text(text)
    if planted:
        result = attempt(bug.test, copy, WORK / (bug.name.replace("/", "-") + ".log"))
        result = {"passes": "SURVIVED", "fails": "caught"}.get(result, result)
    for file in planted:
        restore(copy / file)
    seconds = round(time.monotonic() - start)
    print(f"{result:<14} {bug.name:<36} {bug.test} ({seconds} s)", flush=True)
    return results.Mutant(bug.name, result, bug.test, seconds, bug.place(copy) if planted else "")


def check(chosen, build):
    """Checks, without building, that the lines of each bug are in its files and that the build
    folder `build` (if given) has its test. Returns 1 if a check fails."""
    bad, tests = 0, ""
    if build:
        tests = shown_tests(build, "-N")[1]
    for bug in chosen:
        try:
            bug.planted(TOP)
            program = bug.test.split(".")[0]
            if build and f": {program}_NOT_BUILT\n" not in tests and not re.search(
                    rf": {re.escape(bug.test)}(\.|$)", tests, re.M):
                raise ValueError(f"unknown test {bug.test}")
        except (OSError, ValueError) as error:
            print(f"{bug.name}: does not apply: {reason_of(error)}")
            bad = 1
    return bad


def keep(rows):
    """Writes the results. Results of other blocks are kept from an earlier run, unless their bug
    was removed."""
    path = WORK / "planted.xml"
    there = {bug.name for bug in read_bugs()}
    merged = {row.name: row for row in results.read(path)[1] + rows if row.name in there}
    results.write(path, list(merged.values()))


def try_all(chosen, jobs):
    """Tries the bugs in copies of the tree, `jobs` at a time. Returns the exit status."""
    copies = queue.Queue()
    for number in range(jobs):
        prepare(WORK / str(number))
        copies.put(WORK / str(number))

    def of_program(group):
        """Tries all bugs of one program, or of one proof, in the same copy, so that little has to
        be built again."""
        copy = copies.get()
        try:
            for test in sorted({bug.test for bug in group}):
                # The test must pass without a bug; otherwise a failure proves nothing.
                log = WORK / f"baseline.{test.replace('/', '-')}.log"
                if attempt(test, copy, log) != "passes":
                    sys.stderr.write(log.read_text(errors="replace"))
                    sys.exit(f"mutants: {test} fails without any mutant; repair this first")
                log.unlink()
                for bug in group:
                    if bug.test == test:
                        row = try_bug(bug, copy)
                        with writing:
                            rows.append(row)
                            keep(rows)
        finally:
            copies.put(copy)

    rows, writing, groups = [], threading.Lock(), collections.defaultdict(list)
    for bug in chosen:
        groups[bug.test.split(".")[0] if bug.test.startswith("test_") else bug.test].append(bug)
    with ThreadPoolExecutor(jobs) as pool:
        tasks = [pool.submit(of_program, group)
                 for group in sorted(groups.values(), key=len, reverse=True)]
    for task in tasks:
        task.result()
    now = sum(row.result == "caught" for row in rows)
    print(f"mutants: {now} of {len(rows)} caught (build/mutants/planted.xml)")
    return now != len(rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(
        "--block", default="*",
        help="block or core with the bugs, or one bug as block/name (default: all)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(),
                        help="number of bugs tried in parallel")
    parser.add_argument("--check", nargs="?", const="", metavar="BUILD",
                        help="only check that each bug fits its file, and that BUILD has its test")
    options = parser.parse_args()
    os.chdir(TOP)
    chosen = bugs(options.block)
    if options.check is not None:
        return check(chosen, options.check)
    with only_one(WORK, "mutants"):
        if options.block == "*":
            # the status of mutants in the regression is out of date if one of these folders changes
            write_state(WORK, tree_state(TOP, MEASURED))
        return try_all(chosen, options.jobs)


if __name__ == "__main__":
    sys.exit(main())
