# SPDX-License-Identifier: MIT
"""The command line: commands, their options, and the programs that they start."""
