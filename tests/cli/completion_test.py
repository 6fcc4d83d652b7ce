#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""completion_test: types command lines in a terminal with bash or zsh, presses Tab, and checks the
words that the shell adds.

    completion_test.py bash|zsh
"""
import importlib.util, os, pty, re, select, shutil, sys, time

from icesoc import TREE
from icesoc.util.errors import SKIPPED
from script import LONGEST

START = {"bash": (["bash", "--norc", "-i"], ""),
         "zsh": (["zsh", "-f", "-i"], "autoload -Uz compinit; compinit -D; ")}
# (line as typed, line after Tab)
LINES = [("make ip-t", "make ip-test"),
         ("make run CP", "make run CPU="),
         ("make run CPU=m", "make run CPU=m3"),
         ("make test LABEL=firm", "make test LABEL=firmware"),
         ("make synth DESIGN=modem_ba", "make synth DESIGN=modem_baud"),
         ("make run BOARD=xyn", "make run BOARD=xynergy"),
         ("make run IMAGE=docs/pictures/li", "make run IMAGE=docs/pictures/live.png")]
WORDS = [("./icesoc nig", "./icesoc nightly"),
         ("./icesoc core test f", "./icesoc core test fir"),
         ("./icesoc run --cpu m", "./icesoc run --cpu m3"),
         ("./icesoc run --board xyn", "./icesoc run --board xynergy"),
         ("./icesoc run --image docs/pictures/li", "./icesoc run --image docs/pictures/live.png"),
         ("./icesoc test hdl/mo", "./icesoc test hdl/modem")]


class Terminal:
    """A shell that completes the words of this project."""

    def __init__(self, words, before):
        self.text = ""
        pid, self.file = pty.fork()
        if not pid:
            os.chdir(TREE)
            os.execvpe(words[0], words, {**os.environ, "TERM": "dumb", "COLUMNS": "200"})
        self.type(f"PS1='> '; {before}eval \"$(./icesoc commands --completion)\"; echo rea''dy\r")
        self.wait("ready\r")

    def type(self, text):
        self.text = ""
        os.write(self.file, text.encode())

    def wait(self, wanted):
        """Reads the shell's output until it contains a text. Returns whether it does."""
        end = time.monotonic() + LONGEST
        while wanted not in self.text and time.monotonic() < end:
            if select.select([self.file], [], [], 1)[0]:
                self.text += re.sub(r"\x1b\[[0-9;?]*[A-Za-z]|\x07", "",
                                    os.read(self.file, 10000).decode())
        return wanted in self.text


def main(shell):
    if not shutil.which(shell):
        print(f"{shell} is missing (Debian: {shell})")
        return SKIPPED
    terminal = Terminal(*START[shell])
    for line, wanted in LINES + (WORDS if importlib.util.find_spec("argcomplete") else []):
        terminal.type(f"{line}\t")
        if not terminal.wait(wanted):
            print(f"{shell}: expected '{wanted}' after Tab, got {terminal.text!r}")
            return 1
        terminal.type("\x15")  # clears the line
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
