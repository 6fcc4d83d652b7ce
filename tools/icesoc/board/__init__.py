# SPDX-License-Identifier: MIT
"""Boards as data: reads and checks boards/NAME/board.toml, and generates files from it."""
