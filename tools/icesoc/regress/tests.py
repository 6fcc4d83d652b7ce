# SPDX-License-Identifier: MIT
"""tests: lists every test that CTest knows, with its files and the targets that it needs. Reads the
plan, which names the tests of each requirement in docs/."""
import dataclasses
import fnmatch
import functools
import hashlib
import json
import os
import pathlib
import re
import tomllib

from icesoc.util.cmake import cached, shown_tests
from icesoc.util.errors import Stop
from icesoc.util.files import digest, write
from icesoc.util.process import collect
from icesoc.util.rooms import RTL, rooms
from icesoc.util.tree import tracked

NOT_BUILT = "_NOT_BUILT"  # suffix that CTest gives to a program that is not built


class Name:
    """A selection of tests by name. A plain word selects names that contain it as a whole word, so
    that `fir` does not select `first`. Any other text is a regular expression."""

    def __init__(self, text):
        self.text, self.is_word = text, bool(re.fullmatch(r"[A-Za-z]\w*", text))
        before = "(?<![A-Za-z])" if text[:1].islower() else "(?<![A-Z])"
        self.pattern = f"{before}{text}(?![a-z])" if self.is_word else text
        self.search = re.compile(self.pattern).search


def write_numbers(path, tests):
    """Writes the numbers of tests into a file for CTest's option -I."""
    write(path, ",".join(["0,0,0", *(str(test.number) for test in tests)]) + "\n")


@dataclasses.dataclass
class Test:
    number: int  # number that CTest gives the test, starting with 1
    name: str
    command: list
    folder: str = ""  # working directory; the test may write there
    place: str = ""  # the same folder as a path relative to tests/, such as "hdl/modem"
    labels: list = dataclasses.field(default_factory=list)
    needs: list = dataclasses.field(default_factory=list)  # CTest's fixtures
    sets: list = dataclasses.field(default_factory=list)
    targets: list | None = None  # targets that the test needs, from NEEDS=... in its environment
    path: str = ""  # folder, without tests/: "ip/fir", "hdl/modem"
    print: str = ""  # fingerprint; changes when the test's program or files change

    @property
    def unbuilt(self):
        return self.name.endswith(NOT_BUILT)

    @property
    def program(self):
        """Returns the name of the test's program. The program's target has the same name."""
        return self.name.removesuffix(NOT_BUILT) if self.unbuilt else self.name.split(".")[0]

    def is_in(self, folder):
        """Returns whether the test belongs to a folder, given relative to the tree or to tests/,
        such as hdl/fsmc or ip/fir."""
        folder = folder.strip("/").removeprefix("tests/")
        return f"{self.path}/".startswith(f"{folder}/")

    def is_program(self, build):
        return bool(self.command) and "/test_" in self.command[0] and \
            self.command[0].startswith(f"{build.resolve()}/")

    def reads(self):
        """Returns the folders that a test without a program reads."""
        own = f"tests/{self.place}"
        if "formal" in self.place or "lint" in self.place:
            return (*RTL, "tools", own)
        if self.place.startswith("slice"):
            return ("slice", "tests/slice")
        return (*rooms("core"), "tools", own)

    def compiles(self):
        """For a test that GHDL runs, returns the absolute paths in its command: its sources and
        programs. For any other test, returns an empty list."""
        return [word for word in self.command if word.startswith("/")] \
            if self.name.endswith(".vhdl") else []

    def blocks(self):
        """Returns the words that --block may select this test by: the words of its folder, and
        the words of its name up to the name of the case."""
        kind, _, rest = self.name.partition(".")
        is_kind = kind in ("formal", "lint", "wave") or rest.startswith(("cdc.", "fuzz."))
        more = rest if is_kind else ""
        return set(re.findall("[A-Za-z0-9]+", f"{self.place}/{kind}/{more}"))

    def _may_begin(self, pattern):
        """Returns whether the name of a case of this program may match `pattern`. The result is
        False only if each alternative of the pattern begins with `^` and letters that the program's
        name does not begin with."""
        for some in re.findall(r"(?:\([^()]*\)|[^|()])+", pattern):
            begins = re.match(r"\^(?:\(([\w|]+)\)(?![?*{])|((?:\w(?![?*{]))+))", some)
            if not begins or any(word.startswith(self.program) or self.program.startswith(word)
                                 for word in (begins[1] or begins[2]).split("|")):
                return True
        return False

    def may_hold(self, name, sources):
        """Returns whether a case of a program may match a Name, if the program is not built or is
        older than its sources. `sources`: texts of the program's source files. The name of a
        parameterised or typed case is composed of words from different places of the text. Names of
        suites and cases begin with capitals."""
        if not self._may_begin(name.pattern):
            return False
        text = re.sub("//.*", "", "\n".join(sources))
        cases = re.findall(r"(?m)^ *(?:TYPED_)?TEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\)", text)
        if any(name.search(f"{self.program}.{suite}.{case}") for suite, case in cases):
            return True
        if name.is_word:
            return not sources or bool(name.search(f"{self.program} {text}"))
        if cases and not re.search(r"INSTANTIATE_TEST_SUITE_P|TYPED_TEST", text):
            return False
        for some in re.sub(r"\[.*?\]|\\(?!\.)|.[?*{]", " ", name.pattern).split("|"):
            ends = re.findall(r"([a-z0-9_]+)\\?\.", some)
            words = re.findall(r"[A-Za-z]{3,}", some) if cases else []
            if self.program.startswith(re.match(r"\^?(test_\w+|)", some)[1]) and \
                    all(map(self.program.endswith, ends)) and \
                    all(word in self.program + text for word in words):
                return True
        return False


