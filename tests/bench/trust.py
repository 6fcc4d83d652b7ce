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

HOSTILE = "Vehicles/Attacked.NothingHostileIsAcceptedAndNothingLegalLostOrDoubled/"
FIGURES = [  # program, tests, property, text
    (0, "Update.WhereverThePowerIsCutThereIsAnImageThatBoots", "cuts", "new firmware: losses of power, in each operation and later"),
    (0, "Fpga.WhereverThePowerIsCutABitstreamConfiguresIt", "cuts", "new bitstream: losses of power, in each operation and later"),
    (1, HOSTILE + "0:" + HOSTILE + "1", "packets", "hostile packets, full link layer"),
    (1, HOSTILE + "2:" + HOSTILE + "3", "packets", "hostile packets, minimal link layer"),
]
HARM = {"cuts": "it does not start again", "packets": "one accepted, or a legal message lost or doubled"}


def run(program, tests, hostile):
    """What the tests have recorded: properties, and expectations that failed."""
    with tempfile.NamedTemporaryFile() as out:
        subprocess.run([program, "--gtest_filter=" + tests, "--gtest_output=json:" + out.name],
                       env={**os.environ, "HOSTILE": hostile}, stdout=subprocess.DEVNULL)
        return json.load(out)["testsuites"][0]["testsuite"]


def main(words):
    if len(words) < 3:
        sys.exit(__doc__)
    entries = []
    for program, tests, name, text in FIGURES:
        found = run(words[program], tests, "2000" if "--brief" in words else "10000000")
        failures = sum(len(test.get("failures", [])) for test in found)
        for what, value, unit in (text, sum(int(test[name]) for test in found), name), ("of these: " + HARM[name], failures, "failures"):
            entries.append({"name": what, "value": value, "unit": unit, "command": "make bench"})
    with open(words[2], "w") as file:
        json.dump(entries, file, indent=1)
        file.write("\n")


main(sys.argv[1:])
