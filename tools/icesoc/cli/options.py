# SPDX-License-Identifier: MIT
"""options: defines an option, and the kinds of values that options take.

An option is declared once. Its help, its check, its variable of make and its field of flight.json
come from this declaration.
"""
import dataclasses
import os
import re
import typing

from icesoc.util.errors import Stop


@dataclasses.dataclass
class Kind:
    """A kind of value. `read` makes it of a text, and raises ValueError for an invalid one."""
    read: typing.Callable
    expected: str  # completes "LOSS is ..."
    schema: dict = None  # of its value in flight.json
    metavar: str = "VALUE"


@dataclasses.dataclass
class Option:
    name: str
    kind: Kind
    help: str
    default: object = None
    positional: bool = False
    variable: str = ""  # of make and of the environment
    listed: bool = True  # False: for the project's own tests, in no list

    def __post_init__(self):
        self.variable = self.variable or self.name.upper().replace("-", "_")
        self.field = self.name.replace("-", "_")
        self.many = self.kind is WORDS or self.kind is FILES

    def value(self, text, called):
        """The value of a text, or of the list of texts that argparse gives; `called`: its name in a
        message."""
        if isinstance(text, list):
            text = " ".join(text)
        try:
            return self.kind.read(text)
        except ValueError as error:
            raise Stop(str(error) or f"{called} is {self.kind.expected}, not '{text}'", 2) from None

    def none(self):
        """The value if none is given."""
        empty = False if self.kind is SWITCH else [] if self.many else None
        return empty if self.default is None else self.default

    def explain(self):
        """The help's sentence: its meaning, its values, its default."""
        shown = " ".join(self.default) if isinstance(self.default, list) else self.default
        parts = [] if self.kind in (TEXT, WORDS, FILES, SWITCH, FILE, KEY_FILE, FOLDER, PATH,
                                    FLIGHT) else [self.kind.expected]
        parts += [f"default {shown}"] if shown is not None and shown != "" else []
        return (self.help + (f" ({'; '.join(parts)})" if parts
                             else "") + f" [{self.variable}]").replace("%", "%%")


def matching(pattern, expected, convert=str, schema=None, metavar="VALUE"):
    def read(text):
        if not re.fullmatch(pattern, text):
            raise ValueError
        return convert(text)

    return Kind(read, expected, schema or {"type": "string"}, metavar)


def number(low, high=None, unit="", convert=int):
    """A number from `low` on, and up to `high` if that is given."""
    kind = "number" if convert is float else "whole number"
    between = f"a {kind} from {low} on" if high is None else f"{low}..{high}"
    pattern = r"\d{1,18}" if convert is int else r"\d+(\.\d*)?|\.\d+"

    def read(text):
        value = convert(text) if re.fullmatch(pattern, text) else None
        if value is None or value < low or (high is not None and value > high):
            raise ValueError
        return value

    schema = {"type": "integer" if convert is int else "number", "minimum": low}
    return Kind(read, f"{between} {unit}".rstrip(),
                schema if high is None else {**schema, "maximum": high}, "N")


def one_of(*words):
    return matching("|".join(map(re.escape, words)), " or ".join(words), schema={
        "enum": list(words)}, metavar="|".join(words))


def _switch(text):
    if text not in ("1", "0", ""):
        raise ValueError
    return text == "1"


def _file(text):
    """A file that can be read. Values are checked before anything is built."""
    try:
        with open(text, "rb") as file:
            file.read(1)
    except OSError as error:
        raise ValueError(f"cannot read '{text}': {error.strerror}") from None
    return text


def _key(text):
    if not os.path.isfile(text):
        raise ValueError(f"there is no key '{text}': ./icesoc key '{text}' makes one")
    return _file(text)


def _flight(text):
    if not os.path.isfile(os.path.join(text, "flight.jsonl")):
        raise ValueError(
            f"no flight was recorded in '{text}': ./icesoc run --out '{text}' records one")
    return text


def _frame(text):
    wide, high = map(int, text.split("x")) if re.fullmatch(r"\d{1,5}x\d{1,5}", text) else (0, 0)
    if not (8 <= wide <= 1024 and 8 <= high <= 4096 and wide % 8 == 0):
        raise ValueError
    return text


TEXT = Kind(str, "a text", {"type": "string"})
WORDS = Kind(str.split, "words with spaces between them",
             {"type": "array", "items": {"type": "string"}}, "WORD")
FILES = Kind(str.split, "names of files with spaces between them", metavar="FILE")
SWITCH = Kind(_switch, "1 or 0", {"type": "boolean"})
FILE = Kind(_file, "a file that can be read", {"type": "string"}, "FILE")
FOLDER = Kind(str, "a folder", {"type": "string"}, "FOLDER")
PATH = Kind(str, "a name of a file", {"type": "string"}, "FILE")
KEY_FILE = Kind(_key, "a file that can be read", {"type": "string"}, "FILE")
FLIGHT = Kind(_flight, "the folder of a recorded flight", {"type": "string"}, "FOLDER")
FRAME = Kind(_frame, "WIDTHxHEIGHT, 8x8 to 1024x4096, WIDTH a multiple of 8", {"type": "string"},
             "WxH")
SHARE = number(0, 1, convert=float)
COUNT = number(1)
SECONDS = number(0, unit="s", convert=float)
MINUTES = number(0.001, unit="minutes", convert=float)
PATHS = (FILE, KEY_FILE, FOLDER, PATH, FLIGHT)  # relative to the caller's folder

BUILD = Option("build", FOLDER, "build folder", "build/main")
JOBS = Option("jobs", COUNT, "processes of a build at a time", len(os.sched_getaffinity(0)))
TESTS = Option("tests", COUNT,
               "tests at a time: some wait for a clock, so two more than processors", None)
SEED = Option("seed", number(0), "seed of everything that is drawn", 1)
FAMILY = Option("family", TEXT, "the chip that netlists are for: xc6s (Spartan-6) or ecp5", "xc6s")
NAME = Option("name", TEXT, "whole word of test names, or regular expression on them")
LABEL = Option("label", TEXT,
               "tests of this label: rtl, vhdl, formal, lint, firmware, slice, interop, e2e, ...")
BLOCK = Option("block", TEXT, "what belongs to this block, such as bus or modem")
UCOS2 = Option("ucos2", FOLDER,
               "folder of the real uC/OS-II: the firmware is built with it, too (docs/firmware.md)")
FRESH = Option("fresh", SWITCH,
               "computes proofs, lints and synthesis of unchanged files again, too")
CORE_FOLDERS = Option(
    "core-folders", TEXT,
    "folders of cores outside of ip/, with ; between them, kept from then on; none: none")
BUILT = Option("built", SWITCH, "takes what is built as it is: no set-up, no build", listed=False)
