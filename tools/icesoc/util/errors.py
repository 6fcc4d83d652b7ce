# SPDX-License-Identifier: MIT
"""errors: exceptions that end a command of the tools early."""

SKIPPED = 77  # exit status of a command that needs a network and has none


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