def list_tests(build):
    """Returns all tests of a build folder."""
    status, text = shown_tests(build, "--show-only=json-v1")
    if status:
        raise Stop(f"ctest cannot list the tests of {build}; run `./icesoc build` first\n"
                   f"{text[:2000]}")
    if "{" not in text:
        raise Stop(f"ctest lists no tests in {build}; run `./icesoc build` first")
    below, source = f"{build.resolve()}/tests/", cached(build, "CMAKE_HOME_DIRECTORY")
    tests = []
    for number, entry in enumerate(json.loads(text[text.index("{"):])["tests"], 1):
        has = {each["name"]: each["value"] for each in entry.get("properties", [])}
        folder = has.get("WORKING_DIRECTORY", "")
        test = Test(number, entry["name"], entry.get("command", []), folder,
                    folder.removeprefix(below) if folder.startswith(below)
                    else os.path.basename(folder), has.get("LABELS", []),
                    has.get("FIXTURES_REQUIRED", []), has.get("FIXTURES_SETUP", []))
        test.path = os.path.relpath(folder, build.resolve()).removeprefix("tests/")
        for word in has.get("ENVIRONMENT", []):
            if word.startswith("NEEDS="):
                test.targets = word[6:].split()
        if files := has.get("REQUIRED_FILES"):  # the first source file, of icesoc_test()
            test.path = os.path.relpath(os.path.dirname(files[0]), source).removeprefix("tests/")
        tests.append(test)
    return tests


def targets_of(test, build, outputs):
    """Returns the targets that ninja must build for a test. These are `Test.targets` or, if that is
    None, the `outputs` of the build that the test's command names. The target is "all" if the
    command names the build folder itself, or an unknown file in it."""
    if test.unbuilt:
        return [test.program]
    if test.name.startswith("formal."):
        return ["regmaps"]
    if test.targets is not None:
        return test.targets
    if not test.command:  # CTest does not list the command of a program that is not built
        return ["all"]
    targets = []
    for path in re.findall(re.escape(str(build)) + "([^ '\":;,<>]*)", " ".join(test.command)):
        target = path.lstrip("/")
        if f"{build}{path}".startswith(test.folder + "/") and target not in outputs:
            continue  # the test itself creates this file
        name = os.path.basename(target)  # the command names a plugin of Ice without the suffix .so
        targets.append("synth_inputs" if target == "gen" else target if target in outputs
                       else name if name in outputs else "all")
    return targets


def fingerprint(tests, source, build):
    """Sets `Test.print` of each test: a hash of the program's file, or of the files that a script
    reads."""
    @functools.cache
    def of_file(path):
        try:
            return hashlib.sha1(pathlib.Path(path).read_bytes()).hexdigest()
        except OSError:
            return ""
    files = tracked(source)

    @functools.cache
    def of_folders(folders):
        return digest([of_file(source / f) for folder in folders for f in files
                       if f.startswith(folder + "/")])
    for test in tests:
        test.print = digest([of_file(test.command[0])]) if test.is_program(build) \
            else of_folders(test.reads())


