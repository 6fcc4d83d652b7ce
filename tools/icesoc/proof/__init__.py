# SPDX-License-Identifier: MIT
"""Proofs of modules: their models, the engines, and the steps of a proof."""
