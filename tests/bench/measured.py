# SPDX-License-Identifier: MIT
"""measured: what a bench leaves: a list of figures as JSON."""
import json
from pathlib import Path


def figure(name, value, unit, limit=None, peer=None, ratio=None):
    """A figure, beside the limit that it is measured by, or beside a peer's."""
    entry = {"name": name, "value": value, "unit": unit, "command": "make bench"}
    if limit:
        entry.update(limit=limit, share=round(value / limit, 3))
    if peer:
        entry.update(peer=peer, ratio=round(ratio, 2))
    return entry


def leave(output, content):
    Path(output).parent.mkdir(parents=True, exist_ok=True)
    Path(output).write_text(json.dumps(content, indent=1) + "\n")
    print(f"Written: {output}")
