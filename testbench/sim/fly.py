#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""icesoc-fly: flies the mission in the simulator. A ground station with unmodified ZeroC Ice calls
a simulated vehicle over simulated modems.

This is the installed form of `./icesoc run`, without the page of the flight. It writes pictures, a
report, and flight.json, which describes the flight, to the output folder.
"""
import argparse
import json
import os
import secrets
import sys
from pathlib import Path

PREFIX = Path(__file__).resolve().parents[1]
SCHEMA = PREFIX / "share/icesoc/flight.schema.json"
CORES = PREFIX / "share/icesoc/ip"
REFERENCE = PREFIX / "libexec/icesoc/vision-reference"
# Fields of the flight description that this program does not offer, because only programs of the
# source tree use them.
OTHER = {"app", "port", "live", "update", "clk_hz", "probe"}
# Help texts that differ from the schema's descriptions, which are written for the source tree with
# its boards.
TEXTS = {"board": "folder made by ./icesoc board make, to fly with its wires; the vehicle runs the "
                  "ARM binary"}
CONFIG = Path(os.environ.get("XDG_CONFIG_HOME") or Path.home() / ".config") / "icesoc"


def fields():
    """Returns the version of the flight description, and its fields that have a default."""
    known = json.loads(SCHEMA.read_text())["properties"]
    return known["version"]["const"], {name: field for name, field in known.items()
                                       if "default" in field}


def arguments(known):
    parser = argparse.ArgumentParser(
        prog="icesoc-fly", allow_abbrev=False,
        description=__doc__.split("\n\n")[0].partition(": ")[2])
    kinds = {"integer": int, "number": float}
    for name, field in known.items():
        if name in OTHER:
            continue
        kind, default = field.get("type", "string"), field["default"]
        text = TEXTS.get(name, field["description"]).replace("%", "%%")
        if name == "out":
            default = "icesoc-flight"
        if default and "default" not in text:
            text += f" (default: {default})"
        more = {"boolean": {"action": "store_true"}, "array": {"nargs": "*"}}.get(
            kind, {"type": kinds.get(kind, str), "choices": field.get("enum")})
        parser.add_argument("--" + name.replace("_", "-"), default=default, help=text, **more)
    return vars(parser.parse_args())


def demo_key(name):
    """Returns the path of this user's key file; creates the file at first use."""
    path, temporary = CONFIG / name, CONFIG / f"{name}.{os.getpid()}"
    try:
        CONFIG.mkdir(parents=True, exist_ok=True)
        try:
            with open(os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w") as file:
                file.write(secrets.token_hex(16) + "\n")
            os.link(temporary, path)
        finally:
            temporary.unlink(missing_ok=True)
        print(f"icesoc-fly: created a demo key, {path}; --key FILE selects another key, --open "
              "flies without a key")
    except FileExistsError:
        pass
    except OSError as error:
        sys.exit(f"icesoc-fly: cannot write {error.filename or path}: {error.strerror}; --key "
                 "selects an existing key, --open flies without a key")
    return str(path)


def main():
    version, known = fields()
    flight = {name: field["default"] for name, field in known.items()} | arguments(known)
    if flight["open"] and flight["key"]:
        sys.exit("icesoc-fly: --open and --key exclude each other: --open flies without a key")
    if flight["image"] == known["image"]["default"] and not os.path.exists(flight["image"]):
        sys.exit(f"icesoc-fly: {flight['image']}: No such file or directory: install "
                 "xplanet-images, or select a picture with --image")
    known_cores = sorted(path.parent.name for path in CORES.glob("*/ground.py"))
    for core in flight["cores"]:
        if core not in known_cores:
            sys.exit(f"icesoc-fly: --cores: expected names of {', '.join(known_cores)}, got "
                     f"'{core}'")
    if not flight["open"]:
        flight["key"] = flight["key"] or demo_key("demo.key")
        if flight["vehicles"] > 1:
            flight["observer"] = flight["observer"] or demo_key("observer.key")
    if flight["camera"] and "camera" not in flight["cores"]:
        flight["cores"].append("camera")
    if not flight["firmware"]:
        del flight["firmware"]  # without this field, the simulator uses the installed firmware
    try:
        out = Path(flight["out"])
        out.mkdir(parents=True, exist_ok=True)
        text = json.dumps({"version": version, **flight}, indent=1)
        (out / "flight.json").write_text(text + "\n")
    except OSError as error:
        sys.exit(f"icesoc-fly: cannot write {error.filename or out}: {error.strerror}")
    simulator = str(PREFIX / "bin/icesoc-sim")
    second = ["--observer-device", "{device2}"] if flight["vehicles"] > 1 else []
    os.execv(simulator, [
        simulator, "--flight", str(out / "flight.json"), "--", str(PREFIX / "bin/icesoc-mission"),
        "{out}/flight.json", "--device", "{device}", "--frame", "{frame}", "--status", "{status}",
        "--reference", str(REFERENCE), *second])


if __name__ == "__main__":
    main()
