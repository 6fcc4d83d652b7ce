# SPDX-License-Identifier: MIT
"""rows: reads the logs of a flight: flight.jsonl and events.jsonl of the simulator, and calls.jsonl
of the ground station. A line is a JSON object; its "ns" is the simulated time, and its other keys
are the kind of the row (docs/simulation.md)."""
import json
import os


def read(path, newest=0):
    """Yields the rows of a log, or with `newest` the rows in its last bytes. Skips any other line,
    such as a last line that is incomplete; a missing file has no rows."""
    try:
        file = open(path, "rb")
    except OSError:
        return
    with file:
        if newest and file.seek(0, os.SEEK_END) > newest:
            file.seek(-newest, os.SEEK_END)
            file.readline()  # skips the rest of a line that begins before these bytes
        else:
            file.seek(0)
        for line in file:
            try:
                row = json.loads(line)
            except (ValueError, RecursionError):
                continue
            if isinstance(row, dict):
                yield row
