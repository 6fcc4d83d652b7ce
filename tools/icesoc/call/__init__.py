# SPDX-License-Identifier: MIT
"""call: calls any operation of any object from the command line (docs/call.md)."""
