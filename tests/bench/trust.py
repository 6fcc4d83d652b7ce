#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""trust: what attackers and losses of power did to the link and to updates, as their tests have counted it.

    trust.py TEST_UPDATE TEST_LINK OUTPUT.json [--brief]
"""
import json
import os
import subprocess
import sys
import tempfile

FIGURES = [  # program, test, property, text
    (0, "Update.WhereverThePowerIsCutThereIsAnImageThatBoots", "cuts", "new firmware: losses of power, in each operation and later"),
    (0, "Fpga.WhereverThePowerIsCutABitstreamConfiguresIt", "cuts", "new bitstream: losses of power, in each operation and later"),
    (1, "Vehicles/Attacked.NothingHostileIsAcceptedAndNothingLegalLostOrDoubled/0", "packets", "hostile packets, full link layer"),
    (1, "Vehicles/Attacked.NothingHostileIsAcceptedAndNothingLegalLostOrDoubled/2", "packets", "hostile packets, minimal link layer"),
]
HARM = {"cuts": "it does not start again", "packets": "one accepted, or a legal message lost or doubled"}


def run(program, test, hostile):
    """What the test has recorded: properties, and expectations that failed."""
    with tempfile.NamedTemporaryFile() as out:
        subprocess.run([program, "--gtest_filter=" + test, "--gtest_output=json:" + out.name],
                       env={**os.environ, "HOSTILE": hostile}, stdout=subprocess.DEVNULL)
        return json.load(out)["testsuites"][0]["testsuite"][0]


def main(words):
    if len(words) < 3:
        sys.exit(__doc__)
    entries = []
    for program, test, name, text in FIGURES:
        found = run(words[program], test, "2000" if "--brief" in words else "1000000")
        for what, value, unit in (text, int(found[name]), name), ("of these: " + HARM[name], len(found.get("failures", [])), "failures"):
            entries.append({"name": what, "value": value, "unit": unit, "command": "make bench"})
    with open(words[2], "w") as file:
        json.dump(entries, file, indent=1)
        file.write("\n")


main(sys.argv[1:])
