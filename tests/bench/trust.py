#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""trust: reports the results of attacks on the link and of power losses during updates, and the
number of additional bytes on the air if the link has a key. The tests count all these figures.

    trust.py TEST_UPDATE TEST_LINK OUTPUT.json [--brief]
"""
import json
import os
import subprocess
import sys
import tempfile

from figures import figure, leave

CALL = "Tags/CallBytes.ACallAndItsReplyTakeFewerBytesThanMavlink/"
HOSTILE = "Vehicles/Attacked.NoForgedMessageIsAcceptedAndNoValidMessageIsLostOrDuplicated/"
FIGURES = [  # program, names of the tests, property that the tests record, text in the table
    (0, "Update.APowerLossAtAnyPointLeavesABootableImage", "cuts",
     "new firmware: power losses, in each operation and later"),
    (0, "Fpga.APowerLossAtAnyPointLeavesABootableBitstream", "cuts",
     "new bitstream: power losses, in each operation and later"),
    (1, HOSTILE + "0:" + HOSTILE + "1", "packets", "hostile packets"),
    (1, CALL + "0", "bytes",
     "setParameterA and its reply on the air, in the clear; limit: MAVLink 2"),
    (1, CALL + "1", "bytes", "the same with a key; limit: MAVLink 2, signed"),
    (1, CALL + "2", "bytes", "the same with tags of 4 bytes")]
HARM = {"cuts": "vehicle or FPGA does not start again",
        "packets": "accepted packets, and valid messages lost or doubled"}


def run(program, tests, hostile):
    """Runs tests. Returns the properties that they recorded, and the expectations that failed."""
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
        value = sum(int(test[name]) for test in found)
        if name in HARM:
            failures = sum(len(test.get("failures", [])) for test in found)
            entries += [figure(text, value, name),
                        figure(f"harm: {HARM[name]}", failures, "failures")]
        else:
            entries.append(figure(text, value, name, limit=int(found[0]["mavlink"])))
    leave(words[2], entries)


main(sys.argv[1:])
