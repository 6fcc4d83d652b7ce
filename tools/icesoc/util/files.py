# SPDX-License-Identifier: MIT
"""files: writes files atomically, and computes digests of files."""
import hashlib
import pathlib
import shutil

from icesoc.util.errors import Stop


def write(path, text):
    """Writes a file atomically: a reader sees either the whole old text or the whole new text. A
    link to a file stays a link, and a file keeps its permissions."""
    target = pathlib.Path(path).resolve()
    is_file = target.is_file()
    # a device, such as /dev/stdout, is written directly
    part = target.with_name(f"{target.name}.part") if is_file or not target.exists() else target
    try:
        part.write_text(text)
        if is_file:
            shutil.copymode(target, part)
        if part != target:
            part.replace(target)
    except OSError as error:
        if part != target:
            part.unlink(missing_ok=True)
        raise Stop(f"cannot write {path}: {error.strerror}") from None


def digest(parts):
    return hashlib.sha1("\0".join(parts).encode()).hexdigest()[:16]
