# SPDX-License-Identifier: MIT
"""picture: draws a board's wires as SVG: connectors as columns of pins, wires between them."""
import html

from icesoc.board.model import Board

ROW, WIDTH, GAP, TOP, LEFT = 13, 120, 30, 60, 20
SPAN = 420  # px; distance between the microcontroller's column and the FPGA's column
COLOURS = {"A": "#2b6cb0", "D": "#c05621", "N": "#2f855a", "I": "#2f855a", "M": "#6b46c1"}


def place_connectors(board: Board):
    """Returns {(role, connector): (x, y)} and the height of the picture."""
    found, heights = {}, []
    for column, roles in enumerate((("mcu",), ("fpga", "modem"))):
        x, y = LEFT + column * (WIDTH + SPAN), TOP
        for role in roles:
            module = board.modules.get(role)
            for connector in board.facts.get(role, {}).get("connectors", []) if module else []:
                found[role, connector] = (x, y)
                y += ROW * (len(module.facts["connectors"][connector]) + 1) // 2 + GAP
        heights.append(y)
    return found, max(heights, default=TOP)


def spot(found, board, net, role):
    """Returns the point where a wire meets a connector, or None."""
    place = board.place(net, role)
    if not place:
        return None
    x, y = found[role, place[0]]
    side = (place[1] - 1) % 2
    return x + side * WIDTH, y + ROW * ((place[1] - 1) // 2) + ROW // 2 - 3


def box(board, role, connector, point):
    """Yields the elements of one connector: two columns of pins with their numbers."""
    x, y = point
    pins = board.modules[role].facts["connectors"][connector]
    rows = (len(pins) + 1) // 2
    used = {net.get(role) for net in board.nets}
    yield f'<text x="{x}" y="{y - 6}" class="t">{connector} {html.escape(role)}</text>'
    yield (f'<rect x="{x}" y="{y - 2}" width="{WIDTH}" height="{rows * ROW}" class="b"/>')
    for index, pin in enumerate(pins):
        right = index % 2
        at = y + ROW * (index // 2) + ROW - 5
        anchor = "end" if right else "start"
        style = "p" if pin in used else "q"
        text = f"{pin} {index + 1}" if right else f"{index + 1} {pin}"
        yield (f'<text x="{x + (WIDTH - 4 if right else 4)}" y="{at}" class="{style}" '
               f'text-anchor="{anchor}">{html.escape(text)}</text>')


def draw(board: Board):
    """Returns the picture as SVG text."""
    found, height = place_connectors(board)
    width = 2 * LEFT + 2 * WIDTH + SPAN
    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
             f'width="{width}" height="{height}" font-family="sans-serif">',
             f"<title>Wires of {html.escape(board.facts['title'])}</title>",
             "<style>.t{font-size:12px;font-weight:bold}.p{font-size:9px}"
             ".q{font-size:9px;fill:#888}.b{fill:#f7f7f7;stroke:#444}"
             ".w{fill:none;stroke-width:1.1}.n{font-size:12px}</style>",
             f'<rect width="{width}" height="{height}" fill="#fff"/>']
    for (role, connector), point in found.items():
        lines += box(board, role, connector, point)
    for net in board.nets:
        spots = [spot(found, board, net, role) for role in ("mcu", "fpga", "modem")]
        spots = [point for point in spots if point]
        if len(spots) == 2:
            (x1, y1), (x2, y2) = spots
            bend = SPAN // 3
            to = x2 - bend if x2 > x1 + bend else x2 + bend
            colour = COLOURS.get(net.name[0], "#4a5568")
            lines.append(f'<path class="w" stroke="{colour}" d="M{x1} {y1}C{x1 + bend} {y1} {to} '
                         f'{y2} {x2} {y2}"><title>{net.name}</title></path>')
    for index, (name, colour) in enumerate((("data", "#c05621"), ("address", "#2b6cb0"),
                                            ("strobes, NWAIT, interrupt", "#2f855a"),
                                            ("modem", "#6b46c1"))):
        lines.append(f'<text x="{LEFT + 110 * index}" y="24" class="n" fill="{colour}">'
                     f"{name}</text>")
    return "\n".join([*lines, "</svg>"]) + "\n"
