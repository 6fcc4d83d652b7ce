#!/usr/bin/python3 -I
# SPDX-License-Identifier: MIT
"""kept: runs a test whose result depends only on files. If none of these files has changed since
the test passed, prints the stored output instead.

Usage: kept.py OWN COMMAND [WORD...]   OWN: work folder of the test, which is emptied first, or ""

strace reports each file that the processes of the test open, look for or list, including programs
and libraries. A stored result consists of the output and the state of each of these files. For a
file of the tree, the state is its content; for any other file, its size and time of change. The
result is valid as long as all these files are unchanged. Outside the tree, two things do not count:
the names in a folder, and caches that every installation of a package writes. Installing a package
therefore invalidates a result only if the test uses a file of the package. All tests get the same
environment.

No result is stored for a test that fails, that is killed, or that used a file which changed during
the test. FRESH=1 runs every test. The results are below XDG_CACHE_HOME (~/.cache), and all clones
share them. The newest four results of each command are kept.
"""

import datetime
import hashlib
import json
import os
import pathlib
import re
import shutil
import stat
import subprocess
import sys
import tempfile
import time

ROOT = str(pathlib.Path(__file__).resolve().parents[3])
STRING = re.compile(r'"((?:[^"\\]|\\.)+)"')
WRITES = re.compile(
    "O_(WRONLY|RDWR|CREAT|TRUNC)|(rename|unlink|link|mkdir|rmdir|chmod|utime)")
# System caches, which are rewritten whenever any package is installed
CACHES = re.compile(r"^/etc/ld\.so\.cache$|^/var/(cache|lib/dpkg)/|/__pycache__(/|$)")
TRACING = ("strace", "-f", "--seccomp-bpf", "-qq", "-y", "-e", "signal=none", "-e", "trace=%file")


def portable(text):
    """Returns the text with a placeholder for the folder of a clone."""
    return re.sub(re.escape(ROOT) + r"(?![\w.-])", "@ROOT@", text)


def digest(data):
    return hashlib.sha256(data).hexdigest()


def state(path, listed):
    """Returns the state of a path as far as a test can observe it: whether it is missing, a file or
    a folder; the state of the file; the names in the folder, if the test listed them."""
    try:
        status = os.stat(path)
        if stat.S_ISDIR(status.st_mode):
            names = "\n".join(sorted(os.listdir(path))).encode() if listed else b""
            return "folder " + (digest(names) if listed else "")
        if path.startswith(ROOT + "/") and stat.S_ISREG(status.st_mode):
            return digest(pathlib.Path(path).read_bytes())
        return f"{status.st_size} {status.st_mtime_ns}"
    except OSError as error:
        return f"none {error.errno}"


def touched(trace):
    """Parses the lines of strace. Returns {path: (whether the test listed it, whether the test
    wrote it)}."""
    lines = pathlib.Path(trace).read_text(errors="surrogateescape").splitlines()
    whole = "\n".join(lines)
    # folders to which relative paths may refer
    here = {os.getcwd(), *re.findall(r"AT_FDCWD<(/[^>]*)>", whole)}
    here |= {os.path.join(b, n) for n in re.findall(r'\bchdir\("([^"]*)"', whole) for b in here}
    paths = {}
    for line in lines:
        call, _, rest = line.partition("(")
        ahead, _, result = (rest if " = " in rest else rest + " = ").rpartition(" = ")
        found = STRING.findall(ahead)[:1 if "execve" in call else None]
        names = [n.encode("latin1", "ignore").decode("unicode_escape") for n in found]
        bases = re.findall(r"(?:AT_FDCWD|\d+)<(/[^>]*)>", ahead) or here
        writes = bool(WRITES.search(line))
        for path in {*(os.path.normpath(os.path.join(b, n)) for n in names for b in bases),
                     *re.findall(r"<(/[^>]*)>", result)}:
            listed, written = paths.get(path, (False, False))
            paths[path] = (listed or "O_DIRECTORY" in line, written or writes)
    return paths


def main():
    own, command = sys.argv[1] and os.path.abspath(sys.argv[1]) + "/", sys.argv[2:]
    environment = {"PATH": os.environ["PATH"], "LC_ALL": "C.UTF-8"}
    words = [command, environment, pathlib.Path(__file__).read_text()]
    key = digest(portable(json.dumps(words, sort_keys=True)).encode())
    cache = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache")
    store = cache / "icesoc" / "verdicts" / key
    try:
        verdicts = json.loads(store.read_text())
    except (OSError, ValueError):
        verdicts = []
    for verdict in verdicts if not os.environ.get("FRESH") else []:
        if all(state(path.replace("@ROOT@", ROOT), listed) == was
               for path, (listed, was) in verdict["seen"].items()):
            print(f"kept: cached result of {verdict['date']}, because its inputs have not changed; "
                  "FRESH=1 runs the test again")
            print(verdict["said"].replace("@ROOT@", ROOT), end="")
            return 0
    shutil.rmtree(own or "/dev/null/", ignore_errors=True)
    # File times are rounded down to a tick of the kernel's clock. A file written just after the
    # start may therefore have an earlier time, so the start is set back by 50 ms.
    begin = time.time_ns() - 50_000_000
    with tempfile.TemporaryDirectory() as folder:
        trace, said = folder + "/trace", b""
        environment["TMPDIR"] = environment["HOME"] = folder
        compiled = str(cache / "icesoc/python")
        environment["PYTHONPYCACHEPREFIX"] = compiled  # see tools/python
        tracing = [*TRACING, "-o", trace]
        if not shutil.which("strace") or subprocess.run(tracing + ["true"],
                                                        stderr=subprocess.DEVNULL).returncode:
            print("kept: strace is missing, or not permitted here, so the test runs each time",
                  file=sys.stderr)
            return subprocess.call(command, env=environment)
        with subprocess.Popen(tracing + command, env=environment, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT) as run:
            for line in run.stdout:
                said += line
                sys.stdout.buffer.write(line)
                sys.stdout.flush()
        if run.returncode:
            return run.returncode if run.returncode > 0 else 128 - run.returncode
        seen = {}
        for path, (listed, written) in touched(trace).items():
            if own and path.startswith(own):
                # if the test followed a link, the target of the link counts
                path = os.path.realpath(path)
            if (path + "/").startswith((own or "/dev/", folder + "/", compiled + "/", "/proc/",
                                        "/dev/", "/sys/")):
                continue
            if not path.startswith(ROOT + "/") and path != ROOT:
                listed = False
                if CACHES.search(path):
                    continue
            read = not written and (listed or os.path.isfile(path)) and os.path.exists(path)
            if read and os.stat(path).st_mtime_ns > begin:
                # another process has changed the file meanwhile, so it is unknown what the test has
                # read
                return 0
            seen[portable(path)] = (listed, state(path, listed))
    date = datetime.datetime.now().strftime("%Y-%m-%d %H:%M")
    verdict = {"date": date, "said": portable(said.decode(errors="replace")), "seen": seen}
    store.parent.mkdir(parents=True, exist_ok=True)
    part = store.with_suffix(f".{os.getpid()}")
    part.write_text(json.dumps([verdict] + verdicts[:3]))
    part.replace(store)
    return 0


sys.exit(main())
