# SPDX-License-Identifier: MIT
"""fresh: runs the README's commands, in order, on an empty Debian 12 and 13, and tests the packages
that they build on another empty system.

A machine is a folder that debootstrap fills, with a clone of this tree's HEAD. It has no further
package and no cache. The machine that tests the packages has no clone. Each machine has separate
mounts and processes, which end when the machine ends.
"""
import json
import os
import re
import shutil
import subprocess
import time
from pathlib import Path

from icesoc.cli.command import command
from icesoc.cli.options import FOLDER, INPUT_FOLDER, SWITCH, TEXT, Option, one_of
from icesoc.release import build
from icesoc.util.console import say
from icesoc.util.errors import SKIPPED, Stop
from icesoc.util.process import output, run

RELEASES = {"bookworm": "Debian 12", "trixie": "Debian 13"}
README = ["make run", "make test"]
PACKAGES = "packages"  # name of the step that builds, installs and uses the packages
MIRROR = "http://deb.debian.org/debian"
CERTIFICATES = Path("/etc/ssl/certs/ca-certificates.crt")
# Script of the first process of a machine, in a separate mount namespace.
BOOT = """
mount --make-rprivate / && mount -t proc proc "$1/proc" && mount --rbind /dev "$1/dev" &&
mount --rbind /sys "$1/sys" && exec chroot "$1" /bin/sh -c "cd $3 && $2"
"""


@command("check fresh", [
    Option("release", one_of(*RELEASES), "limit the test to one Debian release", ""),
    Option("again", SWITCH, "reuse the existing systems, and update their clones to HEAD"),
    Option("steps", TEXT, "commands to run, separated by semicolons",
           "; ".join([*README, PACKAGES])),
    Option("packages", INPUT_FOLDER, "only test the Debian packages in this folder, such as "
                                     "build/release, in a new system of the given --release"),
    Option("folder", FOLDER, "folder for the systems and their logs; each system takes 8 GB",
           "/var/tmp/icesoc-fresh"),
    Option("list", SWITCH, "only print earlier results, each with its status and duration")],
         brief="check fresh --list", long="check fresh", examples=[
             "check fresh --release trixie", "check fresh --again --steps 'make test'",
             "check fresh --release bookworm --packages build/packages"])
def fresh(values):
    """run the README's commands on an empty Debian 12 and 13

    Also installs the packages there and uses them without the source tree. Needs root,
    debootstrap and a network. Exit status 77: this user is not root, or debootstrap is missing.
    """
    top, failed = Path(values.folder), 0
    results = top / "results.json"
    rows = json.loads(results.read_text()) if results.exists() else []
    if values.list:
        return say("\n".join(map(summary, rows)) or f"{top} contains no results")
    if os.geteuid():
        raise Stop("check fresh: expected root, because it uses mount and chroot; use sudo",
                   SKIPPED)
    if not shutil.which("debootstrap"):
        raise Stop("check fresh: debootstrap not found; install it: apt-get install debootstrap",
                   SKIPPED)
    for release in [values.release] if values.release else RELEASES:
        root = top / release
        steps = [PACKAGES] if values.packages else [
            step.strip() for step in values.steps.split(";")]
        if not values.packages:
            if not (values.again and (root / "root").is_dir()):
                empty_machine(root, release)
            put_tree(root)
        for step in steps:
            if step == PACKAGES:
                done = use_packages(root, release, values)
            else:
                done = [do(root, release, step)]
            for row in done:
                failed |= row["status"] != 0
                rows = [each for each in rows
                        if (each["release"], each["step"]) != (release, row["step"])] + [row]
            results.write_text(json.dumps(rows, indent=1) + "\n")
    return failed


