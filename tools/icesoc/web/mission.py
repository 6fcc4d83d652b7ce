# SPDX-License-Identifier: MIT
"""mission: reads what the page of a flight shows from the files of the simulator and of the ground
station."""
import json
import os

import places

from icesoc.util import chip, rows

# bytes; a page shows only this last part of events.jsonl, because the file of a long flight is
# large
NEWEST = 128 << 10
MOST_VEHICLES = 32  # vehicles per modem on the ground
STATUS = places.record_of("testbench/status/sim_status.toml")
SCHEMA = os.path.dirname(os.path.abspath(__file__)) + "/../cli/flight.schema.json"
COUNTERS = ("ns", "cycles", "bytesUp", "bytesDown", "packets", "lost", "wallNs")
WRITTEN = 2


def contents(path):
    """Returns a file's content; empty if it cannot be read."""
    try:
        with open(path, "rb") as file:
            return file.read()
    except OSError:
        return b""


def picture(folder, address):
    """Returns the path of a vehicle's picture of this flight. After the vehicle has returned the
    corners, it is the picture with the corners drawn in."""
    paths = (f"{folder}/{name}{address}.png" for name in ("after", "before"))
    return next(filter(os.path.exists, paths), "")


def blocks_by_slot(build):
    """Returns [(slot, name of its block, the block)] for the chip of a build folder."""
    # Imported here, because the page of an installed gateway shows no registers and the package
    # lacks this module.
    from icesoc.regs.model import Block, Wrong
    try:
        return [(slot.slot, slot.name, Block.read(slot.registers, is_built=True))
                for slot in chip.read(os.path.join(build, chip.FILE)).slots]
    except Wrong as wrong:
        raise ValueError(wrong) from None


def register(block, word, value, seen):
    """Returns a word with its name and its fields. For a value written to EVENT, each bit that is 1
    is shown as "cleared", because it clears an event."""
    common = ("ID", "EVENT", "MASK")
    found = next((r for r in block.registers if r.word == word), None) if block else None
    clears = word == 1 and seen == WRITTEN
    fields = []
    for f in found.fields if found and word else []:
        bits = value >> f.lsb & (1 << f.width) - 1
        if bits or not clears:
            fields.append({"name": f.name, "value": "cleared" if clears else bits, "doc": f.doc})
    name = found.name if found else common[word] if word < 3 else f"word {word}"
    return {"word": word, "value": value, "written": seen == WRITTEN, "name": name,
            "doc": found.doc if found and word > 2 else "", "fields": fields}


def heading(folder):
    """Returns the options in flight.json that differ from their defaults, as text."""
    try:
        with open(SCHEMA) as schema, open(folder + "/flight.json") as file:
            fields, flight = json.load(schema)["properties"], json.load(file)
    except (OSError, ValueError):
        return ""
    hidden = ("version", "out", "firmware", "key", "port", "live")
    return ", ".join(f"{name} {value if not isinstance(value, list) else ' '.join(value)}"
                     for name, value in flight.items()
                     if name not in hidden and value != fields.get(name, {}).get("default"))


def state(folder, slots):
    """Returns the data of the page, read from files of the simulator and the ground station. If a
    file is missing, its fields are empty."""
    shown = {"calls": [], "features": [], "slots": [], "flight": heading(folder)}
    status = contents(folder + "/status")
    if len(status) >= STATUS.size and status.startswith(STATUS.constants["SIM_MAGIC"].encode()):
        values = STATUS.unpack(status)
        shown["air"] = {name: values[name] for name in COUNTERS}
        registers, seen = values["registers"], values["seen"]
        for slot, name, block in slots:
            words = [register(block, word, registers[slot * 16 + word], seen[slot * 16 + word])
                     for word in range(16) if seen[slot * 16 + word]]
            shown["slots"].append({"slot": slot, "block": name, "doc": block.doc if block else "",
                                   "words": words})
    for row in rows.read(folder + "/calls.jsonl"):
        if "features" in row:
            shown.update(features=row["features"], found=row["found"])
        else:
            shown["calls"].append(row)
    shown["events"] = list(rows.read(folder + "/events.jsonl", NEWEST))
    changed = {name: os.stat(path).st_mtime_ns for name in ("before.png", "report.json")
               if os.path.exists(path := f"{folder}/{name}")}
    shown["frame"] = "before.png" in changed
    others = ((address, picture(folder, address)) for address in range(2, MOST_VEHICLES + 1))
    shown["others"] = [[address, os.path.basename(path)] for address, path in others if path]
    # If the report is older than the picture, it belongs to the previous mission.
    shown["over"] = len(changed) == 2 and changed["report.json"] >= changed["before.png"]
    return shown
