# SPDX-License-Identifier: MIT
"""figures: finds figures in pages and pictures that differ from their sources, and corrects the
pages.

The sources are docs/figures.md (written by `./icesoc bench`), synth/baseline.json (written by
`./icesoc synth accept`), and the pictures: the text that a page shows is in its picture's PNG file,
and the picture of the mission contains what `make run` printed. `./icesoc build figures` writes the
figures into the pages, and `make test NAME=tree.figures` compares them.

    figures TREE    prints a line for each figure that differs; exit status 1 if there is one
"""
import re
import struct
import sys
import zlib
from pathlib import Path

from icesoc.synth.baseline import read_baseline
from icesoc.util.errors import reason_of
from icesoc.util.files import write

KEYWORD = b"Description"  # keyword of the PNG chunk with the text

PICTURE = "docs/pictures/{}.png"
MISSION = PICTURE.format("mission")

# The output of `make run` in README.md. The picture of the same flight contains the same text.
TRANSCRIPT = re.compile(r"(?<=are left out here:\n\n```\n).*?(?=```)", re.S)

# Page or picture -> texts that it contains. In these texts, a name in braces stands for a figure.
# If a figure has no source, it must be the same in all texts that contain its name.
PLACES = {
    "README.md": [
        "after linking (`./icesoc build size`) | {minimal} |",
        "removes as unused (`./icesoc build size`) | {unlinked} |",
        "| flip-flops | 1537 | {table1.ff} | {flown.ff} |",
        "| LUT sites | 1728 | {table1.sites} ({table1.low} to {table1.high}) | "
        "{flown.sites} ({flown.low} to {flown.high}) |",
        "| slices | 772 | {table1.slices} ({table1.less} to {table1.more}) | "
        "{flown.slices} ({flown.less} to {flown.more}) |",
        "with authentication (`make test NAME=CallBytes`) | {air.key} | "
        "MAVLink 2, signed: {mav.key} |",
        "without authentication (`make test NAME=CallBytes`) | {air.clear} | "
        "MAVLink 2: {mav.clear} |",
        "with authentication (`./icesoc bench`) | {command.key} | MAVLink 2, signed: {mav.ms} |",
        "the vehicle to a program, with authentication (`./icesoc bench`) | {down.key} | "
        "the modem's limit: {down.limit} |",
        "| 0 of {hostile} |",
        "a firmware update (`./icesoc bench`) | 0 of {firmware} |",
        "a bitstream update (`./icesoc bench`) | 0 of {bitstream} |",
        "| FSMC | 1116 | {minimal.fsmc} | {full.fsmc} |",
        "| radio | 1795 | {minimal.radio} | {full.radio} |",
        "| link | 1307 | {minimal.link} | {full.link} |",
        "| IceC | 2622 | {minimal.icec} | {full.icec} |",
        "| radio endpoint | not listed | {minimal.endpoint} | {full.endpoint} |",
        "| encryption | none | none | {full.crypto} |",
        "| all | 6840 | {minimal} | {full} |",
        "occupies {ram} of the chip's",
        "s {mission.corners} corners; the core took {mission.cycles} cycles"],
    MISSION: ["s {mission.corners} corners; the core took {mission.cycles} cycles",
              "cornersFound {mission.corners},"],
    PICTURE.format("live"): ["{mission.corners} corners, the strongest ",
                             "cornersFound {mission.corners},"],
    "docs/utilisation.md": [
        "with these, the blocks of Table I take {table1.through} LUTs. ",
        "The blocks of Table I take {table1.lut} LUTs, {table1.ff} flip-flops and about "
        "{table1.slices} slices",
        "Counted in this way, the blocks take about {table1.sites} sites,",
        "put the sites at {table1.low} to {table1.high} and the slices at {table1.less} to "
        "{table1.more}.",
        "They take {flown.sites} LUT sites ({flown.low} to {flown.high}), {flown.ff} flip-flops "
        "and {flown.slices} slices ({flown.less} to {flown.more})",
        "four cores takes {soc.lut} LUTs, {soc.ff} flip-flops and {soc.dsp} DSP blocks",
        "blocks of Table I is {table1.mhz} MHz",
        "the chip's is {soc.slowest} to {soc.fastest} MHz (median {soc.mhz})"],
    "docs/faq.md": [
        "| LUTs of the FPGA | 9,112 | {soc.lut} by the chip",
        "| flip-flops of the FPGA | 18,224 | {soc.ff} |",
        "| DSP blocks of the FPGA | 32 | {soc.dsp}, by fir |",
        "| RAM of the microcontroller | 131,072 bytes | {ram}; without",
        "a number as parameter, ms | {call.clear} | {call.key} |",
        "the vehicle sends pictures, ms | {busy.clear} | {busy.key} |",
        "from the vehicle to the ground station, bytes/s | {down.clear} | {down.key} |",
        "from the ground station to the vehicle, bytes/s | {up.clear} | {up.key} |"],
    "docs/fleet.md": [
        "| look-ups per second and CPU | {lookups} with 10,000 names |",
        "| registrations per second and CPU | {registrations}, each written to disk |",
        "| {events.one} to one subscriber, {events.ten} to ten each |"],
    "docs/security.md": ["uses {stack.key} of its 2,048 bytes of stack, and {stack.clear} in open"],
    "docs/firmware.md": [
        "| task switch, mean, cycles | {m3.switch} |",
        "| interrupts off, at most, µs | {m3.masked} |",
        "| processor load with an idle link, % | {m3.idle} |",
        "| all cycles of a call, in the clear | {m3.clear} |",
        "| all cycles of a call, with a key | {m3.key} |"],
    "docs/link.md": ["The smallest program has {minimal} bytes."],
    "docs/icec.md": ["ours have {minimal} bytes."],
    "docs/hw-mapping.md": ["({soc.lut} LUTs, {soc.ff} flip-flops)"],
    PICTURE.format("utilisation"): [
        "{soc.lut} LUT ", " {soc.ff} FF ", " {soc.slices} slices ",
        " {soc.mhz} MHz required: 100 MHz; 5 mappings with different port orders: {soc.slowest} to "
        "{soc.fastest} MHz ",
        "flip-flops {table1.ff} ", "LUTs of the netlist {table1.lut} ",
        "LUTs and route-throughs, before map pairs them {table1.through} ",
        "LUT sites, map's average pairing (estimate; as mapped {table1.low}-{table1.high}) "
        "{table1.sites} ",
        "slices (estimate; as mapped {table1.less}-{table1.more}) {table1.slices} "],
    PICTURE.format("regression"): ["{run.failed} failed", " of {run.plan} requirements"],
    "docs/regression.md": ["{run.failed} tests fail, and ", " of {run.plan} requirements are red"],
}


