# SPDX-License-Identifier: MIT
"""flight: the description of a flight, OUT/flight.json, which the simulator, the ground program and
the page read.

Each option below is a field of the description. flight.schema.json in this folder is generated from
the options (./icesoc commands --schema).
"""
import json
import os
import re
from pathlib import Path

from icesoc.board import make, model
from icesoc.cli import choices, keys
from icesoc.cli.build_folder import BuildFolder, read_list
from icesoc.cli.options import (BOARD, CORE_FOLDERS, COUNT, FILE, FOLDER, FRAME, KEY_FILE, PATH,
                                SEED, SHARE, SWITCH, TEXT, UCOS2, WORDS, Option, matching, number,
                                one_of)
from icesoc.regs.model import Wrong
from icesoc.util import rows
from icesoc.util.console import say
from icesoc.util.errors import Stop, nearest, reason_of
from icesoc.util.schema import limits, problems
from icesoc.util.spelling import option, switch

VERSION = 4
RECORDING = "flight.jsonl"  # written by the simulator (testbench/sim/recording.h)
FIELDS = [
    Option("image", FILE, "picture for the camera: PNG, JPEG or PGM",
           "/usr/share/xplanet/images/earth.jpg"),
    Option("size", FRAME, "size of the camera's frame in pixels", "320x240"),
    Option("threshold", number(0, 255, "grey levels"), "threshold of the vision core", 24),
    Option(
        "loss",
        matching(r"0?\.\d+|[01](\.0*)?", "0 to 1", float,
                 SHARE.schema, "N"), "share of packets lost on the air, in each direction", 0.0),
    Option("interference", SHARE, "share of each period of 20 ms during which other "
           "transmitters use the channel", 0.0),
    Option("distance", number(0, 100000, "metres", float),
        "distance between the modems in metres, with fading; 0 disables path loss",
           0.0),
    Option("trace", FILE, "CSV file with loss, RSSI and delay over time (docs/simulation.md), used "
                          "instead of --loss",
           ""),
    SEED,
    Option("out", FOLDER, "output folder of the flight", "build/run"),
    Option("cpu", one_of("host", "m3"),
           "host: host build of the firmware; m3: its ARM binary on a Cortex-M3 model",
           "host"),
    Option("app", one_of("uav", "minimal"),
           "uav: the mission; minimal: the small program of the paper's Table II (needs --cpu m3)",
           "uav"),
    Option("port", number(0, 65535), "TCP port of the flight's page; 0 selects a free port", 0),
    Option("live", SWITCH, "keep the page and the vehicle running until Ctrl-C, for ./icesoc call"),
    Option("cores", WORDS, "names of cores to call during the flight, such as fir; each has a "
                           "program ip/NAME/ground.py",
           choices=choices.flown, is_checked=False),
    Option(
        "camera", SWITCH,
        "send the picture through the pins of the camera core instead of writing it to memory"
    ),
    Option("wire", SWITCH, "connect vehicle and ground station by a serial cable, without modems"),
    Option("modem", one_of("s1", "s2c", "xb3"),
           "modems of vehicle and ground station: XBee series 1, S2C or XBee 3; --board changes "
           "the default to the board's modem", "s1"),
    Option("board", BOARD,
           "board of the vehicle: its name, its file board.toml, or a folder written by ./icesoc "
           "board make; the vehicle then runs the ARM binary", "",
           choices=choices.boards, is_checked=False),
    Option("fault", WORDS,
           "faults of the vehicle's board, such as D3:open D1-D2:short NWE:late=12ns "
           "(docs/simulation.md); the vehicle then runs the ARM binary"),
    Option("pins", FILE,
           "script that drives the input pins of cores (docs/simulation.md); OUT/pins.log records "
           "the output pins", ""),
    Option("probe", TEXT,
           "trigger of a probe core (ip/probe/README.md), such as u_fir.sent=1", ""),
    Option("key", KEY_FILE, "file with the link key of vehicle and ground station; default: a "
                            "demo key",
           ""),
    Option("open", SWITCH, "fly without a key, unencrypted"),
    Option("observer", KEY_FILE, "with --vehicles: file with the keys of a second ground station; "
                                 "default: demo keys", ""),
    Option("vehicles", number(1, 32), "number of vehicles on one channel; every vehicle except the "
                                      "first runs the ARM binary", 1),
    Option("update", FILE, "firmware (ELF) or bitstream (.bit, .bin) to send to the vehicle "
                           "instead of flying the mission", ""),
    Option("clk-hz", COUNT, "clock of the simulated chip in Hz", 100000000),
    Option("guard", number(2, 3300, "ms"), "guard time of both modems", 1000),
    Option("patience", number(1, unit="s"), "time-out for each answer of the vehicle", 300),
    Option("firmware", FILE, "firmware (ELF) to fly instead of the firmware of the build", ""), ]
