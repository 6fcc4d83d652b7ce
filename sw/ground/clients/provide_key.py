#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""provide_key: gives a vehicle its address and its key over the serial port of its microcontroller,
in the factory or after a key was lost.

Connect the port to PA9 and PA10, start this program, then switch the vehicle on. During its start,
the vehicle looks for a break (a line held low) on this port. If the vehicle finds a break, it waits
for a key.
"""

import argparse
import fcntl
import os
import re
import select
import stat
import sys
import termios
import time
import tty

# numbers from Linux' ioctl_tty(2); the module termios of Python 3.11 does not define them
TIOCSBRK, TIOCCBRK = 0x5427, 0x5428
GROUP = 0xFFFF  # address that key files use for the group key
PIPE_WAIT = 10  # time-out for the first bytes if the key file is a pipe, s
# length of the break and of the pause after it, s; a vehicle without a key restarts every second,
# so at least one of its starts is during the break
BREAK, PAUSE = 1.5, 0.5


class Failed(Exception):
    """The vehicle did not accept a new key; the text gives the reason."""


def address(text):
    """Returns the number of an address, such as 0x0001 or 1."""
    if not re.fullmatch("0[xX][0-9a-fA-F]{1,4}|0|[1-9][0-9]{0,4}", text) or int(text, 0) > 0xFFFF:
        raise argparse.ArgumentTypeError(
            "expected 0 to 65535, or 0x0000 to 0xFFFF, got '%s'" % text)
    return int(text, 0)


def open_secret(path):
    """Opens a key file for reading. Accepts a regular file, or a pipe that another process writes.
    The file must belong to this user, and other users must have no access to it."""
    # O_NONBLOCK, because opening a pipe that no process writes would wait
    fd = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)
    try:
        found = os.fstat(fd)
        if not stat.S_ISREG(found.st_mode) and not stat.S_ISFIFO(found.st_mode):
            raise Failed("'%s': expected a file or a pipe" % path)
        if found.st_mode & 0o077:
            raise Failed("'%s' can be read by other users: chmod 600 '%s'" % (path, path))
        if found.st_uid not in (os.geteuid(), 0):
            raise Failed("'%s' belongs to another user: chown it to the user who runs this "
                         "program" % path)
        if found.st_size > 65536:
            raise Failed("'%s' is too long for a key file" % path)
        if stat.S_ISFIFO(found.st_mode) and not select.select([fd], [], [], PIPE_WAIT)[0]:
            raise Failed("'%s' is a pipe to which no program writes" % path)
        os.set_blocking(fd, True)
        return open(fd, encoding="utf-8-sig", errors="replace", newline="\n")
    except BaseException:
        os.close(fd)
        raise


def read_key(path, vehicle):
    """Returns a vehicle's key from a key file. As in the plugin (docs/security.md), uses the line
    that begins with the vehicle's address, or the line without an address if no such line
    exists."""
    keys = {}
    with open_secret(path) as f:
        for number, line in enumerate(f.read(65536).split("\n"), 1):
            words = " ".join(line.split("#")[0].split())
            found = re.fullmatch("(0x[0-9a-fA-F]{1,4} )?([0-9a-fA-F]{32})( [0-9a-fA-F]{32})?",
                                 words)
            owner = int(found[1], 16) if found and found[1] else None
            if words and (not found or owner in keys):
                raise Failed("'%s', line %d: expected [ADDRESS] KEY [NEXT], with keys of 32 "
                             "hexadecimal digits, one line for each vehicle" % (path, number))
            if words:
                keys[owner] = found[2].lower()
    if not keys:
        raise Failed("'%s' has no key: expected 32 hexadecimal digits, such as openssl rand -hex "
                     "16 prints" %
                     path)
    key = keys.get(vehicle, None if vehicle == GROUP else keys.get(None))
    if not key:
        raise Failed("'%s' has no line for the vehicle 0x%04x" % (path, vehicle))
    return key


def call_number():
    """Returns the current number for calls to all vehicles: quarters of a second since the start of
    2026 (sw/link/link_broadcast.h). A vehicle ignores such calls if they are older than its key."""
    number = int((time.time() - 1767225600) * 4)
    if not 0 < number < 1 << 31:
        raise Failed("the clock of this computer: expected a date after 2026-01-01, got %s; set it "
                     "first, because calls to all vehicles are numbered by it" %
                     time.strftime("%Y-%m-%d"))
    return number


def read_line(port, seconds):
    """Returns the bytes that arrive up to the end of a line or until the time-out expires."""
    text, end = b"", time.monotonic() + seconds
    while b"\n" not in text and select.select([port], [], [], max(0, end - time.monotonic()))[0]:
        text += os.read(port, 100)
    return text.decode(errors="replace").strip()


def provide(port, command, patience):
    end = time.monotonic() + patience
    while "icesoc: key?" not in (asked := read_line(port, PAUSE)):
        if time.monotonic() > end:
            raise Failed("no vehicle has asked for a key in %d s: check the wires, and switch the "
                         "vehicle on while this program waits" % patience)
        fcntl.ioctl(port, TIOCSBRK)
        time.sleep(BREAK)
        termios.tcflush(port, termios.TCIFLUSH)
        fcntl.ioctl(port, TIOCCBRK)
    if "protection is off" in asked:
        print("provide_key: read protection is off: anyone with access to the board can read its "
              "key (--protect sets it)", file=sys.stderr)
    os.write(port, command.encode() + b"\n")
    answer = read_line(port, 10)
    if answer != "ok":
        raise Failed("the vehicle has not accepted the command: expected 'ok', got '%s'" % answer)


def main():
    parser = argparse.ArgumentParser(
        description=__doc__.split("\n\n")[0],
        formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog="examples:\n"
               "  %(prog)s --port /dev/ttyUSB0 --key uav1.key\n"
               "  %(prog)s --port /dev/ttyUSB0 --key fleet.keys --address 0x0007 --old old.key\n"
               "  %(prog)s --port /dev/ttyUSB0 --protect")
    parser.add_argument("--port", required=True,
                        help="serial port that is wired to PA9 and PA10 of the vehicle")
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--key", help="file with the key, mode 0600: 32 hexadecimal digits, or a "
                      "line \"ADDRESS KEY\" for each vehicle")
    what.add_argument("--open", action="store_true",
                      help="store no key: anyone with a radio can call the vehicle")
    what.add_argument("--protect", action="store_true",
                      help="store no key: set read protection level 1; switch the vehicle off and "
                      "on afterwards")
    parser.add_argument("--old", help="file with the current key of the vehicle; needed if the "
                        "vehicle has a key and PC2 is not wired to ground")
    parser.add_argument("--address", type=address, default=1,
                        help="address that the vehicle gets; also selects the line of the key file "
                        "(default 0x0001)")
    second = parser.add_mutually_exclusive_group()
    second.add_argument("--ground", type=address, help="modem address of a second ground station; "
                        "the key is for the link to this station only")
    second.add_argument("--fellow", type=address, help="modem address of another vehicle; the "
                        "key is for the link between the two vehicles only")
    second.add_argument("--group", action="store_const", dest="ground", const=GROUP,
                        help="store the key for calls to all vehicles, from the line 0xffff")
    parser.add_argument("--patience", type=int, default=120,
                        help="time for which to wait for a vehicle, s (default 120)")
    args = parser.parse_args()
    try:
        owner = GROUP if args.ground == GROUP else args.address
        key = "" if args.protect or args.open else read_key(args.key, owner)
        command = ("protect" if args.protect else
                   "group %08x %s" % (call_number(), key) if args.ground == GROUP else
                   ("ground %04x %s" % (args.ground, key)).strip() if args.ground is not None else
                   ("fellow %04x %s" % (args.fellow, key)).strip() if args.fellow is not None else
                   "%s %04x" % ("key " + key if key else "open", args.address))
        if args.old:
            command += " " + read_key(args.old, args.address)
        port = os.open(args.port, os.O_RDWR | os.O_NOCTTY)
        tty.setraw(port)
        mode = termios.tcgetattr(port)
        mode[4] = mode[5] = termios.B115200
        termios.tcsetattr(port, termios.TCSANOW, mode)
        provide(port, command, args.patience)
        print("provide_key: the vehicle %s" %
              ("has read protection" if args.protect else
               "has the key for calls to all vehicles" if args.ground == GROUP else
               "accepts a second ground station" if args.ground is not None else
               "accepts another vehicle" if args.fellow is not None else
               "has no key, and is open to anyone" if args.open else
               "has this key, and no other"))
        return 0
    except Failed as e:
        sys.exit("provide_key: %s" % e)
    except (OSError, termios.error) as e:
        file = getattr(e, "filename", None) or args.port
        sys.exit("provide_key: %s: %s" % (file, os.strerror(e.args[0])))
    except KeyboardInterrupt:
        return 130


if __name__ == "__main__":
    sys.exit(main())
