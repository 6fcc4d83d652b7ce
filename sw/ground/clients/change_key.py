#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""change_key: gives a vehicle a new key over the link, and the key file with it.

If this program is interrupted at any point, vehicle and file have a key in common, and the next run
continues. The file has both keys before the vehicle gets the new one. The vehicle has both until
a session with the new key is established; then the old key is removed from the file.
"""

import argparse
import contextlib
import fcntl
import os
import secrets
import sys

import Ice

import places
import plugged
import provide_key


def write(path, lines):
    """Writes a file with these lines next to `path`, readable only by the owner of `path`. Returns
    its name."""
    temporary = path + ".new"
    with contextlib.suppress(FileNotFoundError):
        os.remove(temporary)
    with open(os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w") as f:
        if os.geteuid() == 0:  # the file of the gateway's user keeps its owner
            owner = os.stat(path)
            os.chown(f.fileno(), owner.st_uid, owner.st_gid)
        f.write("\n".join(lines) + "\n")
        f.flush()
        os.fsync(f.fileno())
    return temporary


def keys_of(lines, address):
    """Returns the vehicle's line and its words, KEY [NEXT]; without one, the line for
    all."""
    found = None
    for number, line in enumerate(lines):
        words = line.split("#")[0].split()
        if words and words[0].startswith("0x"):
            if int(words[0], 16) == address:
                return number, words[1:]
        elif words:
            found = len(lines), words
    return found


def talk(args, key_file, what):
    """Calls `what` with the vehicle's KeyRing, in a separate session."""
    communicator = plugged.initialize({"Ice.Default.InvocationTimeout": str(1000 * args.patience)},
                                      args.plugin, args.guard,
                                      key_file)
    try:
        import Autopilot  # made by loadSlice
        return what(Autopilot.KeyRingPrx.uncheckedCast(communicator.stringToProxy(
            "keys:xbee-at -d %s -a 0x%04x -t %d" %
            (args.device, args.address, 1000 * args.patience))))
    finally:
        communicator.destroy()


@contextlib.contextmanager
def alone(path):
    """Keeps other programs of this kind from the file meanwhile: two would each give the vehicle a
    key, and the file might keep the wrong one."""
    folder = os.open(os.path.dirname(path) or ".", os.O_RDONLY | os.O_DIRECTORY)
    try:
        fcntl.flock(folder, fcntl.LOCK_EX | fcntl.LOCK_NB)
        yield
    except BlockingIOError:
        raise RuntimeError("another change_key is at work in the folder of '%s'" % path) from None
    finally:
        os.close(folder)


def change(args):
    args.key = os.path.realpath(args.key)  # a link stays one
    if not os.path.isfile(args.key):
        raise RuntimeError("'%s': expected a regular file, which is rewritten" % args.key)
    with alone(args.key):
        change_alone(args)


def change_alone(args):
    provide_key.read_key(args.key, args.address)  # each line makes sense
    with open(args.key) as f:
        lines = f.read().splitlines()
    number, keys = keys_of(lines, args.address)
    if len(keys) == 1:
        keys.append(secrets.token_hex(16))
    name = "0x%04x " % args.address
    lines[number:number + 1] = [name + " ".join(keys)]
    os.replace(write(args.key, lines), args.key)
    if not talk(args, args.key, lambda ring: ring.setNextKey(bytes.fromhex(keys[1]))):
        raise RuntimeError("the vehicle refuses a new key: was the session in the clear?")
    lines[number] = name + keys[1]
    new = write(args.key, lines)
    if talk(args, new, lambda ring: ring.count()) != 1:
        raise RuntimeError("the vehicle has not taken the new key; both are in the file: try again")
    os.replace(new, args.key)
    print("change_key: vehicle 0x%04x and %s have a new key; the old one opens nothing any more" % (
        args.address, args.key))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--device", required=True, help="serial port of the modem")
    parser.add_argument("--key", required=True, help="key file; it is rewritten")
    parser.add_argument("--plugin", default=places.plugin(), help="folder of libxbeeat.so.37")
    parser.add_argument("--slice", default=places.slice_file("Autopilot.ice"),
                        help="Autopilot.ice")
    parser.add_argument("--address", type=lambda text: int(text, 0), default=1,
                        help="address of the vehicle")
    parser.add_argument("--guard", type=int, default=1000, help="guard time of the modem, ms")
    parser.add_argument("--patience", type=int, default=60, help="seconds that an answer may take")
    args = parser.parse_args()
    Ice.loadSlice("", ["-I" + (Ice.getSliceDir() or "."), args.slice])
    try:
        change(args)
        return 0
    except Ice.UserException as e:
        sys.exit("change_key: %s" % ("the vehicle flies: it takes no key before it has landed"
                                     if e.ice_id() == "::Autopilot::InFlight" else e))
    except (Ice.Exception, provide_key.Failed, RuntimeError, OSError) as e:
        sys.exit("change_key: %s" % e)


if __name__ == "__main__":
    sys.exit(main())