def use_packages(root, release, values):
    """Builds the packages in the machine with the clone, unless they are given, then uses them in
    an empty machine. Returns the results."""
    rows, folder = [], values.packages
    if not folder:
        rows = [do(root, release, "make package CHECK=1")]
        folder = root / "root/icesoc/build/packages"
        if rows[0]["status"]:
            return rows
    machine = root.parent / f"{release}-packages"
    if not (values.again and (machine / "root").is_dir()):
        empty_machine(machine, release)
    there = machine / "srv/packages"  # the package files must be readable by all users
    shutil.rmtree(there, ignore_errors=True)
    shutil.copytree("tests/package", there)
    for path in Path(folder).glob(f"*~deb{RELEASES[release].split()[1]}_*.deb"):
        shutil.copy(path, there)
    files = root.parent / f"{release}-icec"
    build.build(Path.cwd(), files, ["icec"], "")
    shutil.copy(next(files.glob("icec-*.tar.gz")), there)
    rows.append(do(machine, release, "sh machine.sh", "/srv/packages"))
    if not rows[-1]["status"]:
        rows.append(do(machine, release, "sh service.sh", "/srv/packages", booted=True))
    return rows


def summary(row):
    return (f"{RELEASES[row['release']]}: {row['step']}: exit status {row['status']}, "
            f"{row['minutes']} min, {row['commit']}")


def empty_machine(root, release):
    log = Path(f"{root}-debootstrap.log")
    say(f"Installing {RELEASES[release]} in {root} takes some minutes; log: {log} ...")
    shutil.rmtree(root, ignore_errors=True)
    root.parent.mkdir(parents=True, exist_ok=True)
    run(["debootstrap", "--variant=minbase", "--include=git,make,ca-certificates", release, root,
         MIRROR], stdout=open(log, "w"))
    (root / "etc/apt/sources.list").write_text("".join(
        f"deb {MIRROR} {suite} main\n" for suite in (release, f"{release}-updates")))
    # The system is discarded afterwards, so dpkg need not wait for the disk.
    (root / "etc/dpkg/dpkg.cfg.d/unsafe-io").write_text("force-unsafe-io\n")
    # Copies the network settings of the host: name servers, proxies, certificates.
    shutil.copy("/etc/resolv.conf", root / "etc/resolv.conf")
    for file in Path("/etc/apt/apt.conf.d").iterdir():
        if any(word in file.read_text() for word in ("Proxy", "Check-Date")):
            shutil.copy(file, root / "etc/apt/apt.conf.d")
    if CERTIFICATES.exists():
        shutil.copy(CERTIFICATES, root / CERTIFICATES.relative_to("/"))


def put_tree(root):
    clone = root / "root/icesoc"
    if not clone.exists():
        return run(["git", "clone", "--quiet", "--no-hardlinks", Path.cwd(), clone])
    run(["git", "-C", clone, "fetch", "--quiet", Path.cwd(), "HEAD"])
    return run(["git", "-C", clone, "reset", "--quiet", "--hard", "FETCH_HEAD"])


def do(root, release, step, folder="/root/icesoc", booted=False):
    """Runs one step in a folder of the test system, and prints the last lines of the step's
    output. If `booted` is true, the test system is booted with systemd; otherwise the step runs in
    a chroot."""
    words = re.findall(r"[\w.]+", step)
    log = Path("-".join([str(root), *words]) + ".log")
    place = {"HOME": "/root", "PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "TERM": "dumb"}
    kept = {name: value for name, value in os.environ.items() if name.lower().endswith("_proxy")}
    words = ["sh", "tests/package/boot.sh", root, folder, step] if booted else [
        "unshare", "--mount", "--pid", "--fork", "--kill-child", "env", "-i",
        *(f"{name}={value}" for name, value in (kept | place).items()), "sh", "-c", BOOT, "sh",
        root, step, folder]
    begun = time.monotonic()
    say(f"{RELEASES[release]}: {step}; log: {log} ...")
    with open(log, "w") as file:
        status = run(words, check=False, stdin=subprocess.DEVNULL, stdout=file, stderr=file)
    row = {
        "release": release, "step": step, "status": status,
        "minutes": round((time.monotonic() - begun) / 60, 1), "commit": output([
            "git", "describe", "--always"]).strip()}
    say(summary(row))
    say("\n".join("    " + line for line in log.read_text(errors="replace").splitlines()[-12:]))
    return row
