# SPDX-License-Identifier: MIT
"""console: prints the output of commands."""
import sys


def say(text):
    print(text, flush=True)


def warn(text):
    print(f"icesoc: {text}", file=sys.stderr, flush=True)
