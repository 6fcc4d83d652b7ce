# SPDX-License-Identifier: MIT
"""command: the list of all commands, and the parser of each for its two entry points.

`./icesoc run --loss 0.1` and `make run LOSS=0.1` are equivalent: an option that is not given is
read from the environment variable with its name, and make exports the variables of its command line
to the environment.
"""
import argparse
import os
import re
import typing

from icesoc.cli.options import ARGUMENTS, BUILT, SWITCH
from icesoc.util.errors import Stop, nearest

COMMANDS = {}  # name such as "core new" -> Command, in the order of declaration
GROUPS = {}  # first word of the names of a group of commands -> help text of the group
DEFAULTS = {}  # name of a group -> the command that runs if only the group is named
SECTIONS = {  # sections of the overview: title -> commands and groups
    "Fly": ("run", "call", "replay", "gdb", "key", "fly"),
    "Add cores, look at the chip": ("core", "contract", "synth", "board"),
    "Build and test": ("build", "test", "regress", "bisect", "check", "bench", "nightly"),
    "The project": ("setup", "docs", "package", "release", "clean", "commands")}
ALIASES = {}  # further goals of make: goal -> (goal of the command, switch that the goal sets)


class Command:
    """A command, with its options and the function that runs it.

    make: goal of the command in make, or "". when: variable that selects this command if several
    commands have the same goal. takes_environment: an option that is not given is read from the
    environment variable with its name. brief: one or several command lines that run all steps of
    the command in a short time (commands --brief). long: command line that `nightly` runs, with
    {day} for a seed; None if the tests cover the command.
    """
    takes_environment = True

    def __init__(self, function, name, options, make, when, brief, long, examples):
        self.function, self.name, self.make, self.when = function, name, make, when
        self.brief, self.long = ([lines] if isinstance(lines, str) else list(lines)
                                 for lines in (brief, long))
        self.options = [*options, BUILT]
        text, _, more = function.__doc__.partition("\n\n")
        self.more = more.rstrip()
        self.help = " ".join(text.split())
        self.examples = examples

    @property
    def program(self):
        """Returns the words that start this command."""
        return f"./icesoc {self.name}"

    def parser(self, into=None):
        parser = into or argparse.ArgumentParser()
        parser.prog = self.program
        parser.formatter_class = argparse.RawDescriptionHelpFormatter
        parser.description = self.help + ("\n\n" + "\n".join(map(str.strip, self.more.split("\n")))
                                          if self.more else "")
        parser.epilog = "examples:\n" + "".join(
            f"  {self.example(each)}\n" for each in self.examples) if self.examples else None
        parser.allow_abbrev = False
        for option in self.options:
            if not option.listed:
                parser.add_argument(f"--{option.name}", action="store_true", default=None,
                                    help=argparse.SUPPRESS)
                continue
            name = option.field if option.positional else f"--{option.name}"
            more = {"help": self.explained(option), "default": None}
            if option.kind is SWITCH:
                more.update(action="store_true")
            else:
                more["metavar"] = option.name.upper() if option.positional else option.kind.metavar
                if option.positional or option.many:
                    more.update(nargs="*" if option.many else "?")
            action: typing.Any = parser.add_argument(name, **more)
            if option.completer:
                action.completer = option.completer
            elif option.choices or option.kind.words:
                action.completer = option.completions
            if option.positional:  # the option can also be given by name, as with make
                more["help"] = argparse.SUPPRESS
                again: typing.Any = parser.add_argument(f"--{option.name}",
                                                        dest=f"--{option.field}", **more)
                again.completer = getattr(action, "completer", None)
        return parser

    def example(self, text):
        """Returns the command line of an example. An example may also run another command."""
        is_own = text.startswith(self.name)
        return self.program + text.removeprefix(self.name) if is_own else f"./icesoc {text}"

    def explained(self, option):
        """Returns the help text of an option."""
        return f"{option.explain()} [{option.variable}]"

    def words(self, rest, place):
        """Returns the values of a command line."""
        parser = self.parser()

        def refuse(text):
            text = re.sub(r"^argument (\S+): ignored explicit argument (.*)",
                          r"\1: expected no value, got \2", text)
            text = re.sub(r"^argument (\S+): ", r"\1: ", text)
            raise Stop(f"{self.name}: {text} ({self.program} --help)", 2)

        parser.error = refuse
        parse = parser.parse_known_args
        if any(option.kind is ARGUMENTS for option in self.options):
            # options may stand between the arguments, and -1e3 is a number, not an option
            parse = parser.parse_known_intermixed_args
            parser._negative_number_matcher = re.compile(r"-\.?\d")
        given, left = parse(rest)
        names = [name for action in parser._actions for name in action.option_strings]
        for word in left:
            what = f" has no option {word.partition('=')[0]}" if word.startswith(
                "-") else f": unexpected argument '{word}'"
            raise Stop(f"{self.name}{what}{nearest(word.partition('=')[0], names)} "
                       f"({self.program} --help)", 2)
        return self.values(vars(given), None, place)

    def values(self, given, makes, place):
        """Returns the values of all options.

        given: texts by field; makes: variables of make's command line; place: the folder to which
        file names are relative. The result also contains the place."""
        values = argparse.Namespace(given=set(), given_by_make=makes is not None, place=place)
        for option in self.options:
            text = given.get(option.field) or given.get(f"--{option.field}")
            called = f"--{option.name}"
            if text is not None and makes is None:
                values.given.add(option.field)
                called = option.name.upper() if option.positional else called
            elif self.takes_environment and (option.variable != "LANG" or option.variable in (
                    # LANG counts only on make's command line; in the environment, it is the user's
                    # language
                    makes or ())):
                text, called = os.environ.get(option.variable), option.variable
                if text and option.variable in (makes or ()):
                    values.given.add(option.field)
            if text is True:
                value = True
            elif text in (None, "", []):
                value = option.none()
            else:
                if option.kind.locate:
                    text = option.kind.locate("" if place == os.getcwd() else place, text)
                value = option.value(text, called)
            setattr(values, option.field, value)
        for option in self.options:
            option.check_names(getattr(values, option.field), values)
        return values


