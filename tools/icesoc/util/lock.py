# SPDX-License-Identifier: MIT
"""lock: prevents two commands from working in one folder at the same time."""
import contextlib
import fcntl
import os
from pathlib import Path

from icesoc.util.console import warn
from icesoc.util.errors import Stop


@contextlib.contextmanager
def lock(path, busy=None, refuse=None):
    """Holds a lock for a `with` block, and yields its file descriptor. `path` is a folder, or a
    file; a missing file is created, together with its folder. If another process holds the lock,
    ends the command with the message `refuse` if it is given; otherwise prints `busy` and waits."""
    Path(path).parent.mkdir(parents=True, exist_ok=True)
    fd = os.open(path, os.O_RDONLY if os.path.isdir(path) else os.O_RDWR | os.O_CREAT, 0o666)
    try:
        try:
            fcntl.flock(fd, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            if refuse:
                raise Stop(refuse) from None
            if busy:
                warn(busy)
            fcntl.flock(fd, fcntl.LOCK_EX)
        yield fd
    finally:
        os.close(fd)


@contextlib.contextmanager
def only_one(folder, program):
    """Locks a folder for one run of a program. If another process holds the lock, prints the number
    of that process and waits."""
    path = folder / "lock"
    holder = path.read_text() if path.exists() else ""
    with lock(path, busy=f"{program}: waiting for another run in {folder}"
              f"{f' (process {holder})' if holder else ''} ..."):
        path.write_text(str(os.getpid()))
        yield
