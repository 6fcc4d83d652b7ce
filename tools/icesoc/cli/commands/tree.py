# SPDX-License-Identifier: MIT
"""tree: commands for set-up, clean-up, versions, and the list of commands."""
import os
import re
import shlex
import shutil
import time
from pathlib import Path

from icesoc import TREE
from icesoc.cli import command as doors, completion
from icesoc.cli import flight, keys
from icesoc.cli.command import COMMANDS, command
from icesoc.cli.options import PATH, SWITCH, TEXT, Option
from icesoc.regs.model import Block
from icesoc.release import version as product
from icesoc.util.console import say
from icesoc.util.errors import SKIPPED
from icesoc.util.files import write
from icesoc.util.lock import lock
from icesoc.util.process import ICESOC, run
from icesoc.util.table import Table


@command("setup", [
    Option("tests", SWITCH, "also install packages for tests, reports and debuggers",
           variable="WITH_TESTS"),
    Option("check", SWITCH, "only list missing packages"),
    Option("developer", SWITCH,
           "install git hooks that limit commit subjects to 72 characters")],
         make="setup", brief="setup --check", examples=[
             "setup", "setup --tests", "setup --developer"])
def setup(values):
    """install missing Debian packages

    cmake/setup.sh lists the packages. Installing needs root or sudo, and a network. With
    --check, nothing is installed; exit status 1 means that packages are missing.
    """
    if values.developer:
        run(["git", "config", "core.hooksPath", ".ci/hooks"])
        say("git now runs .ci/hooks")
    return run(
        ["cmake/setup.sh", *(f"--{word}" for word in ("tests", "check") if getattr(values, word))],
        check=False)


doors.ALIASES["setup-tests"] = ("setup", "WITH_TESTS")


@command("clean", [Option("list", SWITCH, "only list what would be removed")], make="clean",
         brief="clean --list",
         examples=[
             "clean",
             "clean --list",
             "clean && ./icesoc build all"])
def clean(values):
    """remove all build output; keys are kept

    Removes the folder build/. Keys that earlier versions stored there are first moved to
    ~/.config/icesoc.
    """
    if not values.list:
        keys.rescue("build")
    for path in sorted(Path("build").glob("*")):
        if values.list:
            say(f"would be removed: {path}")
        else:
            shutil.rmtree(path) if path.is_dir() and not path.is_symlink() else path.unlink()
            say(f"removed: {path}")
    if Path("build").is_dir() and not Path("build").is_symlink() and not values.list:
        Path("build").rmdir()


@command("commands", [
    Option("brief", SWITCH,
           "run a quick example of every command, and write the results to build/commands.md"),
    Option("only", TEXT, "only commands with this text in their name", ""),
    Option("man", PATH, "write the manual page to this file, such as icesoc.1", ""),
    Option("completion", SWITCH, "print code for bash or zsh that completes "
                                 "./icesoc and make"),
    Option("schema", PATH, "write the JSON schema of a flight to this file "
                           "(tools/icesoc/cli/flight.schema.json)", "")],
         make="commands", brief="commands", examples=[
             "commands", "commands --brief --only core", "commands --completion",
             "commands --man icesoc.1 && man ./icesoc.1"])
def commands(values):
    """list all commands, each with a quick example; or run the examples

    A quick example is a command line that runs all steps of a command in seconds or a few minutes.
    CI runs all quick examples.
    """
    if values.completion:
        return say(completion.code())
    if values.man:
        write(values.man, manual())
    if values.schema:
        write(values.schema, flight.schema_text())
    if values.only and values.brief:
        return run_all(values.only)
    if values.brief:
        with lock("build/commands.lock", refuse="all commands run in this folder already"):
            shutil.rmtree("build/brief", ignore_errors=True)
            return run_all("")
    if not values.man and not values.schema:
        for name, each in COMMANDS.items():
            say(f"{name:<18} {'make ' + each.make if each.make else '':<18} "
                + "; ".join(each.brief))


def run_all(only):
    """Runs all quick examples, even after a failure, and writes a table of the results."""
    table, folder = Table("build/commands"), Path("build/brief")
    for name, each in COMMANDS.items():
        if only not in name:
            continue
        own, begin, status = folder / name.replace(" ", "-"), time.monotonic(), 0
        shutil.rmtree(own, ignore_errors=True)  # output of the last run
        own.mkdir(parents=True)
        log = own.with_suffix(".log")
        with open(log, "w") as file, open(os.devnull) as nothing:
            for line in each.brief:
                status = status or run([*ICESOC, *shlex.split(line)], check=False,
                                       stdin=nothing, stdout=file, stderr=file)
        lines = log.read_text(errors="replace").strip().splitlines() or [""]
        table.add(name, status, time.monotonic() - begin, lines[-1].strip()[:100])
        if status not in (0, SKIPPED):
            say("\n".join("    " + line for line in lines[-20:]))
    return table.end()


def version():
    """Returns the versions of the project (CHANGELOG.md), of the radio protocol, and of the chip's
    blocks."""
    newest = product.newest()
    link = re.search(r"LINK_VERSION (\d+)", (TREE / "sw/link/link_frame.h").read_text())[1]
    blocks = []
    for path in sorted([*(TREE / "hdl").rglob("*.regs.json"), *(TREE / "ip").rglob("*.regs.json")]):
        block = Block.read(path)
        if block.is_slot:
            blocks.append(f"{block.name} {block.version >> 8}.{block.version & 255}")
    return f"icesoc {newest}\nlink protocol {link}\ncontracts: {', '.join(blocks)}"


def manual():
    """Returns the manual page, generated from the help of the commands."""
    def plain(text):
        return "".join(
            f"\\&{line}\n" for line in text.replace("\\", "\\e").replace("-", "\\-").splitlines())

    parts = [f'.TH ICESOC 1 "" "{version().partition(chr(10))[0]}"', ".SH NAME",
             "icesoc \\- every command of the IceSoC project", ".SH SYNOPSIS",
             "\\&./icesoc COMMAND [option...]", ".SH COMMANDS", ".nf",
             plain(doors.overview()) + ".fi"]
    for name, each in COMMANDS.items():
        parts += [f'.SH "{name.upper()}"', ".nf", plain(each.parser().format_help()) + ".fi"]
    return "\n".join(parts) + "\n"
