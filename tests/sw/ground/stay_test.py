# SPDX-License-Identifier: MIT
"""stay_test: Ctrl-C ends a vehicle that stays after its mission in order, also if the signal
arrives twice: the terminal sends it, and so does the simulator that started the program."""
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

CLIENTS = Path(__file__).resolve().parents[3] / "sw/ground/clients"

# The gateway ends only when the file `second` exists, after the second signal.
GATEWAY = """#!/bin/sh
trap 'touch ending; while [ ! -e second ]; do sleep 0.01; done; exit 0' TERM
echo 'port 4711 leads to uav1 '
while :; do sleep 0.01; done
"""
PROGRAM = """
import argparse
import sys
import plugged
import stay
plugged.interrupt_once()
sys.exit(stay.serve(argparse.Namespace(out=".", plugin=".", device="none", guard=20, key="",
                                       wire=False, vehicles=1, live=True)))
"""


def wait_for(path, process):
    while not os.path.exists(path):
        if process.poll() is not None:
            raise AssertionError(f"{path} is missing, and the program has ended")
        time.sleep(0.01)


class Stay(unittest.TestCase):
    def test_a_second_ctrl_c_changes_nothing(self):
        with tempfile.TemporaryDirectory() as folder:
            work = Path(folder)
            (work / "icesoc-gateway").write_text(GATEWAY)
            (work / "icesoc-gateway").chmod(0o755)
            with subprocess.Popen(
                    [sys.executable, "-c", PROGRAM], cwd=work, stderr=subprocess.PIPE, text=True,
                    env={**os.environ, "PYTHONPATH": str(CLIENTS)}) as process:
                wait_for(work / "vehicles.conf", process)
                process.send_signal(signal.SIGINT)
                wait_for(work / "ending", process)
                process.send_signal(signal.SIGINT)
                (work / "second").touch()
                self.assertEqual(process.stderr.read(), "")
            self.assertEqual(process.returncode, 130)


if __name__ == "__main__":
    unittest.main()
