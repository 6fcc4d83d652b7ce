# SPDX-License-Identifier: MIT
"""release: what leaves this tree: IceC for other firmware projects, and the files of a release."""
