# SPDX-License-Identifier: MIT
"""errors: exceptions that end a command of the tools, and functions for messages."""
import difflib

SKIPPED = 77  # exit status of a command that needs a network but has none


class Stop(Exception):
    """Ends a command with a message and an exit status. The message is empty if a program has
    already printed one."""
    def __init__(self, text="", status=1):
        super().__init__(text)
        self.text, self.status = text, status


class Interrupted(BaseException):
    """A signal that ends the command."""
    def __init__(self, number):
        super().__init__(number)
        self.status = 128 + number


def reason_of(error):
    """Returns the text of an exception for a message: without its class, and for an error of the
    system, without its number."""
    if isinstance(error, OSError) and error.strerror:
        return ": ".join(str(part) for part in (error.filename, error.strerror) if part)
    return f"missing key {error}" if isinstance(error, KeyError) else str(error)


def nearest(word, words):
    """Returns the end of a message about an unknown word: the most similar known word."""
    close = difflib.get_close_matches(word, list(words), 1, 0.5)
    return f"; did you mean {close[0]}?" if close else ""
