# SPDX-License-Identifier: MIT
"""everything: declares all commands. This takes a tenth of a second, so for a few commands, main.py
imports only the file that declares them."""
from icesoc.cli.commands import (  # noqa: F401 (each declares its commands)
    flights, key, call, core_folder, core, foreign, board, bringup, synth, build, figures,
    regression, checks, coverage, fresh, package, docs, release, tree)
