# SPDX-License-Identifier: MIT
"""quick: runs commands of ./icesoc and make in copies of this process, in which the modules are
already loaded. Starting Python takes most of the time of a short command.

Make itself runs as usual, with a script in place of ./icesoc that records its environment. The copy
of this process then gets this environment.
"""
import contextlib
import os
import subprocess
import sys
import tempfile
import traceback
from pathlib import Path

from icesoc import TREE
from icesoc.cli import everything  # noqa: F401
from icesoc.cli import main

STUB = '#!/bin/sh\nexec env -0 >"$QUICK_ENVIRONMENT"\n'


def status_of(function):
    """Returns the exit status with which Python would end after this function."""
    try:
        return function() or 0
    except SystemExit as end:
        if isinstance(end.code, str):
            print(end.code, file=sys.stderr)
            return 1
        return end.code or 0
    except BaseException:
        traceback.print_exc()
        return 1


def icesoc(words, environment):
    """Does what ./icesoc does with these words and this environment. Returns (exit status,
    output)."""
    with tempfile.TemporaryFile() as output:
        sys.stdout.flush()
        sys.stderr.flush()
        child = os.fork()
        if not child:
            status = 1
            try:
                os.chdir(TREE)
                os.environ.clear()
                os.environ.update(environment)
                with open(os.devnull, "rb") as nothing:
                    os.dup2(nothing.fileno(), 0)
                for number in 1, 2:
                    os.dup2(output.fileno(), number)
                sys.stdout, sys.stderr = (open(number, "w", closefd=False) for number in (1, 2))
                status = status_of(lambda: main.main(words))
                sys.stdout.flush()
                sys.stderr.flush()
            finally:
                os._exit(status)
        status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        output.seek(0)
        return status, output.read().decode(errors="replace")


def ask(words, environment):
    """Runs `make WORD...` or `./icesoc WORD...` in the tree. Returns (exit status, output)."""
    if words[0] == "./icesoc":
        return icesoc(list(words[1:]), environment)
    assert words[0] == "make"
    with tempfile.TemporaryDirectory() as folder:
        stub, recorded = Path(folder, "icesoc"), Path(folder, "recorded")
        Path(folder, "Makefile").symlink_to(TREE / "Makefile")
        stub.write_text(STUB)
        stub.chmod(0o755)
        done = subprocess.run(["make", *words[1:]], cwd=folder, stdin=subprocess.DEVNULL,
                              env={**environment, "QUICK_ENVIRONMENT": str(recorded)}, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        made = {}
        with contextlib.suppress(FileNotFoundError):
            made = dict(each.split("=", 1) for each in recorded.read_bytes().decode(
                errors="surrogateescape").split("\0")[:-1])
    if done.returncode or not made:
        return done.returncode, done.stdout
    status, text = icesoc([], made)
    return 2 if status else 0, done.stdout + text
