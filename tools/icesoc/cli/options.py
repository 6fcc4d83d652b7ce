# SPDX-License-Identifier: MIT
"""options: defines an option, and the kinds of values that options take.

An option is declared once; its help, its check, its make variable and its field in flight.json are
derived from the declaration.
"""
import dataclasses
import os
import re
import typing
from pathlib import Path

from icesoc.cli import choices
from icesoc.util.errors import Stop, nearest

MOST_LISTED = 20  # largest number of names in a message


@dataclasses.dataclass
class Kind:
    """A kind of value. `read` converts a text to a value, and raises ValueError if the text
    is invalid."""
    read: typing.Callable
    expected: str  # end of the message "LOSS: expected ...": the valid values
    schema: dict = None  # JSON schema of the value in flight.json
    metavar: str = "VALUE"
    words: tuple = ()  # all possible values, if there are only a few
    # function of the caller's folder and a value: returns the value with its paths in that folder
    locate: typing.Callable = None


@dataclasses.dataclass
class Option:
    name: str
    kind: Kind
    help: str
    default: object = None
    positional: bool = False
    variable: str = ""  # name as a make variable
    # False: the option is only for tests of this project, and the help does not list it
    listed: bool = True
    completer: typing.Callable = None  # completer for argcomplete
    # function in choices.py that returns the valid names, given the values of all options
    choices: typing.Callable = None
    # function that accepts further values: it returns whether a value that is not among the choices
    # is valid
    has_name: typing.Callable = None
    is_checked: bool = True  # False: the choices are for completion only

    def __post_init__(self):
        self.variable = self.variable or self.name.upper().replace("-", "_")
        self.field = self.name.replace("-", "_")
        self.many = self.kind in (WORDS, FILES, ARGUMENTS)

    def value(self, text, called):
        """Converts a text, or a list of texts from argparse, to the value of this option. `called`
        is the name of the option in messages."""
        if self.kind in (ARGUMENTS, FILES):
            return [text] if isinstance(text, str) else text
        if isinstance(text, list):
            text = " ".join(text)
        try:
            return self.kind.read(text)
        except ValueError as error:
            raise Stop(str(error) or f"{called}: expected {self.kind.expected}, got '{text}'",
                       2) from None

    def check_names(self, value, values):
        """Rejects a name that is not among the choices, before anything is built. If `choices`
        returns no names, every name is accepted."""
        if not self.choices or not self.is_checked or not value:
            return
        names = None
        for word in value if isinstance(value, list) else [value]:
            if self.has_name and self.has_name(word, values):
                continue
            names = names or list(self.choices(values))
            if names and word not in names:
                called = self.name.upper() if self.positional else f"--{self.name}"
                called = self.variable if values.given_by_make else called
                similar = nearest(word, names)
                known = f"{' Known' if similar else '; known'}: {', '.join(names)}"
                known = known if len(names) <= MOST_LISTED else ""
                raise Stop(f"{called}: expected {choices.noun(self.choices)}, got '{word}'"
                           f"{similar}{known}", 2)

    def completions(self, prefix, **_):
        """Returns the words that may follow, for argcomplete."""
        names = self.kind.words or (self.choices(None) if self.choices else ())
        return [name for name in names if name.startswith(prefix)]

    def none(self):
        """Returns the value for an option that is not given."""
        empty = False if self.kind is SWITCH else [] if self.many else None
        return empty if self.default is None else self.default

    def explain(self):
        """Returns the help text: meaning, possible values, default."""
        shown = " ".join(self.default) if isinstance(self.default, list) else self.default
        is_plain = self.choices or self.kind.locate or self.kind in (TEXT, WORDS, ARGUMENTS,
                                                                     SWITCH)
        parts = [] if is_plain else [self.kind.expected]
        parts += [f"default {shown}"] if shown is not None and shown != "" else []
        return (self.help + (f" ({'; '.join(parts)})" if parts else "")).replace("%", "%%")


def matching(pattern, expected, convert=str, schema=None, metavar="VALUE"):
    def read(text):
        if not re.fullmatch(pattern, text, re.A):
            raise ValueError
        return convert(text)

    return Kind(read, expected, schema or {"type": "string"}, metavar)


def number(low, high=None, unit="", convert=int):
    """Returns the kind of a number from `low` to `high`; without `high` it has no upper limit."""
    kind = "number" if convert is float else "whole number"
    between = f"a {kind}, at least {low}" if high is None else f"{low} to {high}"
    pattern = r"\d{1,18}" if convert is int else r"\d+(\.\d*)?|\.\d+"

    def read(text):
        value = convert(text) if re.fullmatch(pattern, text, re.A) else None
        if value is None or value < low or (high is not None and value > high):
            raise ValueError
        return value

    schema = {"type": "integer" if convert is int else "number", "minimum": low}
    return Kind(read, f"{between} {unit}".rstrip(),
                schema if high is None else {**schema, "maximum": high}, "N")


def one_of(*words):
    kind = matching("|".join(map(re.escape, words)), " or ".join(words), schema={
        "enum": list(words)}, metavar="|".join(words))
    kind.words = words
    return kind


def _switch(text):
    if text not in ("1", "0", ""):
        raise ValueError
    return text == "1"


def _file(text):
    """Checks that a file is readable, before anything is built."""
    try:
        with open(text, "rb") as file:
            file.read(1)
    except OSError as error:
        raise ValueError(f"cannot read '{text}': {error.strerror}") from None
    return text


