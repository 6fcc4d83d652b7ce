# SPDX-License-Identifier: MIT
"""installed: the program icesoc-call, which is `./icesoc call` without the source tree.

The package icesoc-ground contains this module and all modules that it imports. Options that need
the source tree are left out, and make's variables in the environment are ignored.
"""
import dataclasses
import os
import sys

import places

from icesoc.cli.command import Command
from icesoc.cli.commands.call import OPTIONS, call
from icesoc.cli.main import main
from icesoc.cli.options import FILE, KEY_FILE

# options that need the source tree, and their fixed values in this program
TREE_ONLY = {"build": places.SHARE, "flight": "", "page": False, "plugin": ""}
TEXTS = {"vehicle": "name of the vehicle in vehicles.conf, or in IceGrid; default: the only one of "
                    "vehicles.conf",
         "slice": "Slice files of objects that the default chip does not have, separated by spaces"}
HELP = """call an operation of any object of a vehicle

The vehicle is one of ~/.config/icesoc/vehicles.conf or /etc/icesoc/vehicles.conf, or the options
name it. Arguments follow by position, or as NAME=VALUE: JSON for structures and sequences, @FILE
for bytes and pictures. They are checked against Slice before anything is sent. Exit status: 2
wrong arguments, 3 the operation threw an exception, 4 no answer, 5 no such object or operation, 6
the operation refused the call and gave no reason."""
EXAMPLES = ["call --list hwengine1", "call hwengine1.setParameterA 24",
            "call uav.isAlive 7 --repeat 100 --vehicle uav2",
            "call fir.filter '[100, 200, 300]' --gateway gateway:10000",
            "call thing.add 3 4 --slice Thing.ice --gateway 127.0.0.1:10001"]


class Installed(Command):
    """The command `call` as a separate program."""
    program = "icesoc-call"
    takes_environment = False

    def __init__(self):
        super().__init__(call, "call", OPTIONS, None, None, (), (), EXAMPLES)
        self.help, _, self.more = HELP.partition("\n\n")
        self.options = [
            dataclasses.replace(option, help=TEXTS.get(option.name, option.help),
                                kind=FILE if option.kind is KEY_FILE else option.kind)
            for option in OPTIONS if option.name not in TREE_ONLY]

    def explained(self, option):
        return option.explain()

    def values(self, given, makes, place):
        values = super().values(given, makes, place)
        vars(values).update(TREE_ONLY)
        return values


def act(words):
    """Executes a command line."""
    os.environ["LC_ALL"] = "C.UTF-8"
    return call(Installed().words(words, os.getcwd()))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:], act))
