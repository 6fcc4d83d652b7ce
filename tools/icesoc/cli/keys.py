# SPDX-License-Identifier: MIT
"""keys: manages certificates, and private keys in ~/.config/icesoc (or XDG_CONFIG_HOME), outside
the build folders.

All trees of a user share the keys. A copy of a tree contains none of them, and no command deletes
them."""
import filecmp
import hashlib
import os
import re
import subprocess
import tempfile
from pathlib import Path

from icesoc.util.console import say
from icesoc.util.errors import Stop
from icesoc.util.lock import lock
from icesoc.util.process import run

MOST_NAME = 64  # longest name (CN) in a certificate, characters (RFC 5280, ub-common-name)


def folder():
    place = Path(os.environ.get("XDG_CONFIG_HOME") or Path.home() / ".config") / "icesoc"
    place.mkdir(mode=0o700, parents=True, exist_ok=True)
    return place


def rescue(built):
    """Moves keys out of the folder `built` and the folders below it, where earlier versions stored
    them."""
    for pattern in ("demo.key", "update.key", "*/update.key"):
        for old in sorted(Path(built).glob(pattern)):
            new = folder() / old.name
            if new.exists() and not filecmp.cmp(old, new, shallow=False):
                digest = hashlib.sha256(old.read_bytes()).hexdigest()
                new = new.with_name(f"{old.stem}-{digest[:8]}.key")
            new.touch(mode=0o600)
            new.write_bytes(old.read_bytes())
            old.unlink()
            say(f"{old} was moved to {new}: keys are kept outside the build folders")


def check_folder(path):
    """Fails unless the folder for a new file exists."""
    if not Path(path).parent.is_dir():
        raise Stop(f"folder '{Path(path).parent}' not found; create it first", 2)


def make_certificate(path):
    """Creates a PEM file with a certificate (CN: the name of the file) and its private key (P-256),
    valid for ten years. authority.key in the same folder signs the certificate. Returns False if
    the file exists."""
    path = Path(path)
    authority, signs = path.with_name("authority.pem"), path.with_name("authority.key")
    if os.path.lexists(path) or path == authority:
        return False
    check_folder(path)
    if len(path.stem) > MOST_NAME or re.search("[\ud800-\udfff]", path.stem):
        raise Stop(f"{path.name!a}: expected at most {MOST_NAME} characters in UTF-8 before the "
                   f"suffix, got {len(path.stem)}; they are the name in the certificate", 2)
    before = os.umask(0o077)
    try:
        with lock(path.parent), tempfile.TemporaryDirectory(dir=path.parent) as work:
            cert, key = Path(work, "cert"), Path(work, "key")
            check_authority(authority, signs)
            if not signs.exists():
                sign("icesoc", cert, key, "CA:TRUE")
                cert.chmod(0o644)  # a certificate is public
                key.rename(signs)
                cert.rename(authority)
            sign(path.stem, cert, key, "CA:FALSE", "-CA", authority, "-CAkey", signs)
            cert.write_text(cert.read_text() + key.read_text())
            os.link(cert, path)
    except FileExistsError:  # another process created it first
        return False
    finally:
        os.umask(before)
    return True


def check_authority(authority, signs):
    """Fails unless certificate and key of the authority are regular files, and only their owner can
    read the key."""
    if os.path.lexists(authority) != os.path.lexists(signs):
        raise Stop(f"expected both '{authority}' and '{signs}', or neither, got one; restore the "
                   "missing file")
    for path in authority, signs:
        if os.path.lexists(path) and not path.is_file():
            raise Stop(f"'{path}': expected a regular file")
    if signs.exists() and signs.stat().st_mode & 0o077:
        raise Stop(f"others may read '{signs}': chmod 600 '{signs}', and make new certificates if "
                   "another user may have read it")


def sign(name, cert, key, constraint, *by):
    # An unescaped plus sign or slash would begin another part of the subject.
    name = name.replace("\\", "\\\\").replace("+", "\\+").replace("/", "\\/")
    # a separate openssl.cnf is used, because the machine's file may make every certificate an
    # authority
    settings = cert.with_name("openssl.cnf")
    settings.write_text("[req]\ndistinguished_name = name\n[name]\n")
    run(["openssl", "req", "-x509", "-utf8", "-config", settings, "-newkey", "ec", "-pkeyopt",
         "ec_paramgen_curve:P-256", "-nodes", "-days", "3650", "-subj", f"/CN={name}", "-addext",
         f"basicConstraints=critical,{constraint}", "-keyout", key, "-out", cert, *by],
        stderr=subprocess.DEVNULL)
