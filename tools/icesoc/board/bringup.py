# SPDX-License-Identifier: MIT
"""bringup: reads what the self-test prints on the console (sw/bringup/console.h), adds the pins and
connectors of each wire, and writes the report as JSON and as a page."""
import html
import json
import re

from icesoc import TREE

FAIL = re.compile(r"(?P<wire>\S+) (?P<kind>[^\s:]+): (?P<seen>.*); check: (?P<check>.*)")
ENDS = {"mcu": "microcontroller", "fpga": "FPGA", "modem": "modem"}


class Report:
    """A report, built from the lines of the console. data["result"] is "passed", "failed" or
    "stopped"."""
    def __init__(self, board):
        self.board = board  # a board of board.model, or None if unknown
        self.data = {"board": board.name if board else "", "result": "stopped", "steps": []}
        self.log = []

    @property
    def steps(self):
        return self.data["steps"]

    @property
    def failures(self):
        return [failure for step in self.steps for failure in step["failures"]]

    def take(self, line):
        """Adds a line of the console. Returns the text to show for this line, or None."""
        line = line.rstrip("\r\n")
        self.log.append(line)
        word, _, rest = line.partition(" ")
        if word == "BOARD":
            self.data["result"] = "stopped"
        if word == "STEP":
            name, _, passes = rest.partition(": ")
            self.steps.append({"name": name, "passes when": passes, "state": "stopped",
                               "figures": "", "notes": [], "failures": []})
            return f"{name}: {passes}"
        if word == "NEXT":
            self.data["next"] = rest
            return f"next: {rest}"
        if word == "END":
            self.data["result"] = "passed" if rest == "0" and not self.failures else "failed"
            for step in self.steps:
                if step["state"] == "stopped":
                    step["state"] = "failed" if step["failures"] else "done"
            return None
        if not self.steps:
            return None
        step = self.steps[-1]
        name, _, text = rest.partition(": " if word == "PASS" else " ")
        if word == "PASS":
            step.update(state="passed", figures=text)
            return f"  passed: {text}"
        if word == "INFO":
            step["notes"].append(rest)
            return f"  {rest}"
        if word == "FAIL" and (found := FAIL.match(text)):
            failure = {**found.groupdict(), "step": name, "places": self.places(found["wire"])}
            step["failures"].append(failure)
            step["state"] = "failed"
            return shown(failure)
        return None

    def places(self, wire):
        """Returns one line of text for each net of a wire, or of a pair of wires: the pins and
        connectors of the net."""
        found = []
        for name in wire.split("-"):
            net = self.board.net(name) if self.board else None
            if not net:
                continue
            ends = []
            for end, title in ENDS.items():
                if not net.get(end):
                    continue
                place = self.board.place(net, end)
                where = f" ({place[0]} pin {place[1]})" if place else ""
                ends.append(f"{title} {net.get(end)}{where}")
            found.append(f"{name}: {', '.join(ends)}")
        return found


def shown(failure):
    """Returns a failure as lines for a terminal."""
    lines = [f"  FAILED: {failure['wire']} {failure['kind']}: {failure['seen']}",
             *(f"    {place}" for place in failure["places"]), f"    check: {failure['check']}"]
    return "\n".join(lines)


def page(report):
    """Returns the report as one HTML page that needs no other files."""
    style = (TREE / "tools/icesoc/web/common.css").read_text()
    colours = {"passed": "good", "failed": "bad"}
    rows = []
    for step in report.steps:
        text = [html.escape(step["figures"]), *map(html.escape, step["notes"])]
        for failure in step["failures"]:
            text.append(f"<b>{html.escape(failure['wire'])} {html.escape(failure['kind'])}</b>: "
                        f"{html.escape(failure['seen'])}")
            text += map(html.escape, failure["places"])
            text.append(f"check: {html.escape(failure['check'])}")
        rows.append(f'<tr><td>{html.escape(step["name"])}</td>'
                    f'<td class="{colours.get(step["state"], "soft")}">{step["state"]}</td>'
                    f'<td>{html.escape(step["passes when"])}</td>'
                    f'<td>{"<br>".join(filter(None, text))}</td></tr>')
    result = report.data["result"]
    log = html.escape("\n".join(report.log))
    return f"""<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Bring-up of {html.escape(report.data["board"])}</title>
<style>{style}
th, td {{ text-align: left; vertical-align: top; padding: 3px 8px;
          border-bottom: 1px solid var(--line); }}
pre {{ background: var(--wash); padding: .6rem; overflow: auto; }}</style></head>
<body><h1>Bring-up of {html.escape(report.data["board"])}:
<span class="{colours.get(result, "soft")}">{result}</span></h1>
<p>{html.escape(report.data.get("how", ""))} {html.escape(report.data.get("date", ""))}
Modem: {html.escape(report.data.get("modem", "unknown"))}.</p>
<table><tr><th>step</th><th></th><th>passes when</th><th>result</th></tr>
{"".join(rows)}</table>
<h2>Console</h2><pre>{log}</pre></body></html>
"""


def write(report, folder):
    """Writes bringup.json and bringup.html; returns their paths."""
    folder.mkdir(parents=True, exist_ok=True)
    data, pretty = folder / "bringup.json", folder / "bringup.html"
    data.write_text(json.dumps({**report.data, "console": report.log}, indent=1) + "\n")
    pretty.write_text(page(report))
    return [pretty, data]
