# SPDX-License-Identifier: MIT
"""Synthesis: netlists by Yosys, utilisation, timing estimates, proofs of equivalence."""
