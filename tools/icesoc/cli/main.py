# SPDX-License-Identifier: MIT
"""main: the two entry points (./icesoc and make), the environment of all programs, and error
handling."""
import importlib
import io
import os
import pwd
import re
import sys
import traceback
from pathlib import Path

from icesoc import TREE
from icesoc.cli import command
from icesoc.util import spelling
from icesoc.util.console import say, warn
from icesoc.util.errors import Interrupted, Stop
from icesoc.util.process import hear_signals, is_part


def surroundings():
    """Sets the environment for all programs, and changes to the folder of the tree. Returns the
    caller's folder."""
    try:
        place = os.getcwd()
    except FileNotFoundError:
        raise Stop("the current folder no longer exists; cd to another one", 2) from None
    tree = os.environ.pop("ICESOC_TREE", "")  # a test sets ICESOC_TREE to use another tree
    os.chdir(tree or TREE)
    place = os.getcwd() if tree else place
    # ccache and icesoc.util.fetch store files in HOME, which a timer or a container may not set.
    os.environ.setdefault("HOME", pwd.getpwuid(os.getuid()).pw_dir)
    # Paths below this folder are relative in the compiler cache, so that all clones share the
    # cache.
    os.environ.update(CCACHE_BASEDIR=os.getcwd(), CCACHE_NOHASHDIR="1")
    os.environ[
        "LC_ALL"] = "C.UTF-8"  # all tools print a decimal point, whatever the language of the user
    return place


def make_gave():
    """Returns (goal, all goals, names of the variables on make's command line), or None if the
    caller is not make."""
    goal, goals = os.environ.pop("ICESOC_GOAL", ""), os.environ.pop("ICESOC_GOALS", "").split()
    flags = os.environ.pop("MAKEFLAGS", "")
    for name in ("MFLAGS", "MAKELEVEL", "MAKEOVERRIDES"):
        os.environ.pop(name, None)
    names = re.findall(r"(?:^|(?<=\s))([A-Za-z_]\w*) ?:?=",
                       re.sub(r"\\.", "", " " + flags.partition(" -- ")[2]))
    return (goal, goals or [goal], names) if goal else None


# Commands that start quickly, because only the file that declares them is imported.
QUICK = {"call": "call", "core test": "core", "run": "flights"}


def declare(words):
    """Declares the command of these words, or all commands."""
    names = () if "_ARGCOMPLETE" in os.environ else (" ".join(words[:1]), " ".join(words[:2]))
    file = next((QUICK[name] for name in names if name in QUICK), "")
    importlib.import_module(f"icesoc.cli.commands.{file}" if file else "icesoc.cli.everything")


def act(words):
    place = surroundings()
    made = make_gave()
    declare(words)
    if "_ARGCOMPLETE" in os.environ or os.environ.get("_ICESOC_MAKE"):
        from icesoc.cli import completion  # not part of the installed icesoc-call
        line = os.environ.get("_ICESOC_MAKE")
        return say("\n".join(completion.complete_make(line))) if line else completion.complete()
    if not words and (not made or made[0] == "help"):
        return say(command.overview())
    if made:
        spelling.IS_MAKE = True
        found, values = command.by_make(*made)
    elif text := command.help_of(words):
        return say(text)
    elif words[0] == "--version":
        from icesoc.cli.commands import tree
        return say(tree.version())
    else:
        found, values = command.by_words(words, place)
    # The programs that a command starts do not inherit the variables of its options. The command
    # passes the values that they need.
    for option in found.options:
        os.environ.pop(option.variable if option.variable != "LANG" else "", None)
    return found.function(values)


def main(words, function=act):
    """Runs a function with the words of the command line; prints its error and returns its exit
    status."""
    hear_signals()
    is_reported = is_part()  # read now, because the other command may end before this one
    try:
        return function(words) or 0
    except Stop as stop:
        if stop.text:
            warn(stop.text)
        return stop.status
    except Interrupted as interrupted:
        if not is_reported:
            warn("stopped")
        return interrupted.status
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1
    except OSError as error:
        path = path_of(error)
        warn(f"{error.strerror or error}" + (f": {path}" if path else ""))
        return 1


def path_of(error):
    """Returns the path of the file to which an exception refers. If a write fails, for example on a
    full disk, the exception contains no path. The path is then guessed from the local variables of
    the innermost function that has an open file or a path among them."""
    found = error.filename or ""
    for frame, _ in [] if found else traceback.walk_tb(error.__traceback__):
        local = frame.f_locals.values()
        names = [getattr(each, "name", "") for each in local if isinstance(each, io.IOBase)]
        names = [each for each in names if each and isinstance(each, str)]
        names += [str(each) for each in local if isinstance(each, Path)]
        found = names[0] if names else found
    return found