def text_of(picture):
    """Returns the text that a PNG file contains; empty if it has none."""
    data, at = Path(picture).read_bytes(), 8
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        content = data[at + 8:at + 8 + size]
        if kind == b"zTXt" and content.startswith(KEYWORD + b"\0"):
            return zlib.decompress(content[len(KEYWORD) + 2:]).decode("utf-8")
        at += size + 12
    return ""


def put_text(picture, text):
    """Puts a text into a PNG file, after its header."""
    data = Path(picture).read_bytes()
    chunk = b"zTXt" + KEYWORD + b"\0\0" + zlib.compress(text.encode("utf-8"), 9)
    header = 8 + 12 + 13  # length of the signature and the chunk IHDR
    Path(picture).write_bytes(
        data[:header] + struct.pack(">I", len(chunk) - 4) + chunk
        + struct.pack(">I", zlib.crc32(chunk)) + data[header:])


def printed(log, out):
    """Returns the lines of a mission's log that README.md shows; out: folder of the flight."""
    lines = re.findall(r"^(?:icesoc-sim: | *[\d.]+ s  |Pictures and report).*\n", log, re.M)
    return "".join(lines).replace(str(out), "build/run")


def content(tree, place):
    """Returns the text of a page or of a picture."""
    path = Path(tree, place)
    return text_of(path) if place.endswith(".png") else path.read_text()


