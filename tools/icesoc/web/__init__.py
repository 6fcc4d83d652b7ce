# SPDX-License-Identifier: MIT
"""The pages: their style and scripts, and the server of a flight's live page."""
