# SPDX-License-Identifier: MIT
"""release: makes the files of a release."""
from pathlib import Path

from icesoc.cli.command import command
from icesoc.cli.options import FOLDER, TEXT, WORDS, Option
from icesoc.release import build
from icesoc.util.console import say
from icesoc.util.errors import Stop


@command("release", [
    Option("only", WORDS, "parts to make: " + ", ".join(build.PARTS) + " (default: all)"),
    Option("packages", WORDS, "folders with the Debian packages, built from this commit by "
                              "./icesoc package on each release of Debian (default: build the "
                              "packages for this machine's release)"),
    Option("key", TEXT, "key that signs SHA256SUMS: a key file of minisign (NAME.sec), or the "
                        "name of a gpg key", ""),
    Option("out", FOLDER, "folder for the files, which is emptied first", "build/release")],
         brief="release --only source icec changes sbom --out build/brief/release/files", examples=[
             "release",
             "release --only source icec",
             "release --key ~/.minisign/icesoc.sec",
             "release --packages 'debian12 debian13'"])
def release(values):
    """make the files of a release: sources, packages, checksums

    Also makes IceC as one C file and header per component, and as packs for PlatformIO, Zephyr
    and CMSIS; the documentation; and a list of all components. Everything is made from the last
    commit. The same commit always gives the same bytes, except for a signature by gpg, which
    contains the time.
    """
    for part in values.only:
        if part not in build.PARTS:
            raise Stop(f"--only: expected one of {', '.join(build.PARTS)}, got '{part}'", 2)
    parts = values.only or list(build.PARTS)
    out = Path(values.out).absolute()
    number, made = build.build(Path.cwd(), out, parts, values.key, values.packages)
    for name in made:
        say(f"{(out / name).stat().st_size:>9} bytes  {out / name}")
    say(f"IceSoC {number}, "
        + ("signed." if values.key else "not signed: --key KEY signs SHA256SUMS."))