def rows(tree):
    """Returns {name: first number} for the rows of docs/figures.md that have one column of figures.
    A row with a limit gives a second entry, `limit of NAME`."""
    found = {}
    for name, value, limit in re.findall(
            r"^\| ([^|]+) \| ([\d,.]+) [^|]*\| (?:limit ([\d.]+))?[^|]*\|$",
            Path(tree, "docs/figures.md").read_text(), re.M):
        found[name] = value.replace(",", "")
        if limit:
            found[f"limit of {name}"] = limit
    return found


def cells(tree):
    """Returns {"ROW [COLUMN]": first number} for the tables of docs/figures.md that have several
    columns of figures. A cell with a limit gives a second entry, `limit of ROW [COLUMN]`."""
    found: dict[str, str] = {}
    columns: list[str] = []
    for line in Path(tree, "docs/figures.md").read_text().splitlines():
        name, *cells_ = [cell.strip() for cell in line.strip("|").split("|")]
        if name == "what":
            columns = cells_
        elif line.startswith("| ") and "measured" not in columns:
            for column, cell in zip(columns, cells_):
                if match := re.match(r"([\d,.]+)(?: of ([\d,.]+),)?", cell):
                    for prefix, number in zip(("", "limit of "), match.groups()):
                        if number:
                            found[f"{prefix}{name} [{column}]"] = number.replace(",", "")
    return found


def values(tree):
    """Returns {name: figure} for the figures that have a source. A figure is a text without commas
    between thousands."""
    measured = {**rows(tree), **cells(tree)}
    designs = read_baseline(Path(tree, "synth/baseline.json"))["designs"]
    found = {f"{name}.{key}": str(designs[design][key])
             for name, design in (("table1", "table1"), ("flown", "table1_flown"), ("soc", "soc"))
             for key in ("lut", "ff", "slices", "dsp", "mhz")}
    clear = "setParameterA and its reply on the air, in the clear; limit: MAVLink 2"
    key = "the same with a key; limit: MAVLink 2, signed"
    for name, row in {
            "air.clear": clear, "mav.clear": f"limit of {clear}",
            "air.key": key, "mav.key": f"limit of {key}",
            "minimal": "minimal.all", "unlinked": "minimal.all without --gc-sections",
            "hostile": "hostile packets",
            "firmware": "new firmware: power losses, in each operation and later",
            "bitstream": "new bitstream: power losses, in each operation and later",
            "ram": "full: RAM with all objects and all stacks, including the main stack",
            "registrations": "registrations with 10000 vehicles, per second of CPU time",
            "lookups": "look-ups with 10000 vehicles, per second of CPU time",
            "events.one": "events to 1 subscribers, per second of CPU time",
            "events.ten": "events to 10 subscribers, per second of CPU time",
            "command.key": "round trip of a command, limit: MAVLink 2, ms [with a key]",
            "mav.ms": "limit of round trip of a command, limit: MAVLink 2, ms [with a key]",
            "call.clear": "Ice, round trip of note(int), ms [in the clear]",
            "call.key": "Ice, round trip of note(int), ms [with a key]",
            "busy.clear": "Ice, call during a picture transfer, ms [in the clear]",
            "busy.key": "Ice, call during a picture transfer, ms [with a key]",
            "down.clear": "Ice, goodput UAV to ground in the clear, bytes/s [loss 0.00]",
            "down.key": "Ice, goodput UAV to ground with a key, bytes/s [loss 0.00]",
            "down.limit": "limit of Ice, goodput UAV to ground with a key, bytes/s [loss 0.00]",
            "up.clear": "Ice, goodput ground to UAV in the clear, bytes/s [loss 0.00]",
            "up.key": "Ice, goodput ground to UAV with a key, bytes/s [loss 0.00]",
            "m3.switch": "task switch (PendSV with entry and return), mean",
            "m3.masked": "interrupts off, longest",
            "m3.idle": "call: processor load without calls (1 kHz tick), % [with a key]",
            "m3.clear": "call: all cycles of a call, without ticks, cycles [in the clear]",
            "m3.key": "call: all cycles of a call, without ticks, cycles [with a key]",
            "stack.clear": "stack used: radioStack, bytes [in the clear]",
            "stack.key": "stack used: radioStack, bytes [with a key]"}.items():
        if row in measured:
            found[name] = measured[row]
    layers = {f"{program}.{layer}": measured[f"{program}.{layer}"]
              for program in ("minimal", "full")
              for layer in ("link", "icec", "fsmc", "radio", "crypto", "endpoint")
              if f"{program}.{layer}" in measured}
    full = sum(int(bytes_) for name, bytes_ in layers.items() if name.startswith("full."))
    return {**found, **layers, "full": str(full)}


