# SPDX-License-Identifier: MIT
"""process: starts programs from lists of words, never through a shell, and ends them.

If a program is ended by a signal or cannot be started, this module prints the message.
"""
import contextlib
import ctypes
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import threading
import time

from icesoc.util.console import warn
from icesoc.util.errors import Interrupted, Stop


ICESOC = [sys.executable, "-m", "icesoc"]  # the words that start a command of ./icesoc


# environment variable with the process that has started this program
STARTED_BY = "ICESOC_STARTED_BY"
INTERRUPTS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


def is_part():
    """Returns whether another command of ./icesoc has started this program."""
    return os.environ.get(STARTED_BY) == str(os.getppid())


def hear_signals():
    """Turns the first SIGINT, SIGTERM or SIGHUP into the exception Interrupted. Further signals are
    ignored, because the program is already ending."""
    interrupted = False

    def hear(number, _):
        nonlocal interrupted
        if interrupted:
            return
        interrupted = True
        # Programs that are started later inherit this mask, so a second Ctrl-C does not end them.
        signal.pthread_sigmask(signal.SIG_BLOCK, INTERRUPTS)
        raise Interrupted(number)

    for number in INTERRUPTS:
        if signal.getsignal(number) != signal.SIG_IGN:
            signal.signal(number, hear)


def tool(name):
    """Returns the words that start a module of this package, such as "regs.rdl"."""
    return [sys.executable, "-m", f"icesoc.{name}"]


def start(words, env=None, **more):
    """Starts a process that gets SIGTERM when this process ends, even if this process is killed.
    `env`: variables to add to the environment."""
    words = [str(word) for word in words]
    if not shutil.which(words[0]):
        raise Stop(
            f"program '{words[0]}' not found: ./icesoc setup --tests installs missing packages",
            127)
    more["env"] = {**os.environ, STARTED_BY: str(os.getpid()),
                   **{name: str(value) for name, value in (env or {}).items()}}
    return subprocess.Popen(["setpriv", "--pdeathsig", "TERM", "--", *words], **more)


def end(process, seconds=20):
    """Ends a process that is still running."""
    with contextlib.suppress(ProcessLookupError):
        process.terminate()
    try:
        process.wait(seconds)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


def wait(process):
    """Waits for a process, and returns its exit status as a shell does: 128 + N after signal N. If
    this process is interrupted meanwhile, ends the other process."""
    try:
        status = process.wait()
    except BaseException:
        end(process)
        raise
    return status if status >= 0 else 128 - status


def run(words, check=True, **more):
    """Runs a program to its end, and returns its exit status. If the program fails and `check` is
    true, ends the command with this exit status."""
    status = wait(start(words, **more))
    if status > 128:
        number = status - 128
        warn(f"{os.path.basename(str(words[0]))} was ended by signal {number} "
             f"({signal.strsignal(number)})")
    if status and check:
        raise Stop(status=status)
    return status


def output(words, check=True, **more):
    """Returns the output of a program. If the program fails, ends the command or, if `check` is
    false, returns an empty text."""
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
    """Runs a program with its output in the file `log`. If it fails, prints the last lines, and
    ends the command with the message `failed`."""
    with open(log, "w") as file:
        status = run(words, check=False, stdout=file, stderr=file, env=env, cwd=cwd)
    if status:
        with open(log) as file:
            sys.stderr.writelines(file.readlines()[-40:])
        raise Stop(f"{failed}: {log}", status)


def until(condition, process, seconds=0.05):
    """Waits until a condition holds or a process has ended. Returns the last value of the
    condition."""
    while not (held := condition()) and process.poll() is None:
        time.sleep(seconds)
    return held or condition()


@contextlib.contextmanager
def signals_held():
    """Delays SIGINT, SIGTERM and SIGHUP until the end of a `with` block. Programs started in the
    block never receive these signals."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, INTERRUPTS)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def collect(command, environment=None, on_line=None, before_kill=None, **more):
    """Runs a program to its end and returns (exit status, output). A signal that ends this process
    kills the program as well, after a call of `before_kill`."""
    words = ["setpriv", "--pdeathsig", "TERM", *map(str, command)]
    said = []

    def hear(line):
        said.append(line)
        if on_line:
            on_line(line.rstrip("\n"))
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          errors="replace", env={**os.environ, **(environment or {})},
                          **more) as process:
        ended = reading(process, hear)
        try:
            wait_for(ended)
        except BaseException:
            if before_kill:
                before_kill()
            process.kill()
            ended.wait(1)
            raise
    status = process.returncode
    if status in (126, 127):
        raise Stop(f"cannot run {command[0]}: {''.join(said)}")
    return (status if status >= 0 else 128 - status), "".join(said)


def reading(process, hear):
    """Starts a thread that calls `hear` with each line of a program's output. A signal interrupts
    only the main thread, so no line is lost that the program has already printed. Returns an event
    for `wait_for`, which is set at the end of the output."""
    ended = threading.Event()

    def read():
        try:
            for line in process.stdout:
                hear(line)
        finally:
            ended.set()
    threading.Thread(target=read, daemon=True).start()
    return ended


def wait_for(event):
    """Waits for an event that another thread sets. The wait consists of short parts, because the
    kernel may deliver a signal to the other thread; this does not wake the main thread, and Python
    calls the handler only when the main thread runs again."""
    while not event.wait(0.1):
        pass


def children(pid):
    """Returns the running child processes of a process, oldest first."""
    found = []
    for path in pathlib.Path(f"/proc/{pid}/task").glob("*/children"):
        with contextlib.suppress(OSError):
            found += map(int, path.read_text().split())
    return sorted(found)


def descendants(pid):
    """Returns the running processes below a process, parents before children."""
    below = children(pid)
    for each in below:
        below += children(each)
    return below


def end_descendants():
    """Ends all processes below this one: by SIGTERM, and after a second by SIGKILL."""
    for attempt in range(100):
        with contextlib.suppress(ChildProcessError):
            while os.waitpid(-1, os.WNOHANG)[0]:
                pass
        left = descendants(os.getpid())
        if not left:
            return
        for pid in left if attempt == 0 or attempt >= 20 else ():
            with contextlib.suppress(OSError):
                os.kill(pid, signal.SIGKILL if attempt else signal.SIGTERM)
        time.sleep(0.05)


def adopt_orphans():
    """Makes this process the parent of processes that programs leave behind; otherwise init would
    adopt them."""
    become_subreaper = 36
    ctypes.CDLL(None).prctl(become_subreaper, 1)


def end_orphans():
    """Ends leftover processes that are still running after two seconds. Returns a line for each of
    them."""
    left = {}
    for attempt in range(40):
        time.sleep(0.05 if attempt else 0)
        left = {}
        for pid in children(os.getpid()):
            with contextlib.suppress(OSError):
                if os.waitpid(pid, os.WNOHANG)[0]:
                    continue
                words = pathlib.Path(f"/proc/{pid}/cmdline").read_text().replace("\0", " ")
                left[pid] = f"{words}(in {os.path.relpath(os.readlink(f'/proc/{pid}/cwd'))})"
        if not left:
            break
    for pid in left:
        os.kill(pid, 9)
    return list(left.values())
