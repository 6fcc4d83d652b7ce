# SPDX-License-Identifier: MIT
"""spelling: writes commands and options in messages as the user types them: with ./icesoc, or with
make."""
import shlex

IS_MAKE = False  # make started this program; the entry points set it


def option(name, values=()):
    """Returns an option with its values: `--ports open=a low=b` or `PORTS='open=a low=b'`."""
    values = [str(values)] if not isinstance(values, (list, tuple)) else values
    if not IS_MAKE:
        return " ".join([f"--{name}", *map(shlex.quote, values)])
    name = name.upper().replace("-", "_")
    return f"{name}={quoted(' '.join(values))}" if values else name


def switch(name):
    """Returns an option without a value: `--open` or `OPEN=1`."""
    return option(name, "1" if IS_MAKE else ())


def command(name, *options):
    """Returns a command with options: `./icesoc run --live` or `make run LIVE=1`."""
    return " ".join([f"make {name}" if IS_MAKE else f"./icesoc {name}", *options])


def quoted(text):
    """Returns the value of a variable, in quotes if the shell needs them or if it is a pair."""
    return f"'{text}'" if "=" in text and "'" not in text else shlex.quote(text)
