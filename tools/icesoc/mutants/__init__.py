# SPDX-License-Identifier: MIT
"""Seeded bugs: plants them and expects a test to fail."""
