# SPDX-License-Identifier: MIT
"""release: makes the files that are published: IceC for other firmware projects, and the files of a
release."""
