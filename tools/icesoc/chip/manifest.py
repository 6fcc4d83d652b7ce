# SPDX-License-Identifier: MIT
"""manifest: reads a core's core.toml, the only description of the core (docs/hw-mapping.md).

For CMake, `python -m icesoc.chip.manifest ip/fir/core.toml ip/probe/core.toml` prints CMake code
that defines a global property for each manifest. The property's value is again CMake code, which
sets variables to the facts. Python programs use read() and block_of().
"""
import json
import re
import sys
import tomllib
from dataclasses import dataclass
from pathlib import Path

from icesoc.regs.model import Block, Wrong, check
from icesoc.util import schema
from icesoc.util.reserved import REFUSAL, RESERVED

SCHEMA = json.loads(Path(__file__).with_name("core.schema.json").read_text())
HEADERS = ".vh", ".svh", ".inc", ".h"
# Keys of the manifest that are added to the block's register description. The chip, the firmware's
# table and the exchange formats use them.
DESCRIBED = "memory_port", "memory_bytes", "probe", "servant"
FILE_LISTS = "verilog", "vhdl", "includes", "tests"


@dataclass
class Manifest:
    """The facts of one core. A core has either a register description or a Slice interface."""

    path: Path
    name: str
    facts: dict

    @property
    def folder(self):
        return self.path.parent

    def file(self, name):
        """Returns the absolute path of a file; `name` is relative to the manifest's folder."""
        return str(self.folder / name)

    def pins(self):
        """Returns the pins in the form of a register description."""
        return [{key: pin[key] for key in ("name", "width", "internal") if key in pin}
                for pin in self.facts.get("pins", [])]

    def places(self):
        """Returns the default locations of the pins: {name: pads}."""
        return {p["name"]: p["places"] for p in self.facts.get("pins", []) if "places" in p}


def parse(path):
    """Returns the keys and values of a core.toml, unchecked."""
    try:
        return tomllib.loads(Path(path).read_bytes().decode("utf-8-sig"))
    except UnicodeDecodeError:
        raise Wrong(f"{path}: expected text in UTF-8") from None
    except tomllib.TOMLDecodeError as e:
        raise Wrong(f"{path}: {e}") from None
    except OSError as e:
        raise Wrong(f"{path}: {e.strerror}") from None
    except RecursionError:
        raise Wrong(f"{path}: brackets are nested too deeply") from None
    except ValueError:  # Python converts at most 4300 digits
        raise Wrong(f"{path}: a number has too many digits") from None


def read(path):
    """Returns the Manifest of a file core.toml; raises Wrong with the reason and what to do."""
    path = Path(path).absolute()
    facts = parse(path)
    if found := schema.problems(facts, SCHEMA):
        raise Wrong("\n".join(f"{path}: {text}" for text in found))
    manifest = Manifest(path, facts.get("name", path.parent.name), facts)

    def holds(condition, text):
        check(condition, f"{path}: {text}")

    holds(re.fullmatch(SCHEMA["properties"]["name"]["pattern"], manifest.name),
          f"name: expected {SCHEMA['properties']['name']['description']}, got '{manifest.name}' "
          "(name of the folder)")
    holds(("interface" in facts) != ("registers" in facts),
          "expected one of 'interface' (a Slice file) and 'registers' (a file *.regs.json)")
    holds(manifest.name not in RESERVED, f"name: '{manifest.name}' {REFUSAL}")
    holds(facts.get("verilog") or facts.get("vhdl"),
          "expected 'verilog' or 'vhdl', a list of files")
    for key in FILE_LISTS:
        twice = [file for file in facts.get(key, []) if facts[key].count(file) > 1]
        holds(not twice, f"{key}: {twice and twice[0]} is listed twice")
    holds("servant" not in facts or "registers" in facts,
          "servant: expected no servant with 'interface', which generates it")
    for key in ("pins", "memory_bytes", "memory_port", "window"):
        holds(key not in facts or "registers" in facts,
              f"{key}: expected with 'registers' only; with 'interface' its metadata gives it")
    holds("clock_hz" not in facts or not facts.get("idle"),
          "clock_hz: expected without 'idle': a clock of the core has no gate")
    holds(not (facts.get("clk_hz") and "vhdl" in facts),
          "clk_hz: expected for a module in Verilog only: GHDL fixes an entity's generics before "
          "the clock is known; pass the number by an operation instead")
    for pin in facts.get("pins", []):
        holds(len(pin.get("places", [])) in (0, pin.get("width", 1)),
              f"pins: {pin['name']}: expected {pin.get('width', 1)} places, got "
              f"{len(pin.get('places', []))}")
    for key in ("interface", "registers", "constraints"):
        holds(key not in facts or Path(manifest.file(facts[key])).is_file(),
              f"{key}: no file {facts.get(key)}")
    for key, files in [*((k, facts.get(k, [])) for k in ("verilog", "vhdl", "tests")),
                       ("servant.files", facts.get("servant", {}).get("files", [])),
                       *((f"entities.{n}.files", e["files"])
                         for n, e in facts.get("entities", {}).items()),
                       *((f"entities.{n}.libraries",
                          [word.split("=", 1)[1] for word in e.get("libraries", [])])
                         for n, e in facts.get("entities", {}).items())]:
        for file in files:
            holds("@" in file or Path(manifest.file(file)).is_file(), f"{key}: no file {file}")
    return manifest


