# SPDX-License-Identifier: MIT
"""table: prints the rows of a table as soon as they are known, and writes them to a Markdown
file."""
from pathlib import Path

from icesoc.util.console import say
from icesoc.util.errors import SKIPPED, Stop


class Table:
    """Rows of a table that is written to PATH.md, row by row."""
    def __init__(self, path):
        self.path, self.rows = Path(path), []

    def add(self, name, status, seconds, figure=""):
        self.rows.append({"command": name, "status": status, "seconds": round(seconds, 1),
                          "figure": figure})
        said = {0: "ok", SKIPPED: "skipped"}.get(status, f"FAILED ({status})")
        say(f"{name:<18} {said:<12} {seconds:7.1f} s  {figure}")
        self.path.parent.mkdir(parents=True, exist_ok=True)
        lines = ["| command | status | seconds | last output |", "|---|---|---|---|"]
        for row in self.rows:
            last = row["figure"].replace("|", "/")
            lines.append(f"| {row['command']} | {row['status']} | {row['seconds']} | {last} |")
        self.path.with_suffix(".md").write_text("\n".join(lines) + "\n")

    def end(self):
        """Completes the table. If items failed, ends the command with an error that names them."""
        seconds = sum(row["seconds"] for row in self.rows)
        skipped = [row for row in self.rows if row["status"] == SKIPPED]
        if failed := [row["command"] for row in self.rows if row["status"] not in (0, SKIPPED)]:
            raise Stop(f"failed: {', '.join(failed)} ({self.path}.md)")
        for row in skipped:
            say(f"skipped: {row['command']}: {row['figure']}")
        say(f"{len(self.rows) - len(skipped)} commands, {seconds:.0f} s: {self.path}.md")
