# SPDX-License-Identifier: MIT
"""Register descriptions: their model, headers for all languages, RDL and IP-XACT."""