def block_of(manifest, registers):
    """Returns the Block of a register description, with the manifest's facts."""
    described = dict(Block.read(registers).description)
    added = {key: manifest.facts[key] for key in DESCRIBED if key in manifest.facts}
    if "memory_bytes" in added:
        added["memory_port"] = True
    if "servant" in added:
        added["servant"] = {k: v for k, v in added["servant"].items() if k != "files"}
    if manifest.pins():
        added["pins"] = manifest.pins()
    for key in added:
        check(key not in described, f"{registers}: {key}: expected in {manifest.path.name} only")
    return Block(described | added)


def quoted(words):
    """Returns words as quoted arguments for CMake. In each word, @NAME@ becomes ${NAME}, a
    reference to a variable of CMake."""
    text = (str(word).replace("\\", "\\\\").replace('"', '\\"').replace("$", "\\$")
            .replace(";", "\\;") for word in words)
    return " ".join('"' + re.sub("@([A-Z_]+)@", r"${\1}", word) + '"' for word in text)


def placed(value, folder):
    """Returns a value in which @FOLDER@ is replaced by the folder of the manifest."""
    if isinstance(value, dict):
        return {key: placed(each, folder) for key, each in value.items()}
    if isinstance(value, list):
        return [placed(each, folder) for each in value]
    return value.replace("@FOLDER@", str(folder)) if isinstance(value, str) else value


def cmake(manifest):
    """Returns CMake code that sets the variables for icesoc_core (cmake/cores.cmake)."""
    facts = placed(manifest.facts, manifest.folder)
    s = f"set(name {quoted([manifest.name])})\n"

    def add(name, words):
        nonlocal s
        s += f"set(A_{name} {quoted(words)})\n"

    def files(names):
        return [n if n.startswith(("/", "@")) else manifest.file(n) for n in names]

    def in_libraries(words):
        return [f"{library}={files([file])[0]}"
                for library, file in (word.split("=", 1) for word in words)]

    for key in FILE_LISTS:
        add(key.upper(), files(facts.get(key, [])))
    add("ICE", files([facts["interface"]] if "interface" in facts else []))
    add("REGS", files([facts["registers"]] if "registers" in facts else []))
    add("SERVANT", files(facts.get("servant", {}).get("files", [])))
    add("SLICE", [manifest.file(w) if w.endswith(".ice") else w for w in facts.get("slice", [])])
    add("FLAGS", facts.get("flags", []))
    add("CLOCK", [facts["clock_hz"]] if "clock_hz" in facts else [])
    for key in ("clk_hz", "idle", "window"):
        add(key.upper(), ["TRUE"] if facts.get(key) else [])
    add("ENTITIES", facts.get("entities", {}))
    for name, entity in facts.get("entities", {}).items():
        add(f"ENTITY_{name}", ["SOURCES", *files(entity["files"]),
                               *(["FOREIGN"] if entity.get("foreign") else []),
                               *(["LIBRARY", entity["library"]] if "library" in entity else []),
                               *(["LIBRARIES", *in_libraries(entity["libraries"])]
                                 if entity.get("libraries") else []),
                               *(["GENERICS", *entity["generics"]]
                                 if entity.get("generics") else [])])
    return s


def main():
    try:
        for path in sys.argv[1:]:
            sys.stdout.write(f"set_property(GLOBAL PROPERTY {quoted(['ICESOC_FACTS_' + path])} "
                             f"[==[\n{cmake(read(path))}]==])\n")
    except Wrong as e:
        sys.exit(str(e))


if __name__ == "__main__":
    main()