# Fields that only the simulator accepts, in flight.json or on its command line. ./icesoc has
# separate options for these purposes.
_TEXT: dict = {"type": "string"}
_TIME: dict = {"type": "number", "minimum": 0}
_FLAG: dict = {"type": "boolean"}
_SPEED = {**_TEXT, "pattern": "real|max|viewed|0?[.][0-9]+|[0-9]{1,2}([.][0-9]+)?"}
INNER: dict[str, dict] = {name: {**kind, "description": text} for name, kind, text in [
    ("modem_key", {**_TEXT, "pattern": "[0-9a-fA-F]{32}"},
     "AES key of the vehicle's modem"),
    ("flash", _TEXT,
     "file with the microcontroller's flash, 1 MiB, made by pack_update; the flight updates it"),
    ("fpga_flash", _TEXT,
     "file with the FPGA's configuration flash, 2 MiB, made by pack_update; the flight updates it"),
    ("replay", _TEXT, "folder of a recorded flight to repeat without the ground program"),
    ("wave", _TEXT, "file for the waveform (FST) of a replay"),
    ("from", _TIME, "start of the waveform, s"),
    ("to", _TIME, "end of the waveform, s"),
    ("trouble", {**_TEXT, "pattern": "(away|twin|babble):[0-9]+:[0-9.]+:[0-9.]+"},
     "faults injected into several vehicles: away:2:1.5:3 moves the modem with address 2 out of "
     "reach after 1.5 s for 3 s; twin:2:... adds a vehicle with the same address; babble:2:... "
     "sends noise"),
    ("every_clock", _FLAG, "evaluate every clock, including quiet ones and clocks of idle "
     "cores (slow)"),
    ("speed", _SPEED, "real: simulated time follows real time; 0.25: a quarter of this speed; "
     "max: as fast as possible; viewed: as fast as possible until a browser shows the flight's "
     "page, then real"),
    ("duration", _TIME, "end after this simulated time, s"),
    ("gdb", {"type": "integer", "minimum": 0, "maximum": 65535},
     "port of the loopback interface on which to wait for GDB; 0 selects a free port"),
    ("quiet", _FLAG, "print nothing"),
]}
AGAIN = Option("again", PATH, "flight.json of an earlier flight to repeat; options given on the "
                              "command line replace its options")
OPTIONS = [*FIELDS, UCOS2, AGAIN, CORE_FOLDERS]


def empty(option):
    """Returns the value in flight.json for an option that is not given."""
    return {"boolean": False, "array": [], "string": ""}.get(option.kind.schema.get("type"),
                                                             option.default)


def schema_text():
    """Returns the schema as text, with one line per field."""
    lines = json.dumps({**schema(), "properties": None}, indent=1).split("\n")
    fields = ",\n".join(f"  {json.dumps(name)}: {json.dumps(rule)}"
                        for name, rule in schema()["properties"].items())
    at = next(number for number, line in enumerate(lines) if '"properties"' in line)
    required = json.dumps(schema()["required"])
    return "\n".join([*lines[:at], ' "properties": {', fields, " },", f' "required": {required},',
                      ' "additionalProperties": false', "}"]) + "\n"


def schema():
    """Returns the JSON schema of flight.json."""
    fields = {option.field: {**option.kind.schema, "description": option.help,
                             "default": option.default or empty(option)} for option in FIELDS}
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "A flight",
            "type": "object", "properties": {"version": {"const": VERSION}, **fields, **INNER},
            "required": ["version", *fields], "additionalProperties": False}


