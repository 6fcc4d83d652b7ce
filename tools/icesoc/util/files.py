# SPDX-License-Identifier: MIT
"""files: writes files atomically, and computes digests of files."""
import hashlib
import pathlib

from icesoc.util.errors import Stop


def write(path, text):
    """Writes a file atomically: a reader sees either the whole old text or the whole new text."""
    part = pathlib.Path(f"{path}.part")
    try:
        part.write_text(text)
    except OSError:
        part.unlink(missing_ok=True)
        raise Stop(f"cannot write {path}; check whether the disk is full") from None
    part.replace(path)


def digest(parts):
    return hashlib.sha1("\0".join(parts).encode()).hexdigest()[:16]
