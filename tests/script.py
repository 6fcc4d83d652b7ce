# SPDX-License-Identifier: MIT
"""script: shared code of tests of commands: a command, its output, the files that it needs.

A test's program ends with `script.main(Cases)`. CTest gives it the name of a case, then what the
case reads from sys.argv[2:].
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


def write(path, text):
    """Writes a file, and its folders; a script becomes a program."""
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    if text.startswith("#!"):
        path.chmod(0o755)


def append(path, text):
    with open(path, "a") as file:
        file.write(text)


def edit(path, old, new):
    """Replaces one text in a file, which must have it."""
    text = Path(path).read_text()
    assert old in text, f"{path} has no {old!r}"
    Path(path).write_text(text.replace(old, new))


def fresh(folder):
    """An empty folder, which becomes the current one."""
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    os.chdir(folder)
    return Path.cwd()


def git(words, *more):
    return subprocess.check_output(["git", *shlex.split(words), *more], text=True).strip()


def repository():
    """Makes the current folder a separate repository."""
    git("init -q .")
    git("config user.email a@b")
    git("config user.name a")


def commit(subject):
    git("add .")
    git("commit -qm", subject)


class Script(unittest.TestCase):
    said = ""  # output of the last command

    def ask(self, *words, status=0, **how):
        """Runs a command, which must end with this exit status (None: any of a failure), and keeps
        its output."""
        done = subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                              errors="replace", **{"stdin": subprocess.DEVNULL, **how})
        self.said = done.stdout
        right = done.returncode if status is None else done.returncode == status
        self.assertTrue(right, f"exit status {done.returncode} of {words}: {self.said[-20000:]}")

    def make(self, *words, tree=TREE, build="build", **how):
        """Runs a command by make, as a user does, in the whole tree or in a small one of the test;
        what it would build and install is there already, unless `build` is None."""
        ours = {
            name: value
            for name, value in os.environ.items()
            if name not in ("MAKEFLAGS", "MFLAGS", "MAKELEVEL")}
        self.ask("make", "-s", "-C", TREE, *([f"BUILD={build}", "BUILT=1"] if build else []),
                 *words, env={**ours, "ICESOC_TREE": str(Path(tree).resolve())}, **how)

    def has(self, *patterns, file=None):
        """The last command has said, or the file has, a line for each of these expressions."""
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
