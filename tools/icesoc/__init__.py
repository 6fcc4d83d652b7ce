# SPDX-License-Identifier: MIT
"""icesoc: the tools of the project, as one package. `./icesoc` and CMake run its modules by
`tools/python`."""
from pathlib import Path

TREE = Path(__file__).resolve().parents[2]  # root of the project
