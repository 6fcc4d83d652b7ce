# SPDX-License-Identifier: MIT
"""version: reads the version of the product from CHANGELOG.md, the only place in which it is
written.

    tools/python -m icesoc.release.version     prints the version
"""
import re
import subprocess
import time
from pathlib import Path

from icesoc import TREE
from icesoc.util.errors import Stop
from icesoc.util.process import output

HEADING = re.compile(r"^## (\S+)[^\n]*\n(.*?)(?=^## |\Z)", re.M | re.S)


def sections(text=None):
    """Returns the sections of the changelog, newest first: (title, text)."""
    if text is None:
        text = (TREE / "CHANGELOG.md").read_text(encoding="utf-8")
    return [(title, body.strip()) for title, body in HEADING.findall(text)]


def newest(text=None):
    """Returns the newest version that the changelog lists."""
    for title, _ in sections(text):
        if re.fullmatch(r"\d+\.\d+\.\d+", title):
            return title
    raise Stop("CHANGELOG.md: expected a heading such as '## 1.0.0', got none; add one")


def unreleased(text=None):
    """Returns the changes since the newest version."""
    return dict(sections(text)).get("Unreleased", "")


def of_text(text, commit, seconds):
    """Returns the version of a commit with this changelog. If the changelog has unreleased changes,
    the version consists of the last version and the time and hash of the commit: dpkg regards it as
    newer than the last version and than the versions of earlier commits. `seconds` is the time of
    the commit."""
    if not unreleased(text):
        return newest(text)
    when = time.strftime("%Y%m%d%H%M%S", time.gmtime(seconds))
    return f"{newest(text)}+git.{when}.{commit[:12]}"


def of_commit(tree=TREE):
    """Returns the version of the last commit. If the tree is not a repository, for instance
    an unpacked release, returns the newest version."""
    text = (Path(tree) / "CHANGELOG.md").read_text(encoding="utf-8")
    if not (Path(tree) / ".git").exists():
        return newest(text)
    found = output(["git", "-C", str(tree), "log", "-1", "--format=%H %ct"], check=False,
                   stderr=subprocess.DEVNULL).split()
    return of_text(text, found[0], int(found[1])) if found else newest(text)


if __name__ == "__main__":
    print(newest())
