# SPDX-License-Identifier: MIT
"""stay: keeps a vehicle reachable after its mission. Starts the gateway at the mission's modem, and
writes OUT/live.json, by which `./icesoc call` finds the flight:

    {"pid": 4711, "build": "/.../build/main", "vehicles": {"uav1": "tcp -h 127.0.0.1 -p 40001"}}
"""

import contextlib
import json
import os
import re
import subprocess
import sys

from mission_log import whole


def gateway(args):
    """Starts the gateway as a process that ends with this one."""
    words = ["setpriv", "--pdeathsig", "TERM", "--", os.path.join(args.plugin, "icesoc-gateway"),
             "--device", args.device, "--guard", str(args.guard), "--listen", "127.0.0.1:0",
             *(["--key", args.key] if args.key else []), *(["--wire"] if args.wire else [])]
    for address in range(1, args.vehicles + 1):
        words += ["--vehicle", f"uav{address}=0x{address:04x}"]
    return subprocess.Popen(words, stdout=subprocess.PIPE, text=True)


def serve(args):
    """Serves until a signal ends this program; returns an exit status."""
    path, vehicles = os.path.join(args.out, "live.json"), {}
    with gateway(args) as process:
        try:
            for line in process.stdout:
                if found := re.search(r"port (\d+) leads to (\w+) ", line):
                    vehicles[found[2]] = f"tcp -h 127.0.0.1 -p {found[1]}"
                if len(vehicles) == args.vehicles:
                    with whole(path) as temporary, open(temporary, "w") as file:
                        json.dump({"pid": os.getpid(), "vehicles": vehicles,
                                   "build": os.path.dirname(os.path.abspath(args.plugin))}, file)
                    vehicles = {}
            print(f"stay: the gateway ended (exit status {process.wait()})", file=sys.stderr)
            return 1
        except KeyboardInterrupt:
            return 130
        finally:
            with contextlib.suppress(FileNotFoundError):
                os.remove(path)
            process.terminate()
