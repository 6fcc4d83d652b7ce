# SPDX-License-Identifier: MIT
"""runner: starts programs by lists of words, never through a shell; says what went wrong; ends what
it has started.

A program that is ended by a signal, or cannot be started, is reported here, and nowhere else.
"""
import contextlib
import fcntl
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

SKIPPED = 77  # the exit status of what needs a network, and has none


class Stop(Exception):
    """Ends the command with a message (empty if a program has printed one already) and an exit
    status."""
    def __init__(self, text="", status=1):
        super().__init__(text)
        self.text, self.status = text, status


class Interrupted(BaseException):
    """A signal asks for the end."""
    def __init__(self, number):
        super().__init__(number)
        self.status = 128 + number


def hear_signals():
    def hear(number, _):
        for each in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            signal.signal(each, signal.SIG_IGN)  # one is enough: what runs is being ended
        raise Interrupted(number)

    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        if signal.getsignal(number) != signal.SIG_IGN:
            signal.signal(number, hear)


def say(text):
    print(text, flush=True)


def warn(text):
    print(f"icesoc: {text}", file=sys.stderr, flush=True)


def tool(name):
    """The words that start a module of this package, "regs.rdl"."""
    return [sys.executable, "-m", "icesoc" if name == "__main__" else f"icesoc.{name}"]


def start(words, env=None, **more):
    """A process that ends with this one, however that ends. `env`: additions to our environment."""
    words = [str(word) for word in words]
    if not shutil.which(words[0]):
        raise Stop(
            f"there is no program '{words[0]}': ./icesoc setup --tests installs what is missing",
            127)
    more["env"] = {**os.environ, **{name: str(value) for name, value in (env or {}).items()}}
    return subprocess.Popen(["setpriv", "--pdeathsig", "TERM", "--", *words], **more)


def end(process, seconds=20):
    """Ends a process that still runs."""
    with contextlib.suppress(ProcessLookupError):
        process.terminate()
    try:
        process.wait(seconds)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


def wait(process):
    """Its exit status, as in a shell; an interrupt of this process ends it."""
    try:
        status = process.wait()
    except BaseException:
        end(process)
        raise
    return status if status >= 0 else 128 - status


def run(words, check=True, **more):
    """Runs a program to its end. If it fails, the command ends with its exit status, unless `check`
    is false."""
    status = wait(start(words, **more))
    if status > 128:
        number = status - 128
        warn(f"{os.path.basename(str(words[0]))} was ended by signal {number} "
             f"({signal.strsignal(number)})")
    if status and check:
        raise Stop(status=status)
    return status


def output(words, check=True, **more):
    """A program's output; empty if it fails and `check` is false."""
    process = start(words, stdout=subprocess.PIPE, text=True, **more)
    try:
        text = process.communicate()[0]
    except BaseException:
        end(process)
        raise
    if process.returncode:
        if check:
            raise Stop(status=process.returncode)
        return ""
    return text


def logged(words, log, failed, env=None, cwd=None):
    """Runs a program and prints its output only if it fails."""
    with open(log, "w") as file:
        status = run(words, check=False, stdout=file, stderr=file, env=env, cwd=cwd)
    if status:
        with open(log) as file:
            sys.stderr.writelines(file.readlines()[-40:])
        raise Stop(f"{failed}: {log}", status)


@contextlib.contextmanager
def lock(path, busy=None, refuse=None):
    """Holds a lock, a file whose folder it makes, or a folder, and returns its descriptor. If it is
    taken: prints `busy` and waits, or ends with `refuse`."""
    Path(path).parent.mkdir(parents=True, exist_ok=True)
    fd = os.open(path, os.O_RDONLY if os.path.isdir(path) else os.O_RDWR | os.O_CREAT, 0o666)
    try:
        try:
            fcntl.flock(fd, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            if refuse:
                raise Stop(refuse) from None
            warn(busy)
            fcntl.flock(fd, fcntl.LOCK_EX)
        yield fd
    finally:
        os.close(fd)


def until(condition, process, seconds=0.05):
    """Waits until a condition holds, as long as a process runs. Returns the condition."""
    while not (held := condition()) and process.poll() is None:
        time.sleep(seconds)
    return held or condition()


def commit(name, option="BASE"):
    """The whole name of a commit."""
    found = output(["git", "rev-parse", "--verify", "-q", f"{name}^{{commit}}"], check=False)
    if not found:
        raise Stop(f"there is no commit {option}={name}", 2)
    return found.strip()


class Table:
    """Rows of a table that is written to PATH.md, row by row."""
    def __init__(self, path):
        self.path, self.rows = Path(path), []

    def add(self, name, status, seconds, figure=""):
        self.rows.append({"command": name, "status": status, "seconds": round(seconds, 1),
                          "figure": figure})
        said = {0: "ok", SKIPPED: "skipped"}.get(status, f"FAILED ({status})")
        say(f"{name:<18} {said:<12} {seconds:7.1f} s  {figure}")
        self.path.parent.mkdir(parents=True, exist_ok=True)
        lines = ["| command | status | seconds | what it says last |", "|---|---|---|---|"]
        for row in self.rows:
            last = row["figure"].replace("|", "/")
            lines.append(f"| {row['command']} | {row['status']} | {row['seconds']} | {last} |")
        self.path.with_suffix(".md").write_text("\n".join(lines) + "\n")

    def end(self):
        """Ends the command: with an error that names what failed, if something has."""
        seconds = sum(row["seconds"] for row in self.rows)
        skipped = [row for row in self.rows if row["status"] == SKIPPED]
        if failed := [row["command"] for row in self.rows if row["status"] not in (0, SKIPPED)]:
            raise Stop(f"failed: {', '.join(failed)} ({self.path}.md)")
        for row in skipped:
            say(f"skipped: {row['command']}: {row['figure']}")
        say(f"{len(self.rows) - len(skipped)} commands, {seconds:.0f} s: {self.path}.md")
