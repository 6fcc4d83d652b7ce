# SPDX-License-Identifier: MIT
"""The cores of a chip: address map, and the files generated from it."""