def command(name, options=(), make=None, when=None, brief=(), long=(), examples=()):
    def declare(function):
        COMMANDS[name] = Command(function, name, options, make, when, brief, long, examples)
        return function

    return declare


def find(words):
    """Returns the command at the beginning of the words, and the remaining words."""
    for length in (2, 1):
        name = " ".join(words[:length])
        if name in COMMANDS:
            return COMMANDS[name], words[length:]
    first, rest = words[0], words[1:]
    if first in DEFAULTS and not (rest and not rest[0].startswith("-")):
        return COMMANDS[DEFAULTS[first]], rest
    if first in GROUPS:
        parts = [name.split()[1] for name in COMMANDS if name.startswith(first + " ")]
        if not rest:
            raise Stop(f"{first}: expected one of the commands {', '.join(parts)}", 2)
        raise Stop(f"{first} has no command '{rest[0]}'" + nearest(rest[0], parts), 2)
    raise Stop(
        f"unknown command '{first}'" + nearest(first, [*GROUPS, *COMMANDS])
        + " (./icesoc lists all)", 2)


def by_words(words, place):
    """Returns (command, values) of a command line."""
    found, rest = find(words)
    flags = {word.partition("=")[0] for word in rest}
    # `run --replay` selects the command replay, as `make run REPLAY=` does
    for each in COMMANDS.values():
        if each.when and each.make == found.make and f"--{each.when.lower()}" in flags:
            found = each
    return found, found.words(rest, place)


def by_make(goal, goals, makes):
    """Returns (command, values) of a goal of make."""
    def of(goal):
        if goal.endswith("/build.ninja"):
            os.environ["BUILD"], goal = os.path.dirname(goal), "configure"
        verb, switch = ALIASES.get(goal, (goal, ""))
        if switch:
            os.environ[switch] = "1"
        return [each for each in COMMANDS.values() if each.make == verb]

    if not of(goal):
        raise Stop(
            f"unknown target 'make {goal}'"
            + nearest(goal, [each.make for each in COMMANDS.values() if each.make]), 2)
    known = {"BUILD", "JOBS"} | {option.variable for each in goals for found in of(each)
                                 for option in found.options}
    for name in makes:
        if name not in known:
            others = sorted({each.make for each in COMMANDS.values() if each.make
                             and name in (o.variable for o in each.options)})
            where = (f"; it is one of make {', '.join(others)}" if others
                     else nearest(name.upper(), known))
            raise Stop(f"make {' '.join(goals)} has no variable {name}{where} "
                       f"(./icesoc {of(goal)[0].name} --help lists them)", 2)
    chosen = sorted(of(goal), key=lambda each: not (each.when and os.environ.get(each.when)))
    found = next(each for each in chosen if not each.when or os.environ.get(each.when))
    return found, found.values({}, makes, os.getcwd())


def short(text, width):
    """Returns a help text, shortened to `width` columns: cut at a comma, colon, semicolon or
    parenthesis, or else anywhere, with "..." at the end."""
    while len(text) > width:
        text = re.sub(r"[,;:(][^,;:(]*$", "", text).rstrip() if re.search("[,;:(]", text) \
            else text[:width - 3] + "..."
    return text


def row(name, text):
    return f"  {name:<10} {short(text, 67)}"


def overview():
    """Returns the output of `./icesoc` without arguments: one line per command or group."""
    lines = ["usage: ./icesoc COMMAND [option...]", "",
             "IceSoC: the functions of an FPGA and a microcontroller as ZeroC Ice objects."]
    rest = dict.fromkeys(name.split()[0] for name in COMMANDS)
    for title, names in SECTIONS.items():
        lines += ["", f"{title}:"]
        for name in names:
            rest.pop(name)
            lines.append(row(name, f"{GROUPS[name]} (./icesoc {name} --help)" if name in GROUPS
                             else COMMANDS[name].help))
    assert not rest, f"commands missing in the sections of the overview: {', '.join(rest)}"
    return "\n".join([
        *lines, "", "./icesoc COMMAND --help explains a command. By make: `make run LOSS=0.1` is",
        "`./icesoc run --loss 0.1`; help shows the name of make's variable in [brackets]."])


def group_help(group):
    """Returns the help of a group: one line per command."""
    lines = [f"usage: ./icesoc {group} COMMAND [option...]", "", GROUPS[group], ""]
    lines += [row(name.split()[1], each.help) for name, each in COMMANDS.items()
              if name.startswith(group + " ")]
    lines += ["", f"./icesoc {group} COMMAND --help explains a command."]
    if group in DEFAULTS:
        lines.append(f"Without COMMAND, ./icesoc {group} runs ./icesoc {DEFAULTS[group]}.")
    return "\n".join(lines)


def help_of(words):
    """Returns the help if the first or last word of a command line asks for it, or None."""
    if words and words[0] in ("help", "-h", "--help"):
        words = words[1:]
    elif not (len(words) == 2 and words[0] in GROUPS and words[1] in ("-h", "--help")):
        return None
    words = [word for word in words if word not in ("-h", "--help")]
    if not words:
        return overview()
    if len(words) == 1 and words[0] in GROUPS:
        return group_help(words[0])
    return find(words)[0].parser().format_help().rstrip("\n")
