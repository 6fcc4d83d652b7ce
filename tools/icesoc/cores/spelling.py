# SPDX-License-Identifier: MIT
"""spelling: writes the options of `core foreign` in messages, as the user types them: as options of
./icesoc, or as variables of make."""
import shlex

IS_MAKE = False  # new_foreign.py sets this if make started it


def option(name, values=()):
    """Returns an option with its values: `--ports open=a low=b` or `PORTS='open=a low=b'`."""
    values = [values] if isinstance(values, str) else values
    if not IS_MAKE:
        return " ".join([f"--{name}", *map(shlex.quote, values)])
    return f"{name.upper()}={quoted(' '.join(values))}" if values else name.upper()


def quoted(text):
    """Returns the value of a variable, in quotes if it contains several words or a pair."""
    return f"'{text}'" if set(text) & set(" =*") else text
