# SPDX-License-Identifier: MIT
"""choices: the names that options accept, as found in the files of the tree, for completion and for
checks before anything is configured or built.

Each function gets the values of a command's options, or None during completion.
"""
import argparse
import functools
import os
import re
from pathlib import Path

from icesoc.util.rooms import ROOMS, RTL

HARDWARE = (*RTL, "synth")
SEARCHED = (*ROOMS, "cmake", "tools")  # folders with tests and targets
MODULE = re.compile(r"^ *(?:module|entity) +(\w+)", re.M | re.I)
CASE = re.compile(r"^ *(?:TYPED_)?TEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\)", re.M)
INSTANCE = re.compile(r"^ *INSTANTIATE_\w+\(\s*(\w+)", re.M)  # of cases with parameters


def files(folders, *endings):
    """Yields the files below folders with these endings."""
    for folder in folders:
        for place, _, names in os.walk(folder):
            yield from (Path(place, name) for name in names if name.endswith(endings))


@functools.cache
def texts(folders, *endings):
    """Returns the texts of the files below folders with these endings."""
    return [path.read_text(errors="replace") for path in files(folders, *endings)]


# function -> text for error messages about the names that it returns, such as "the name of a core"
NOUNS = {}


def expecting(noun):
    """Returns a decorator for a function that returns the possible values of an option. It stores
    what error messages call such a value."""
    def declare(function):
        NOUNS[function] = noun
        return function
    return declare


def noun(function):
    return NOUNS[function]


@expecting("the name of a core")
def cores(values=None):
    """Returns the cores of the tree, and the cores in folders that this or an earlier command
    named."""
    found = {path.parent.name for path in Path("ip").glob("*/core.toml")}
    if values is None:
        values = argparse.Namespace(build="build/main", jobs=1, built=True)
    from icesoc.cli.build_folder import BuildFolder  # the installed icesoc-call does not contain
                                                     # this module
    build = BuildFolder(values.build, values)
    return sorted({*found, *build.known_cores(), *(folder.name for folder in build.other_cores())})


def flown(values=None):
    """Returns the cores that a mission can call."""
    return [name for name in cores() if Path("ip", name, "ground.py").is_file()]


def boards(values=None):
    """Returns the names of the boards that are described in the folder boards/."""
    from icesoc.board import model  # not part of the installed icesoc-call
    return model.names()


@expecting("the name of a design")
def designs(values=None):
    """Returns the names that can be synthesised: designs of synth/designs.json, modules, entities,
    and modules that the build generates."""
    from icesoc.synth.sources import DESIGNS, read_designs  # not part of the installed icesoc-call
    found = read_designs()["designs"] if Path(DESIGNS).is_file() else []
    names = {name for text in texts(HARDWARE, ".v", ".vhd") for name in MODULE.findall(text)}
    names = {name for name in names if not name.endswith(("_rules", "_proof", "_tb"))}
    names |= {path.name.replace(".regs.json", "_regs") for path in files(HARDWARE, ".regs.json")}
    names |= {name for core in cores(values) for name in (core, f"{core}_wrapper")}
    return sorted(names | {each["name"] for each in found})


@expecting("a label of tests, or an expression that matches one")
def labels(values=None):
    """Returns the labels of tests."""
    text = "\n".join(texts(SEARCHED, "CMakeLists.txt", ".cmake"))
    found = re.findall(r'\bLABELS "?([a-z0-9_;]+)', re.sub("#.*", "", text))
    return sorted({label for each in found for label in each.split(";") if label})


@expecting("a folder of tests")
def test_folders(values=None):
    """Returns the folders whose tests can be run, such as hdl/fsmc and ip/fir."""
    folders = {path.parent for path in files(("tests",), "CMakeLists.txt", "_test.cpp", "_test.py")}
    return sorted([*(str(path.relative_to("tests")) for path in folders if path.name != "tests"),
                   *(f"ip/{core}" for core in cores(values))])


def has_tests(text, values):
    """Returns whether a text is a folder of tests or contains one, in one of its spellings."""
    folder = text.strip("/").removeprefix("tests/")
    return Path("tests", folder).is_dir() or folder in ("ip", *test_folders(values))


def has_label(text, values):
    """Returns whether a regular expression matches a label."""
    try:
        return any(re.search(text, label) for label in labels())
    except re.error:
        return False


@expecting("the name of a bench")
def benches(values=None):
    """Returns the benches of the tree."""
    listed = Path("tests/bench/CMakeLists.txt")
    text = listed.read_text() if listed.is_file() else ""
    return re.findall(r"^ *icesoc_bench\((\w+)", text, re.M)


@expecting("a block with seeded bugs, or block/bug")
def seeded(values=None):
    """Returns the names of the blocks and cores with seeded bugs, and each bug as block/name. With
    --draw, returns an empty list, because a block is then an expression for names of proofs; an
    empty list accepts every name."""
    if values and values.draw:
        return []
    from icesoc.mutants.run import read_bugs  # not part of the installed icesoc-call
    names = [bug.name for bug in read_bugs()]
    return sorted({name.partition("/")[0] for name in names}) + names


def blocks(values=None):
    """Returns the folders of tests, as values of the option --block."""
    found = {path.parent.name for folder in ("tests", "ip")
             for path in Path(folder).rglob("CMakeLists.txt")}
    return sorted((found | set(cores())) - {"tests", "ip"})


def cases(values=None, folders=SEARCHED):
    """Returns the cases of the C++ tests in folders as Suite.Case."""
    return sorted({".".join(names) for text in texts(folders, "_test.cpp")
                   for names in CASE.findall(text)})


def may_be_case(text, folders):
    """Returns whether a text may select a case of the C++ tests in folders. A regular expression
    may always do so, and a word if it is a part of a case's name. If the folders contain no cases,
    every word may, because the tests may then be generated."""
    names = [*cases(folders=folders),
             *(name for each in texts(folders, "_test.cpp") for name in INSTANCE.findall(each))]
    return not names or not re.fullmatch(r"[\w.]+", text) or \
        any(re.search(text, name) for name in names)


@expecting("a word of a test name")
def words_of_tests(values=None):
    """Returns the words that occur in names of tests."""
    words = {word for names in cases() for word in names.split(".")}
    text = "\n".join(texts(SEARCHED, "CMakeLists.txt", ".cmake", ".cmake.in", "core.toml"))
    return sorted(words | set(re.findall(r"[A-Za-z]\w{2,}", text)))


def may_name_test(text, values):
    """Returns whether a text may match a test. A regular expression may always match. A plain word
    may match if each part of it occurs in the source of a test. If the build has cores outside the
    tree, every word may match, because their tests may have any name."""
    from icesoc.cli.build_folder import BuildFolder  # the installed icesoc-call does not contain
                                                     # this module
    if not re.fullmatch(r"[A-Za-z]\w*", text) or \
            BuildFolder(values.build, values).other_cores():
        return True
    known = " ".join([*words_of_tests(),
                      *texts(SEARCHED, "_test.cpp", "_test.py", ".sh", ".json")])
    return all(part in known for part in re.findall("[A-Za-z]{3,}", text))
