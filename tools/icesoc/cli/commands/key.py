# SPDX-License-Identifier: MIT
"""key: the command that makes keys and certificates."""
from pathlib import Path

from icesoc.cli import flight, keys
from icesoc.cli.build_folder import configured
from icesoc.cli.command import command
from icesoc.cli.options import BUILD, COUNT, FILE, JOBS, PATH, SWITCH, Option
from icesoc.util.console import say
from icesoc.util.errors import Stop
from icesoc.util.process import run


@command("key", [
    Option("file", PATH, "output file", "", positional=True),
    Option("certificate", SWITCH, "make a TLS certificate for the gateway; the file name becomes "
                                  "its subject. It is signed by authority.pem in the same folder; "
                                  "a missing authority.pem is created"),
    Option("signing", SWITCH, "make a private key for signing updates, and its public half "
                              "(spare.pub for spare.key); an existing key is kept"),
    Option("list", COUNT, "make list number N of the signing keys; N must be the number of "
                          "the previous list plus 1"),
    Option("by", FILE, "private key that signs the list; it must be in the previous list"),
    Option("first", FILE, "first public key of the list"),
    Option("second", FILE, "second public key of the list"), BUILD, JOBS], make="key",
         brief=("key build/brief/key/my.key", "key build/brief/key/pilot.pem --certificate",
                "key build/brief/key/spare.key --signing",
                "key build/brief/key/next.update --list 2 --by build/brief/key/spare.key --first "
                "build/brief/key/spare.pub"),
         examples=["key my.key", "run --key my.key", "key certificates/pilot.pem --certificate",
                   "key spare.key --signing",
                   "key next.update --list 2 --by spare.key --first spare.pub --second next.pub"])
def key(values):
    """make a key for the radio link, or a certificate

    Also makes keys that sign updates, and lists of such keys. docs/security.md explains link
    keys and certificates; docs/firmware.md explains signing keys."""
    if not values.file:
        raise Stop("key: expected the name of a file: ./icesoc key my.key", 2)
    parts = values.list, values.by, values.first
    if any((*parts, values.second)) and not all(parts):
        raise Stop("key: expected --list NUMBER, --by PRIVATE_KEY and --first PUBLIC_KEY together, "
                   "got only some of them", 2)
    if sum(map(bool, (values.certificate, values.signing, values.list))) > 1:
        raise Stop("key: expected at most one of --certificate, --signing and --list", 2)
    if values.signing or values.list:
        pack = configured(values, "pack_update") / "sw/update/pack_update"
        public = Path(values.file).with_suffix(".pub")
        if values.signing:
            run([pack, "public", values.file, public])
            say(f"{values.file} signs updates; {public} is its public half")
        else:
            run([pack, "keys", values.list, values.by, values.first,
                 *([values.second] if values.second else []), values.file])
            say(f"made {values.file}; send it with sw/ground/clients/update.py")
        return
    make = keys.make_certificate if values.certificate else flight.make_key
    if not make(values.file):
        raise Stop(f"'{values.file}' already exists, and a key is never overwritten; "
                   "choose another name")
    used = "" if values.certificate else f": ./icesoc run --key {values.file}"
    say(f"made {values.file}, which only you can read{used}")