def wrong(flight):
    """Returns the first error of a description against the schema, or an empty text. Options that
    only the simulator has are not accepted."""
    if not isinstance(flight, dict) or flight.get("version") != VERSION:
        got = flight.get("version") if isinstance(flight, dict) else None
        return f"version: expected {VERSION}, got {'none' if got is None else json.dumps(got)}"
    own = schema()
    own["properties"] = {name: own["properties"][name] for name in own["required"]}
    return "; ".join(problems(flight, own, limits))


def read(path):
    """Returns the description of a flight in a file."""
    try:
        flight = json.loads(Path(path).read_text())
    except OSError as error:
        raise Stop(f"cannot read the flight '{path}': {error.strerror}", 2) from None
    except json.JSONDecodeError as error:
        raise Stop(f"cannot read the flight '{path}': expected JSON, got other text in line "
                   f"{error.lineno}", 2) from None
    except (ValueError, RecursionError):
        raise Stop(f"the flight '{path}': expected JSON in UTF-8, got invalid or too deeply "
                   "nested text", 2) from None
    if found := wrong(flight):
        raise Stop(f"'{path}' is not a flight file: {found}", 2)
    return flight


def complete(values):
    """Takes the missing options from the flight that is repeated, and rejects options that exclude
    each other."""
    if values.again:
        given = values.given | ({"key", "open"} if values.given & {"key", "open"} else {"version"})
        for name, value in read(values.again).items():
            if name not in given:
                setattr(values, name, value)
    take_board(values)
    if values.open and values.key:
        raise Stop(f"{switch('open')} and {option('key', values.key)}: expected at most one of the "
                   f"two, because {switch('open')} flies without a key", 2)
    if values.app == "minimal" and values.cpu != "m3":
        raise Stop("the minimal program is an ARM binary; add " + option("cpu", "m3"), 2)
    other = [name for name in ("loss", "interference", "distance", "trace", "update")
             if getattr(values, name)] + ["app"] * (values.app == "minimal")
    if values.wire and other:
        raise Stop(f"{switch('wire')} flies the mission without modems and radio: leave out "
                   + ", ".join(map(option, other)), 2)
    single = [name for name in ("wire", "update", "pins") if getattr(values, name)]
    if values.vehicles > 1 and (single or values.app == "minimal"):
        raise Stop(f"{option('vehicles', values.vehicles)}: several vehicles can only fly the "
                   "mission; leave out " + ", ".join(map(option, single or ["app"])), 2)
    if values.camera and values.pins:
        raise Stop(f"{switch('camera')} and {option('pins', values.pins)} both drive the inputs of "
                   "cores; give only one of them", 2)
    if values.camera and "camera" not in values.cores:
        values.cores = [*values.cores, "camera"]
    if values.probe and "probe" not in values.cores:
        raise Stop(f"{option('probe', values.probe)} needs a probe core: add "
                   f"{option('cores', 'probe')}", 2)
    build = BuildFolder(values.build, values)
    for at, core in enumerate(values.cores):
        folder = build.core(core)
        if not (folder / "ground.py").is_file():
            raise Stop(f"core '{core}' cannot be called in a mission: {folder}/ground.py not found"
                       + nearest(core, choices.flown()), 2)
        if folder.is_absolute():  # the core is outside ip/
            values.cores[at] = str(folder)
    try:
        Path(values.out).mkdir(parents=True, exist_ok=True)
    except OSError:
        pass
    if not os.access(values.out, os.W_OK):
        raise Stop(f"{option('out', values.out)}: expected a folder that a flight can write to", 2)


def take_board(values):
    """Completes the options of a flight with a board or with faults. Such a flight runs the ARM
    binary, because only the ARM binary configures the pins, and uses the board's kind of modem,
    unless other options are given. Writes the board's wires into OUT/board."""
    if (values.board or values.fault) and "cpu" not in values.given:
        values.cpu = "m3"
    values.described = values.board if values.board.endswith(".toml") else ""
    if not values.board or (Path(values.board) / "board.wires").is_file():
        return
    try:
        board = (model.read if values.board.endswith(".toml") else model.find)(values.board)
        values.board = str(make.write(make.for_build(board), Path(values.out) / "board")[0].parent)
    except (Wrong, OSError) as error:
        raise Stop(f"--board: {reason_of(error)}", 2) from None
    if board.modem and "modem" not in values.given:
        values.modem = board.modem


