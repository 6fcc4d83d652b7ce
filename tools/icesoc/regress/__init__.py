# SPDX-License-Identifier: MIT
"""The test runner: selection, history, waveforms of failures, coverage, the report page."""
