# SPDX-License-Identifier: MIT
"""version: reads the version of the product from CHANGELOG.md, the only place in which it is
written.

    tools/python -m icesoc.release.version     prints the version
"""
import re

from icesoc import TREE
from icesoc.util.errors import Stop

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


if __name__ == "__main__":
    print(newest())
