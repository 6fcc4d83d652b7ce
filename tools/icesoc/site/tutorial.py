# SPDX-License-Identifier: MIT
"""tutorial: follows a page word for word: writes its files, runs its commands, compares the output.

A block of the language `console` has commands (`$ command`), each with its expected output. A line
`...` stands for any number of lines, and `...` inside a line for any text. The comment
`<!-- exit status N -->` in front of a block gives the exit status of its last command; it is 0
otherwise. `<!-- long -->` marks a block that a brief run leaves out. If the line before any other
block names a file, such as "`ip/x/x.v`:", the block is the content of that file.
"""
import dataclasses
import re
from pathlib import Path

from icesoc.util.errors import Stop


@dataclasses.dataclass
class Step:
    """A command of the page with its expected output, or a file with its content."""
    line: int  # line number in the page, starting with 1
    command: str = ""
    expected: list = dataclasses.field(default_factory=list)
    status: int = 0
    file: str = ""
    long: bool = False


def steps(text):
    """Returns the steps of a page in order."""
    found, block, before, opened = [], [], "", None
    for number, line in enumerate(text.splitlines(), 1):
        if opened is None and line.startswith("```"):
            opened, block = (number, line[3:].strip()), []
        elif opened is None:
            before = line or before
        elif line == "```":
            found += _block(*opened, block, before)
            opened, before = None, ""
        else:
            block.append(line)
    return found


def _block(number, language, lines, before):
    named = re.fullmatch(r"`([\w./-]+)`:", before)
    if named:
        return [Step(number, file=named[1], expected=lines)]
    if language != "console":
        return []
    found = []
    for at, line in enumerate(lines, number + 1):
        if line.startswith("$ "):
            found.append(Step(at, command=line[2:]))
        elif found and found[-1].command.endswith("\\") and not found[-1].expected:
            found[-1].command += "\n" + line
        elif found:
            found[-1].expected.append(line)
        else:
            raise Stop(f"check tutorial: line {at}: expected '$ command' at the start of a block, "
                       f"got '{line}'")
    for step in found:
        step.long = before == "<!-- long -->"
    status = re.fullmatch(r"<!-- exit status (\d+) -->", before)
    if status and found:
        found[-1].status = int(status[1])
    return found


def compare(expected, printed):
    """Compares the output with the expected lines. Returns the first expected line that is missing
    or in the wrong place, or a text about the first additional line. Returns None if the output is
    as expected."""
    at, skipping = 0, False
    for line in expected:
        if line == "...":
            skipping = True
            continue
        pattern = re.compile(".*".join(map(re.escape, line.split("..."))))
        places = range(at, len(printed) if skipping else min(at + 1, len(printed)))
        at = next((place + 1 for place in places if pattern.fullmatch(printed[place])), None)
        skipping = False
        if at is None:
            return line
    if at < len(printed) and not skipping:
        return f"no further line, got '{printed[at]}'"
    return None


def follow(page, folder, execute, begin="", brief=False):
    """Follows a page in a folder. `execute(command)` returns exit status and output. Skips the
    steps up to and including the command `begin` and, if `brief` is true, the blocks that are
    marked as long."""
    todo = steps(Path(page).read_text())
    if begin:
        at = next((n for n, step in enumerate(todo) if step.command == begin), None)
        if at is None:
            raise Stop(f"check tutorial: {page}: expected the command '{begin}'")
        todo = todo[at + 1:]
    for step in todo:
        if step.long and brief:
            continue
        if step.file:
            Path(folder, step.file).write_text("\n".join(step.expected) + "\n")
            continue
        status, output = execute(step.command)
        lines = [line.rstrip() for line in output.splitlines()]
        place = f"{page}:{step.line}: {step.command}"
        if status != step.status:
            raise Stop(f"check tutorial: {place}: expected exit status {step.status}, got {status}:"
                       "\n" + "\n".join(lines[-40:]))
        missing = compare(step.expected, lines)
        if missing is not None:
            raise Stop(f"check tutorial: {place}: expected {missing}\nin the output:\n" +
                       "\n".join(lines[-60:]))
