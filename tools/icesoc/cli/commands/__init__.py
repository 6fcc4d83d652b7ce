# SPDX-License-Identifier: MIT
"""One file per group of commands; each declares its commands."""
