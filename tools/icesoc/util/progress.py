# SPDX-License-Identifier: MIT
"""progress: shows the progress of a command in one line."""
import os
import sys
import threading


class Line:
    """A line of text. On a terminal, each text replaces the one before. Other outputs get only
    texts shown with `keep`."""

    def __init__(self, stream=None):
        """stream: default sys.stdout, also if that is replaced later"""
        self.given, self.is_shown, self.lock = stream, False, threading.Lock()

    @property
    def stream(self):
        return self.given or sys.stdout

    @property
    def moves(self):
        return self.stream.isatty()

    def show(self, text, keep=False):
        """Shows a text. With `keep`, the text stays, and the next text is on a new line."""
        with self.lock:
            if self.moves:
                width = os.get_terminal_size(self.stream.fileno()).columns or 80
                self._write(f"\r\033[K{text[:width - 1]}" + "\n" * keep)
                self.is_shown = not keep
            elif keep:
                self._write(text + "\n")

    def clear(self):
        with self.lock:
            if self.is_shown:
                self._write("\r\033[K")
            self.is_shown = False

    def _write(self, text):
        print(text, end="", flush=True, file=self.stream)


def clock(units):
    """Returns seconds as "minutes:seconds", or minutes as "hours:minutes"."""
    return f"{int(units) // 60}:{int(units) % 60:02}"


def is_tenth(done, total):
    """Returns whether the last step has completed another tenth of all steps."""
    return 10 * done // total != 10 * (done - 1) // total
