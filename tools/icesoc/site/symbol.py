# SPDX-License-Identifier: MIT
"""symbol: draws the ports of a module as an SVG: inputs on the left, outputs on the right."""
from html import escape

# px; the last one is the width of a monospaced character
STEP, HEAD, MARGIN, CHAR = 18, 30, 60, 7.3
STYLE = """<style>
.box { fill: none; stroke: currentColor; stroke-width: 1.5; }
.line { stroke: currentColor; stroke-width: 1; }
.bus { stroke: currentColor; stroke-width: 2.5; }
text { font: 12px ui-monospace, monospace; fill: currentColor; }
.name { font-weight: bold; }
</style>"""


def rows(ports):
    """Returns the ports as rows of the drawing, with None as a gap between groups."""
    result, group = [], None
    for port in ports:
        if result and port.group != group:
            result.append(None)
        group = port.group
        result.append(port)
    return result


def draw(entity):
    """Returns the drawing of an entity as SVG, in the text colour of the page."""
    left = rows([p for p in entity.ports if p.direction == "input"])
    right = rows([p for p in entity.ports if p.direction != "input"])
    label = {id(p): p.name + (f" {p.width}" if p.width else "") for p in entity.ports}

    def widest(side):
        return max((len(label[id(p)]) for p in side if p), default=0) * CHAR

    box = max(widest(left) + widest(right) + 50, len(entity.name) * CHAR + 40)
    height = HEAD + max(len(left), len(right), 1) * STEP + 8
    width = box + 2 * MARGIN
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" role="img" viewBox="0 0 {width:.0f} '
             f'{height + 4:.0f}" width="{width:.0f}" aria-label="ports of {escape(entity.name)}">',
             STYLE,
             f'<rect class="box" x="{MARGIN}" y="2" width="{box:.0f}" height="{height - 2}" '
             'rx="4"/>',
             f'<text class="name" x="{MARGIN + box / 2:.0f}" y="19" text-anchor="middle">'
             f'{escape(entity.name)}</text>']
    for side, begin, end, at, anchor in ((left, MARGIN - 40, MARGIN, MARGIN + 8, "start"),
                                         (right, MARGIN + box, MARGIN + box + 40,
                                          MARGIN + box - 8, "end")):
        for number, port in enumerate(side):
            if not port:
                continue
            y = HEAD + number * STEP + 10
            kind = "bus" if port.width else "line"
            parts.append(f'<line class="{kind}" x1="{begin:.0f}" y1="{y}" x2="{end:.0f}" y2="{y}"/>'
                         f'<text x="{at:.0f}" y="{y + 4}" text-anchor="{anchor}">'
                         f'{escape(label[id(port)])}</text>')
    return "\n".join([*parts, "</svg>"]) + "\n"