class Graph:
    """Ninja's graph of files, with the headers of the last compilation."""

    def __init__(self, source, build):
        self.source, self.build, self.made = source.resolve(), build.resolve(), {}
        text = (self.build / "build.ninja").read_text().replace("$\n", "")
        text = text.replace("${cmake_ninja_workdir}", f"{self.build}/")
        for line in text.splitlines():
            if line.startswith("build "):
                outs, _, rule = re.sub(r"\$([ :$])", r"\\\1", line[6:]).partition(": ")
                ins = rule.split()[1:]
                for out in set(outs.split()) - {"|"}:
                    self.made.setdefault(out.removeprefix(f"{self.build}/"), []).extend(ins)
        for line in collect(["ninja", "-C", self.build, "-t", "deps"])[1].splitlines():
            if line.startswith("    "):
                self.made.setdefault(out, []).append(line[4:])
            elif line:
                out = line.split(":")[0]

    @functools.cache
    def inputs(self, target):
        """Returns the files of the tree from which a target is built, including build files."""
        seen, left, build, source = {"|", "||"}, [target], f"{self.build}/", f"{self.source}/"
        while left:
            path = left.pop().removeprefix(build)
            if path not in seen:
                seen.add(path)
                left += self.made.get(path, [])
        # paths in the dependency files of ccache are relative
        real = (os.path.normpath(self.build / path) for path in seen)
        return {path[len(source):] for path in real if path.startswith(source)}


@dataclasses.dataclass
class Requirement:
    page: str  # name of the page: "bus" for docs/bus.md
    text: str
    patterns: list  # test names; * matches anything


class Finder:
    """Finds the tests that match a pattern of the plan. A program that is not built matches if one
    of its cases could match."""
    def __init__(self, tests):
        self.built = {test.name: test for test in tests if not test.unbuilt}
        self.unbuilt = [test for test in tests if test.unbuilt]

    def find(self, pattern):
        if "*" in pattern:
            match = re.compile(fnmatch.translate(pattern)).match
            found = [test for name, test in self.built.items() if match(name)]
        else:
            found = [self.built[pattern]] if pattern in self.built else []
        return found + [test for test in self.unbuilt
                        if fnmatch.fnmatchcase(test.program, pattern.split(".")[0])]


def read_plan(source):
    """Reads tests/plan.toml: one table per page of docs/, with lines `"requirement" = "test.pattern
    test.*"`."""
    path = source / "tests/plan.toml"
    try:
        pages = tomllib.loads(path.read_text()) if path.exists() else {}
    except tomllib.TOMLDecodeError as error:
        raise Stop(f"{path}: {error}") from None
    for page, rows in pages.items():
        for text, patterns in rows.items() if isinstance(rows, dict) else [(page, rows)]:
            if not isinstance(patterns, str) or not patterns.split() or rows == patterns:
                raise Stop(f'{path}: {text}: expected `"requirement" = "test.pattern ..."` below '
                           'the name of a page')
    return [Requirement(page, text, patterns.split())
            for page, rows in pages.items() for text, patterns in rows.items()]


def unmatched(requirement, finder):
    return [f"no test is called {pattern}, which is to prove: {requirement.text}"
            for pattern in requirement.patterns if not finder.find(pattern)]


def judge_plan(plan, tests, history):
    """Returns a row for each requirement: proven if all its tests passed with the current sources,
    failed if one failed or a pattern matches no test, otherwise open."""
    rows, finder = [], Finder(tests)
    for each in plan:
        mine = list({test.name: test for pattern in each.patterns
                     for test in finder.find(pattern)}.values())
        failed = unmatched(each, finder) + [t.name for t in mine if history.now(t) == "f"]
        not_run = [t.name for t in mine if t.unbuilt or history.now(t) not in ("p", "f")]
        rows.append({"page": each.page, "text": each.text, "patterns": each.patterns,
                     "tests": len(mine), "open": failed or not_run,
                     "state": "failed" if failed else "open" if not_run else "proven"})
    return rows