def pattern(text):
    """Converts a text of PLACES to a regular expression. Returns the expression, and the names of
    the figures in the text."""
    names = re.findall(r"\{([\w.]+)\}", text)
    parts = [re.escape(part).replace(r"\ ", r"\s+") for part in re.split(r"\{[\w.]+\}", text)]
    return re.compile(r"([\d,]+(?:\.\d+)?)".join(parts)), names


def differences(tree, places=None):
    """Yields a line for each figure that differs from its source, or from the same figure in an
    earlier place."""
    known = {name: (value, "its source") for name, value in values(tree).items()}
    for place, texts in (places or PLACES).items():
        contained = content(tree, place)
        for text in texts:
            regular, names = pattern(text)
            if not (found := regular.search(contained)):
                yield f"{place}: expected '{text}', found no such text"
                continue
            for name, shown in zip(names, found.groups()):
                value, where = known.setdefault(name, (shown.replace(",", ""), place))
                if float(shown.replace(",", "")) != float(value):
                    yield f"{place}: {name} is {shown}, but {value} in {where}"
    shown = TRANSCRIPT.search(content(tree, "README.md"))
    if not shown or shown[0] != content(tree, MISSION):
        yield f"README.md: expected the output of make run that {MISSION} contains, found another"


def figures_of_pictures(tree):
    """Returns the figures that the texts of the pictures contain."""
    found = {}
    for place, texts in PLACES.items():
        if place.endswith(".png"):
            contained = content(tree, place)
            for regular, names in map(pattern, texts):
                if match := regular.search(contained):
                    found |= zip(names, (shown.replace(",", "") for shown in match.groups()))
    return found


def correct(tree, given=None):
    """Writes the figures into the pages. A figure is taken from `given` or, if it is not there,
    from its source or else from a picture. Also copies the mission's output into README.md. Yields
    the names of the changed pages; pictures are not changed."""
    known = {**figures_of_pictures(tree), **values(tree), **(given or {})}
    readme = Path(tree, "README.md")
    was = readme.read_text()
    now = TRANSCRIPT.sub(lambda found: content(tree, MISSION) or found[0], was)
    if now != was:
        write(readme, now)
        yield "README.md"
    for place, texts in PLACES.items():
        if place.endswith(".png"):
            continue
        page = Path(tree, place)
        was = now = page.read_text()
        for text in texts:
            regular, names = pattern(text)
            if not (found := regular.search(now)):
                continue
            for group in range(len(names), 0, -1):
                shown, value = found[group], known.get(names[group - 1])
                if value is not None and float(value) != float(shown.replace(",", "")):
                    new = f"{int(value):,}" if "," in shown and "." not in value else value
                    now = now[:found.start(group)] + new + now[found.end(group):]
        if now != was:
            write(page, now)
            yield place


def main(words):
    if len(words) != 1 or words[0].startswith("-"):
        sys.exit(__doc__)
    try:
        wrong = list(differences(words[0]))
    except OSError as error:
        sys.exit("figures: " + reason_of(error))
    if wrong:
        print(*wrong, "./icesoc build figures pages  # writes the pages", sep="\n")
        print("./icesoc build figures synth pictures pages  # also retakes pictures of pages")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
