# SPDX-License-Identifier: MIT
"""script: helpers for the tests of commands: they run a command, check its output, and write the
files that it needs.

A test program ends with `script.main(Cases)`. CTest passes the name of a case, followed by the
arguments that the case reads from sys.argv[2:].
"""
import os
import re
import shlex
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

TREE = Path(__file__).resolve().parents[1]
# time after which a program is considered to hang, s; it is long, because the load of the machine
# must not decide a test
LONGEST = 600

# `./icesoc test --fresh` sets FRESH for the tests, but not for the commands that they run.
os.environ.pop("FRESH", None)


def write(path, text):
    """Writes a file and creates its folders. A text that begins with #! becomes an executable
    file."""
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    if text.startswith("#!"):
        path.chmod(0o755)


def append(path, text):
    with open(path, "a") as file:
        file.write(text)


def edit(path, old, new):
    """Replaces a text in a file. Fails if the file does not contain the text."""
    text = Path(path).read_text()
    assert old in text, f"{path} has no {old!r}"
    Path(path).write_text(text.replace(old, new))


def fresh(folder):
    """Creates an empty folder and changes to it."""
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    os.chdir(folder)
    return Path.cwd()


def git(words, *more):
    return subprocess.check_output(["git", *shlex.split(words), *more], text=True).strip()


def repository():
    """Turns the current folder into a git repository."""
    git("init -q .")
    git("config user.email a@b")
    git("config user.name a")


def commit(subject):
    git("add .")
    git("commit -qm", subject)


class Script(unittest.TestCase):
    said = ""  # output of the last command

    def ask(self, *words, status=0, **how):
        """Runs a command, checks its exit status (None means any failure), and stores its output in
        `said`."""
        done = subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                              errors="replace", **{"stdin": subprocess.DEVNULL, **how})
        self.said = done.stdout
        right = done.returncode if status is None else done.returncode == status
        self.assertTrue(right, f"exit status {done.returncode} of {words}: {self.said[-20000:]}")

    def make(self, *words, tree=TREE, build="build", **how):
        """Runs a command through make, as a user does. `tree` is the source tree in which the
        command works: the whole tree, or a small one that the test has written. `build` is a build
        folder in which everything already exists, so that the command builds and installs nothing;
        with None, the command builds what it needs."""
        ours = {
            name: value
            for name, value in os.environ.items()
            if name not in ("MAKEFLAGS", "MFLAGS", "MAKELEVEL")}
        self.ask("make", "-s", "-C", TREE, *([f"BUILD={build}", "BUILT=1"] if build else []),
                 *words, env={**ours, "ICESOC_TREE": str(Path(tree).resolve())}, **how)

    def has(self, *patterns, file=None):
        """Checks that the output of the last command, or the file, contains a match for each of
        these expressions."""
        text = Path(file).read_text(errors="replace") if file else self.said
        for pattern in patterns:
            self.assertTrue(re.search(pattern, text, re.M),
                            f"{pattern!r} is not in {file or 'the output'}: {text[-20000:]}")

    def lacks(self, pattern, file=None):
        text = Path(file).read_text(errors="replace") if file else self.said
        self.assertFalse(re.search(pattern, text, re.M),
                         f"{pattern!r} is in {file or 'the output'}: {text[-20000:]}")


def main(cases):
    result = unittest.main(argv=[sys.argv[0], f"{cases.__name__}.test_{sys.argv[1]}"],
                           exit=False).result
    for _, reason in result.skipped:
        print(f"skipped: {reason}")
    sys.exit(77 if result.skipped else not result.wasSuccessful())
