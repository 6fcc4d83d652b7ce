# SPDX-License-Identifier: MIT
"""unchanged: finds the tests that have passed with their present inputs, so that `make test` runs
only the other tests.

When a test passes, a digest of its inputs is stored. The inputs are:
- for a test program: its bytes, and all files in the tree or the build folder, if these
  bytes contain their absolute paths (from compile definitions). If a path is a folder, all files
  in the folder are inputs.
- for any other test: all files of the tree, and the programs of the build.
- for both: the seed, and the versions of the packages in cmake/setup.sh and of all packages that
  these depend on. Other packages of the machine do not count.
"""
import functools
import json
import os
import pathlib
import re

from icesoc.regress.junit import read_junit
from icesoc.regress.tests import list_tests
from icesoc.util.files import digest, write
from icesoc.util.process import collect
from icesoc.util.tree import tracked

STATUS = pathlib.Path("/var/lib/dpkg/status")
# Files of the build that test programs may use. Files that only later steps of the build use do not
# match.
USED = re.compile(r"\.(so|elf|bin|json|vh|list|inc)$|/(?!test_|fuzz_)[\w-]+$")


def packages(source, status=STATUS):
    """Returns a digest of the versions of the packages that cmake/setup.sh names, and of those that
    they depend on."""
    setup = source / "cmake/setup.sh"
    if not status.exists() or not setup.exists():
        return ""
    versions, needs, provided = {}, {}, {}
    for entry in status.read_text(errors="replace").split("\n\n"):
        fields = dict(re.findall(r"(?m)^(Package|Version|Depends|Pre-Depends|Provides): (.*)",
                                 entry))
        name = fields.get("Package")
        if name and "\nStatus: install ok installed" in f"\n{entry}":
            versions[name] = fields.get("Version", "")
            needs[name] = re.findall(r"(?:^|[,|] *)([a-z0-9][a-z0-9+.-]+)", ",".join(
                fields.get(key, "") for key in ("Depends", "Pre-Depends")))
            for other in re.findall(r"(?:^|, *)([a-z0-9][a-z0-9+.-]+)", fields.get("Provides", "")):
                provided[other] = name
    left, seen = re.findall(r"(?m)^([a-z0-9][a-z0-9+.-]+) \S", setup.read_text()), set()
    while left:
        name = left.pop()
        name = name if name in versions else provided.get(name, name)
        if name in versions and name not in seen:
            seen.add(name)
            left += needs[name]
    return digest(f"{name} {versions[name]}" for name in sorted(seen))


class Inputs:
    """Computes digests of the inputs of tests. Digests of files are stored in the build folder, and
    computed again if size or time of the file has changed."""

    def __init__(self, source, build, seed):
        self.source, self.build, self.seed = source.resolve(), build.resolve(), seed
        self.path = self.build / "digests.json"
        try:
            self.kept = json.loads(self.path.read_text())
        except (OSError, ValueError):
            self.kept = {}
        self.packages = packages(self.source)

    def save(self):
        write(self.path, json.dumps(self.kept))

    def file(self, path, names=False):
        """Returns (digest of a file, paths that the file contains). The paths are only computed
        with `names`."""
        try:
            status = os.stat(path)
            state = [status.st_size, status.st_mtime_ns]
            known = self.kept.get(str(path))
            if not known or known[0] != state or (names and known[2] is None):
                data = pathlib.Path(path).read_bytes()
                known = [state, digest([data.decode("latin1")]),
                         self._paths(data) if names else None]
                self.kept[str(path)] = known
            return known[1], known[2]
        except OSError:
            return "", []

    def _paths(self, data):
        places = b"|".join(re.escape(bytes(place)) for place in sorted(
            (self.build, self.source), key=lambda path: -len(str(path))))
        found = re.findall(rb"(?:%s)(?:/[\w.+-]+)*/?" % places, data)
        return sorted({os.path.normpath(path.decode()) for path in found})

    @functools.cached_property
    def tracked(self):
        """Returns the files of the tree."""
        return [str(self.source / name) for name in tracked(self.source)]

    @functools.cached_property
    def made(self):
        """Returns the files of the build that programs use, without those that tests write."""
        listed = collect(["ninja", "-C", self.build, "-t", "targets", "all"])[1]
        names = (line.rpartition(":")[0] for line in listed.splitlines())
        paths = (os.path.join(self.build, name) for name in names)
        # Ninja also lists inputs of CMake outside the tree, such as dpkg's list of packages.
        ours = f"{self.source}/", f"{self.build}/"
        return sorted(path for path in paths if path.startswith(ours) and USED.search(path)
                      and os.path.isfile(path))

    @functools.cached_property
    def all(self):
        """Returns the digest of the tree and of all files that are built from it."""
        return self.files(self.tracked + self.made)

    def files(self, paths):
        return digest(f"{path} {self.file(path)[0]}" for path in paths)

    @functools.cache
    def of_path(self, path):
        """Returns the digest of a path that a program names."""
        if path in (str(self.source), str(self.build)):
            return self.all
        if os.path.isdir(path):
            return self.files(each for each in self.tracked + self.made
                              if each.startswith(path + "/"))
        is_output = path.startswith(f"{self.build}/") and path not in self.made
        return "" if is_output else self.file(path)[0]

    def of_program(self, path):
        text, paths = self.file(path, names=True)
        return digest([text, *(f"{name} {self.of_path(name)}" for name in paths)])

    @functools.cache
    def of_command(self, command, is_program):
        return self.of_program(command) if is_program else self.all

    def of(self, test):
        """Returns the digest of all inputs of a test."""
        is_program = test.is_program(self.build)
        return digest([self.packages, self.seed, *test.command,
                       self.of_command(test.command[0], is_program)]) if test.command else ""


class Passes:
    """The stored passes of the tests in a build folder: name of the test -> digest of its
    inputs."""

    def __init__(self, source, build, seed):
        self.path, self.inputs = build / "passes.json", Inputs(source, build, seed)
        self.tests = {test.name: test for test in list_tests(build)}
        self.prints = {name: self.inputs.of(test) for name, test in self.tests.items()}
        self.inputs.save()
        try:
            self.kept = json.loads(self.path.read_text())
        except (OSError, ValueError):
            self.kept = {}

    def changed(self, label, all_tests):
        """Returns the tests with a label that have not passed with their current inputs, or all its
        tests with `all_tests`. Also returns the number of tests left out."""
        some = [test for test in self.tests.values() if not label or label in test.labels]
        left = [test for test in some if all_tests or not test.command or
                self.kept.get(test.name) != self.prints[test.name]]
        return left, len(some) - len(left)

    def note(self, junit):
        """Stores the tests that passed according to these results, unless an input has changed
        meanwhile, and removes the tests that failed."""
        now = Inputs(self.inputs.source, self.inputs.build, self.inputs.seed)
        for result in read_junit(junit) if junit.exists() else ():
            name = result.name
            if name in self.tests and result.status == "passed" \
                    and now.of(self.tests[name]) == self.prints[name]:
                self.kept[name] = self.prints[name]
            else:
                self.kept.pop(name, None)
        write(self.path, json.dumps(self.kept))
