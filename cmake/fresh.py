#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""fresh: does what the README says, in its order, on an empty Debian; prints last lines and times.

A machine is a folder that debootstrap fills, with a clone of this tree's HEAD and nothing else: no
package, no cache. Its mount points and processes are its own and end with it. debootstrap, unshare
and chroot need root.
"""

import argparse
import os
import pathlib
import shutil
import subprocess
import sys
import time

TREE = pathlib.Path(__file__).resolve().parent.parent
RELEASES = {"bookworm": "Debian 12", "trixie": "Debian 13"}
COMMANDS = ("make run", "make test")
KEYRING = "/usr/share/keyrings/debian-archive-keyring.gpg"
CERTIFICATES = "/etc/ssl/certs/ca-certificates.crt"
# Run as the machine's first process; what it mounts stays its own.
BOOT = """
mount --make-rprivate / && mount -t proc proc "$1/proc" && mount --rbind /dev "$1/dev" &&
mount --rbind /sys "$1/sys" &&
exec chroot "$1" /bin/sh -c "cd /root/icesoc && $2"
"""


def fail(text):
    sys.exit(f"fresh: {text}")


def empty_machine(root, release, mirror):
    shutil.rmtree(root, ignore_errors=True)
    root.parent.mkdir(parents=True, exist_ok=True)
    log = root.parent / f"{release}-debootstrap.log"
    with log.open("w") as out:
        words = ["--variant=minbase", "--include=git,make,ca-certificates", release, root, mirror]
        if subprocess.call(["debootstrap", *words], stdout=out, stderr=out):
            fail(f"debootstrap has no {release} from {mirror}: see {log}")
    (root / "etc/apt/sources.list").unlink(missing_ok=True)
    (root / "etc/apt/sources.list.d/debian.sources").write_text(
        f"Types: deb\nURIs: {mirror}\nSuites: {release} {release}-updates\nComponents: main\n"
        f"Signed-By: {KEYRING}\n")
    # How this machine reaches its network: name servers, proxies, certificates.
    shutil.copy("/etc/resolv.conf", root / "etc/resolv.conf")
    for file in pathlib.Path("/etc/apt/apt.conf.d").glob("*[0-9]*"):
        if any(word in file.read_text() for word in ("Proxy", "Check-Date")):
            shutil.copy(file, root / "etc/apt/apt.conf.d")
    if os.path.exists(CERTIFICATES):
        shutil.copy(CERTIFICATES, root / CERTIFICATES.lstrip("/"))


def put_tree(root):
    clone = root / "root/icesoc"
    if clone.exists():
        subprocess.check_call(["git", "-C", clone, "fetch", "--quiet", TREE, "HEAD"])
        subprocess.check_call(["git", "-C", clone, "reset", "--quiet", "--hard", "FETCH_HEAD"])
    else:
        subprocess.check_call(["git", "clone", "--quiet", "--no-hardlinks", TREE, clone])


def run(root, release, command):
    log = root.parent / f"{release}-{command.replace(' ', '-')}.log"
    kept = {name: value for name, value in os.environ.items() if name.lower().endswith("_proxy")}
    place = {"HOME": "/root", "PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "TERM": "dumb"}
    begun = time.monotonic()
    with log.open("w") as out:
        own = ["unshare", "--mount", "--pid", "--fork", "--kill-child"]
        status = subprocess.call([*own, "sh", "-c", BOOT, "sh", root, command], env=kept | place,
                                 stdin=subprocess.DEVNULL, stdout=out, stderr=subprocess.STDOUT)
    seconds = time.monotonic() - begun
    print(f"{RELEASES[release]}: {command}: exit status {status}, "
          f"{seconds // 60:.0f} min {seconds % 60:.0f} s; {log}")
    lines = log.read_text(errors="replace").splitlines()
    print("\n".join("    " + line for line in lines[-12:]), flush=True)
    return status


def main():
    parser = argparse.ArgumentParser(description="Do what the README says on an empty Debian.")
    parser.add_argument("release", nargs="*", default=list(RELEASES),
                        help=f"{' or '.join(RELEASES)}; all, unless said")
    parser.add_argument("--folder", type=pathlib.Path,
                        default=pathlib.Path("/var/tmp/icesoc-fresh"),
                        help="where machines and logs go (%(default)s; about 8 GB each)")
    parser.add_argument("--again", action="store_true",
                        help="go on with the machines of before, with HEAD as it is now")
    parser.add_argument("--mirror", default="http://deb.debian.org/debian")
    parser.add_argument("--run", action="append", metavar="COMMAND",
                        help=f"in place of {', '.join(COMMANDS)}")
    args = parser.parse_args()
    for release in args.release:
        if release not in RELEASES:
            parser.error(f"'{release}' is none of {', '.join(RELEASES)}")
    for tool in ("debootstrap", "unshare", "chroot"):
        if not shutil.which(tool):
            fail(f"{tool} is missing: apt-get install {tool}")
    if os.geteuid():
        fail("an empty machine needs root: chroot and mount are not for others")
    failed = 0
    for release in args.release:
        root = args.folder.resolve() / release
        if not (args.again and (root / "root").is_dir()):
            empty_machine(root, release, args.mirror)
        put_tree(root)
        for command in args.run or COMMANDS:
            failed |= run(root, release, command) != 0
    return failed


if __name__ == "__main__":
    sys.exit(main())
