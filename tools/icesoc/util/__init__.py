# SPDX-License-Identifier: MIT
"""Building blocks of the other folders: processes, files, downloads."""
