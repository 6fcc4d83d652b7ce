# SPDX-License-Identifier: MIT
"""New cores, third-party cores, and the embedded logic analyser."""
