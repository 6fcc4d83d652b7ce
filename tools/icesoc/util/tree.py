# SPDX-License-Identifier: MIT
"""tree: lists the files of a checkout, and returns the state of folders and hashes of commits."""
import subprocess
from pathlib import Path

from icesoc.util.errors import Stop
from icesoc.util.files import write
from icesoc.util.process import collect, output


def commit(name, option="BASE"):
    """Returns the full hash of a commit."""
    found = output(["git", "rev-parse", "--verify", "-q", f"{name}^{{commit}}"], check=False)
    if not found:
        raise Stop(f"unknown commit {option}={name}", 2)
    return found.strip()


def tracked(source):
    """Returns the paths of all files in the tree, except those that .gitignore excludes. Also works
    in a copy without the data of git."""
    return collect(["git", "-C", source, "grep", "--no-index", "--exclude-standard", "--no-color",
                "-l", ""])[1].splitlines()


def tree_state(source, folders):
    """Returns the state of some folders as text, such as "bus hdl: 0123...". If the text has
    changed since a measurement, the measurement is out of date."""
    files = sorted(f for f in tracked(source) if f.split("/")[0] in folders.split())
    def hashes(text, *words):
        return subprocess.run(["git", "hash-object", *words], input=text, text=True, cwd=source,
                              check=True, stdout=subprocess.PIPE).stdout
    names = "".join(f"{file}\n" for file in files)
    return f"{folders}: {hashes(names + hashes(names, '--stdin-paths'), '--stdin')[:16]}"


def write_state(folder, state):
    """Stores the state of the tree at a measurement in the folder of the measurement's results."""
    write(Path(folder, "tree"), state + "\n")


def read_state(folder):
    """Returns the stored state of a measurement, or "" if none is stored."""
    path = Path(folder, "tree")
    return path.read_text().strip() if path.exists() else ""