def kit(folder, described=""):
    """Returns the name or the file of the board for which the simulator and the firmware must be
    built, or an empty text if any board fits. Only a board with multiplexed address and
    data needs a separate build, because its bridge and its firmware differ. `folder`: output of
    `./icesoc board make`. `described`: the board's file, if known."""
    try:
        text = (Path(folder) / "board.wires").read_text() if folder else ""
    except OSError as error:
        raise Stop(f"--board: cannot read {folder}/board.wires: {error.strerror}", 2) from None
    if "\nmuxed 1\n" not in text:
        return ""
    found = re.search(r"^board (.+)$", text, re.M)
    return described or (found[1] if found else "")


def check_chip(values, build):
    """Rejects a core of the tree that is not in the chip. Without this check, the call of the core
    would fail after minutes."""
    listed = build.chip_list() or build.cached("CORES") or "ip/cores.list"
    lines = re.findall(r"^\s*(\w+)", read_list(listed), re.M)
    for core in (Path(folder).name for folder in values.cores):
        if core not in lines:
            raise Stop(f"the chip has no core '{core}': add a line '{core}' to {listed}", 2)


def take_key(values, build):
    """If the flight is neither open nor has a key, uses the demo key. A missing demo key is
    created."""
    if values.open or values.key or values.app != "uav":
        return
    keys.rescue(build.folder.parent)
    values.key = str(keys.folder() / "demo.key")
    if make_key(values.key):
        say(f"made the demo key {values.key} for ground station and vehicle; "
            f"{option('key', 'FILE')} uses your own key, and {switch('open')} flies without a key")


def take_observers_key(values):
    """Sets the key of the second ground station to a demo key, if the vehicles have keys."""
    if values.vehicles > 1 and values.key and not values.observer:
        values.observer = str(keys.folder() / "observer.key")
        make_key(values.observer)


def make_key(path):
    """Creates a key that only its owner may read; returns False if it exists."""
    keys.check_folder(path)
    temporary = f"{path}.{os.getpid()}"
    descriptor = os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    try:
        with open(descriptor, "w") as file:
            file.write(os.urandom(16).hex() + "\n")
        os.link(temporary, path)
        return True
    except FileExistsError:
        return False
    except OSError as error:  # a write to a full disk has no file name
        raise Stop(f"cannot write '{path}': {error.strerror}") from None
    finally:
        os.remove(temporary)


def firmware(values, build):
    name = "minimal" if values.app == "minimal" else "uav_ucos2" if values.ucos2 else "uav"
    return values.firmware or str(build / f"firmware/{name}.elf")


def write(values, build):
    """OUT/flight.json."""
    flight = {"version": VERSION, **{option.field: getattr(values, option.field)
                                     for option in FIELDS}}
    flight["firmware"] = firmware(values, build)
    path = Path(values.out) / "flight.json"
    path.with_suffix(".new").write_text(json.dumps(flight, indent=1) + "\n")
    path.with_suffix(".new").replace(path)


def recorded(folder):
    """Returns the first line of the recording in a folder: the description of the flight, and facts
    about its simulator (testbench/sim/recording.h). Returns an empty object if the line is
    malformed; the simulator then explains the fault."""
    head = next(rows.read(Path(folder) / RECORDING), {})
    return head if isinstance(head.get("flight"), dict) else {}


def last_span(out):
    """Returns the options `from` and `to` that select the end of a recorded flight. `from` is the
    last checkpoint that is at least 10 ms before the end. Returns None if the recording is
    incomplete, for example after the disk was full."""
    last = before = finish = 0.0
    recording = Path(out) / RECORDING
    if not recording.read_bytes().endswith(b"\n"):
        return None
    for row in rows.read(recording):
        finish = row.get("ns", 0) / 1e9 or finish
        if "digest" in row:
            before, last = last, finish
    return [option("from", f"{last if finish - last > 0.01 else before:.3f}"),
            option("to", f"{finish:.3f}")]