def _folder(text):
    """Checks that a folder exists, before anything is built."""
    if not os.path.isdir(text):
        raise ValueError
    return text


def _key(text):
    if not os.path.isfile(text):
        raise ValueError(f"key file '{text}' does not exist; create one with ./icesoc key '{text}'")
    return _file(text)


def _flight(text):
    if not os.path.isfile(os.path.join(text, "flight.jsonl")):
        raise ValueError(
            f"'{text}' contains no recorded flight; record one with ./icesoc run --out '{text}'")
    return text


def _frame(text):
    wide, high = map(int, text.split("x")) if re.fullmatch(r"[0-9]{1,5}x[0-9]{1,5}",
                                                                text) else (0, 0)
    if not (8 <= wide <= 1024 and 8 <= high <= 4096 and wide % 8 == 0):
        raise ValueError
    return text


def _address(text):
    """Returns a modem's address in the form of key files, such as 0x0001."""
    if not re.fullmatch("0[xX][0-9a-fA-F]{1,4}|0|[1-9][0-9]{0,4}", text):
        raise ValueError
    value = int(text, 0)
    if value > 0xFFFF:
        raise ValueError
    return f"0x{value:04X}"


def _files(place, text):
    """Returns the paths of a list of file names. A name may contain spaces if the file exists."""
    return [os.path.join(place, name) for word in ([text] if isinstance(text, str) else text)
            for name in ([word] if os.path.exists(os.path.join(place, word)) else word.split())]


def _folders(place, text):
    """Returns the paths of folders that are separated by semicolons."""
    return text if text == "none" else ";".join(os.path.join(place, folder)
                                                for folder in text.split(";"))


def _core_folders(text):
    """Checks folders of cores, which are separated by semicolons."""
    for folder in text.split(";") if text != "none" else ():
        if folder and not Path(folder).is_dir():
            raise ValueError
    return text


def _board(place, text):
    """Returns the name of a board, or the path of its file or folder."""
    return os.path.join(place, text) if "/" in text or text.endswith(".toml") else text


TEXT = Kind(str, "text", {"type": "string"})
WORDS = Kind(str.split, "words separated by spaces",
             {"type": "array", "items": {"type": "string"}}, "WORD")
FILES = Kind(list, "file names separated by spaces", metavar="FILE", locate=_files)
ARGUMENTS = Kind(str, "words, each as it is", metavar="WORD")
SWITCH = Kind(_switch, "1 or 0", {"type": "boolean"})
BOARD = Kind(str, "a board", {"type": "string"}, locate=_board)
FOLDERS = Kind(_core_folders, "existing folders of cores", {"type": "string"}, "FOLDER",
               locate=_folders)


def path_kind(read, expected, metavar):
    return Kind(read, expected, {"type": "string"}, metavar, locate=os.path.join)


FILE = path_kind(_file, "a readable file", "FILE")
FOLDER = path_kind(str, "a folder", "FOLDER")
INPUT_FOLDER = path_kind(_folder, "an existing folder", "FOLDER")
PATH = path_kind(str, "a file name", "FILE")
KEY_FILE = path_kind(_key, "a readable file", "FILE")
FLIGHT = path_kind(_flight, "the folder of a recorded flight", "FOLDER")
FRAME = Kind(_frame, "WIDTHxHEIGHT, 8x8 to 1024x4096, WIDTH a multiple of 8", {"type": "string"},
             "WxH")
ADDRESS = Kind(_address, "0 to 65535, or 0x0000 to 0xFFFF", {"type": "string"}, "N")
SHARE = number(0, 1, convert=float)
COUNT = number(1)
SECONDS = number(0, unit="s", convert=float)
MINUTES = number(0.001, unit="minutes", convert=float)

BUILD = Option("build", FOLDER, "build folder", "build/main")
JOBS = Option("jobs", COUNT, "number of parallel build processes", len(os.sched_getaffinity(0)))
TESTS = Option("tests", COUNT,
               "number of tests run in parallel (default: CPUs + 4, since some tests spend time "
               "waiting)", None)
SEED = Option("seed", number(0), "seed of all random numbers", 1)
FAMILY = Option("family", one_of("xc6s", "ecp5"), "FPGA family of netlists", "xc6s")
NAME = Option("name", TEXT, "whole word in test names, or a regular expression")
TEST_NAME = dataclasses.replace(NAME, choices=choices.words_of_tests,
                                has_name=choices.may_name_test)
LABEL = Option("label", TEXT,
               "label of the tests: rtl, vhdl, formal, lint, firmware, slice, interop, e2e, ...",
               choices=choices.labels, has_name=choices.has_label)
BLOCK = Option("block", TEXT, "block to test, such as bus or modem", choices=choices.blocks,
               is_checked=False)
UCOS2 = Option("ucos2", INPUT_FOLDER,
               "folder of uC/OS-II sources; the firmware is then also built with this kernel "
               "(docs/firmware.md)")
FRESH = Option("fresh", SWITCH,
               "ignore cached results of proofs, lints and synthesis, and compute them again")
CORE_FOLDERS = Option(
    "core-folders", FOLDERS,
    "folders of cores outside ip/, or folders with a cores.list, separated by semicolons; later "
    "commands also use them, until --core-folders none")
BUILT = Option("built", SWITCH, "use the existing build, without set-up and build", listed=False)
