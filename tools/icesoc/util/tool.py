# SPDX-License-Identifier: MIT
"""tool: what the tools of regression and utilisation share: runs other programs, writes whole files
and pages, notes states of the tree, and locks a folder."""
import contextlib
import ctypes
import fcntl
import hashlib
import json
import os
import pathlib
import subprocess
import sys
import time

from icesoc import TREE


class Stop(Exception):
    """Ends the program with this message and exit status 2."""


def run(command, environment=None, on_line=None):
    """Runs a program to its end; (exit status, output). A killed parent ends it, too."""
    words = ["setpriv", "--pdeathsig", "TERM", *map(str, command)]
    said = []
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          errors="replace", env={**os.environ, **(environment or {})}) as process:
        for line in process.stdout:
            said.append(line)
            if on_line:
                on_line(line.rstrip("\n"))
    status = process.returncode
    if status in (126, 127):
        raise Stop(f"cannot run {command[0]}: {''.join(said)}")
    return (status if status >= 0 else 128 - status), "".join(said)


def write(path, text):
    """Writes a file, all of it or none: readers see the old text or the new."""
    part = pathlib.Path(f"{path}.part")
    try:
        part.write_text(text)
    except OSError:
        part.unlink(missing_ok=True)
        raise Stop(f"cannot write {path}: is the disk full?") from None
    part.replace(path)


def tracked(source):
    """Paths of the tree's files, those that .gitignore names left out; a copy has them, too."""
    return run(["git", "-C", source, "grep", "--no-index", "--exclude-standard", "--no-color",
                "-l", ""])[1].splitlines()


def tree_state(source, folders):
    """The state of folders, "bus hdl: 0123...": a measurement is current while it is the same."""
    files = sorted(f for f in tracked(source) if f.split("/")[0] in folders.split())
    def hashes(text, *words):
        return subprocess.run(["git", "hash-object", *words], input=text, text=True, cwd=source,
                              check=True, stdout=subprocess.PIPE).stdout
    names = "".join(f"{file}\n" for file in files)
    return f"{folders}: {hashes(names + hashes(names, '--stdin-paths'), '--stdin')[:16]}"


def digest(parts):
    return hashlib.sha1("\0".join(parts).encode()).hexdigest()[:16]


def page_parts(libraries):
    """The style and the script that the pages begin with: libraries, colours, tables, charts."""
    here = TREE / "tools/icesoc/web"

    def joined(ending):
        files = [libraries / f"libraries{ending}",
                 here / f"common{ending}", here / f"tables{ending}"]
        return "".join(file.read_text() for file in files if file.exists())
    return joined(".css"), joined(".js")


def filled(page, places):
    """The page with each place replaced by its text."""
    for place, text in places.items():
        if place not in page:
            raise Stop(f"the page has no {place}")
        page = page.replace(place, text, 1)
    return page


def script_safe(data):
    """JSON as it may stand in a page's script: a "</" in it does not end the script."""
    return json.dumps(data, separators=(",", ":"), sort_keys=True).replace("</", "<\\/")


@contextlib.contextmanager
def only_one(folder, program):
    """Locks a folder; while another process holds it, prints which one, and waits."""
    folder.mkdir(parents=True, exist_ok=True)
    with open(folder / "lock", "a+") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            lock.seek(0)
            holder = lock.read()
            print(f"{program}: waiting for another run in {folder}"
                  f"{f' (process {holder})' if holder else ''} ...", file=sys.stderr, flush=True)
            fcntl.flock(lock, fcntl.LOCK_EX)
        lock.truncate(0)
        lock.write(str(os.getpid()))
        lock.flush()
        yield


def children(pid):
    """The processes that one has begun and that have not ended, the oldest first."""
    found = []
    for path in pathlib.Path(f"/proc/{pid}/task").glob("*/children"):
        with contextlib.suppress(OSError):
            found += map(int, path.read_text().split())
    return sorted(found)


def adopt_orphans():
    """Makes processes that programs leave behind children of this process instead of init."""
    become_subreaper = 36
    ctypes.CDLL(None).prctl(become_subreaper, 1)


def end_orphans():
    """Ends processes that stay for two seconds; returns a line for each of them."""
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
