# SPDX-License-Identifier: MIT
"""stay: keeps a vehicle reachable after its mission, until Ctrl-C (LIVE=1) or as long as a browser
shows the page of the flight. Starts the gateway on the modem of the mission, and writes
OUT/vehicles.conf, by which `./icesoc call` and programs of one's own find the vehicles:

    Vehicle.uav1=tcp -h 127.0.0.1 -p 40001
    Flight.Process=4711
    Flight.Build=/.../build/main

The server of the page writes OUT/viewed about once per second while a browser shows the page, and
removes it when the page is closed. The file contains "opening" until a browser that was started
with the flight has loaded the page.
"""

import contextlib
import os
import re
import shutil
import subprocess
import sys
import threading
import time

import vehicles
from mission_log import whole

# time without a request after which the page counts as closed, s; in a hidden tab, browsers send
# only one request per minute. Also the time that a browser has after the mission to load the page.
HIDDEN = 75
GRACE = 3  # waiting time after the page was closed, s; another tab may still show it


def is_viewed(folder):
    """Returns whether a browser shows the page of the flight."""
    try:
        return time.time() - os.stat(os.path.join(folder, "viewed")).st_mtime < HIDDEN
    except OSError:
        return False


def await_browser(folder):
    """If a browser has been started but has not loaded the page yet, gives it HIDDEN seconds from
    now to load the page."""
    path = os.path.join(folder, "viewed")
    with contextlib.suppress(OSError):
        with open(path) as file:
            if file.read() == "opening":
                os.utime(path)


def gateway_program(args):
    """Returns the path of the gateway in the build folder, or of the installed gateway; None if
    there is neither."""
    return shutil.which("icesoc-gateway", path=os.pathsep.join(
        [args.plugin, os.environ.get("PATH", os.defpath)]))


def is_wanted(args):
    """Returns whether the vehicle must stay reachable after its mission."""
    await_browser(args.out)
    if not args.live and not is_viewed(args.out):
        return False
    if gateway_program(args):
        return True
    print("stay: no gateway, so the page cannot make calls: LIVE=1 or --live builds the gateway",
          file=sys.stderr)
    return False


def end_with_page(folder, process):
    """Ends a process when no browser has shown the page for GRACE seconds."""
    while process.poll() is None:
        time.sleep(0.5)
        if not is_viewed(folder):
            time.sleep(GRACE)
            if not is_viewed(folder):
                process.terminate()


def gateway(args):
    """Starts the gateway as a child process that ends together with this program."""
    words = ["setpriv", "--pdeathsig", "TERM", "--", gateway_program(args),
             "--device", args.device, "--guard", str(args.guard), "--listen", "127.0.0.1:0",
             *(["--key", args.key] if args.key else []), *(["--wire"] if args.wire else [])]
    for address in range(1, args.vehicles + 1):
        words += ["--vehicle", f"uav{address}=0x{address:04x}"]
    return subprocess.Popen(words, stdout=subprocess.PIPE, text=True)


def serve(args):
    """Serves until a signal ends this program; returns the exit status."""
    path, found = os.path.join(args.out, "vehicles.conf"), {}
    with gateway(args) as process:
        if not args.live:
            threading.Thread(target=end_with_page, args=(args.out, process), daemon=True).start()
        try:
            for line in process.stdout:
                if one := re.search(r"port (\d+) leads to (\w+) ", line):
                    found[one[2]] = f"tcp -h 127.0.0.1 -p {one[1]}"
                if len(found) == args.vehicles:
                    with whole(path) as temporary, open(temporary, "w") as file:
                        file.write(vehicles.text(
                            found, Process=os.getpid(),
                            Build=os.path.dirname(os.path.abspath(args.plugin))))
                    found = {}
            status = process.wait()
            if not args.live and not is_viewed(args.out):
                return 0
            print(f"stay: the gateway ended (exit status {status})", file=sys.stderr)
            return 1
        except KeyboardInterrupt:
            return 130
        finally:
            with contextlib.suppress(FileNotFoundError):
                os.remove(path)
            process.terminate()
