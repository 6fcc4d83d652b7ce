# SPDX-License-Identifier: MIT
"""wiring: generates the wiring table, the bill of materials, and the page of a board."""
import csv
import html
import io

from icesoc.board.model import Board, Net
from icesoc.board.signals import BOTH, FPGA, MCU, MODEM

ARROWS = {MCU: "→", FPGA: "←", BOTH: "↔", MODEM: "←"}
STYLE = ("body{font:10pt sans-serif} table{border-collapse:collapse;width:100%} "
         "td,th{border:1px solid #888;padding:1pt 4pt;text-align:left} tr{break-inside:avoid} "
         "thead{display:table-header-group} @page{size:A4;margin:12mm}")


def end(board: Board, net: Net, role):
    """Returns (sort key, text) for one end of a wire; the text is the connector, its number and the
    pin."""
    pin, place = net.get(role), board.place(net, role)
    if place:
        return place, f"{place[0]}.{place[1]} ({pin})"
    return ("~", 0), pin or ""


def wires(board: Board):
    """Returns the wires as rows (key, from, arrow, to, net, remark), sorted by connector."""
    rows = []
    for net in board.nets:
        roles = [role for role in ("mcu", "fpga", "modem") if net.get(role)]
        ends = [end(board, net, role) for role in roles]
        if len(ends) == 1 and not net.get("to"):
            continue  # this net has a pull resistor but no wire
        if len(ends) == 1:
            module = board.modules.get(roles[0])
            use = module.occupied.get(net.get(roles[0]), {}) if module else {}
            if use.get("drives"):
                continue  # this net is already wired on the module
            ends.append((("~", 0), net.get("to")))
        arrow = "←" if net.signal.driver in (MODEM, "other") else ARROWS[net.signal.driver]
        if roles[0] == "fpga":
            arrow = {"→": "←", "←": "→"}.get(arrow, arrow) if net.signal.driver == FPGA else arrow
        rows.append((ends[0][0], ends[0][1], arrow, ends[1][1], net.name, remark(net)))
    return sorted(rows, key=lambda row: (row[0][0] == "~", row[0]))


def remark(net: Net):
    """Returns the remark about a wire: its series resistor, length, pull resistor and note. Empty
    if it has none of these."""
    words = [f"{net.get('series_ohm')} Ω in series" if net.get("series_ohm") else "",
             f"{net.get('length_mm')} mm" if net.get("length_mm") else "",
             f"pull-{net.get('pull')}" if net.get("pull") else "", net.get("note", "")]
    return ", ".join(word for word in words if word)


def table(board: Board):
    """Returns the wiring table as HTML for print, with boxes to tick."""
    body = "".join(
        "<tr><td>&#9744;</td>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in row[1:])
        + "</tr>\n" for row in wires(board))
    title = html.escape(f"Wiring of {board.facts['title']}")
    return (f"<!DOCTYPE html>\n<meta charset=\"utf-8\"><title>{title}</title>\n"
            f"<style>{STYLE}</style>\n<h1>{title}</h1>\n"
            f"<p>{len(wires(board))} wires. Connect ground before any of them: "
            f"{html.escape(grounds(board))}</p>\n"
            "<table><thead><tr><th></th><th>from</th><th></th><th>to</th><th>net</th>"
            f"<th>remark</th></tr></thead>\n<tbody>\n{body}</tbody></table>\n")


def grounds(board: Board):
    """Returns the ground pins of all connectors in use."""
    parts = []
    for role, module in board.modules.items():
        for connector in board.facts[role].get("connectors", []):
            pins = [str(number) for number, pin in
                    enumerate(module.facts["connectors"].get(connector, []), 1) if pin == "GND"]
            if pins:
                parts.append(f"{connector} pin{'s' if len(pins) > 1 else ''} {', '.join(pins)}")
    return "; ".join(parts) + "."


def materials(board: Board):
    """Returns the bill of materials as rows (quantity, item, remark)."""
    rows = [(1, module.facts.get("order", module.facts["title"]), module.facts["title"])
            for module in board.modules.values()]
    count = len(wires(board))
    if board.modules:
        rows += [
            (2, "pin header 2 x 35, pitch 2.54 mm",
             "for CN11 and CN12 of the Nucleo, if not fitted"),
            (2, "pin header 2 x 32, pitch 2.54 mm",
             "for U7 and U8 of the FPGA module, if not fitted"),
            (count + 10, "jumper wire, female to female, 10 to 15 cm",
             f"{count} signals, 10 grounds"),
            (1, "USB serial adapter, 3.3 V", "console, 115200 baud"),
            (1, "USB serial adapter, 3.3 V, with an FT232 or CP2102N",
             "replaces the modem for the first call, 111111 baud"),
            (1, "JTAG adapter for Xilinx (Platform Cable USB, or FT2232H with openFPGALoader)",
             "loads the bitstream at J2"),
            (1, "XBee of the same kind with a USB adapter", "the ground's modem")]
    rows += [(1, supply["source"], f"{supply['volts']:g} V, {supply.get('amperes', 0):g} A")
             for supply in board.facts.get("supplies", []) if "supply" in supply["source"]]
    series = sum(1 for net in board.nets if net.get("series_ohm"))
    if series:
        rows.append((series, "resistor in series", "see the wiring table"))
    return rows


def bom(board: Board):
    """Returns the bill of materials as CSV."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(("quantity", "item", "remark"))
    writer.writerows(materials(board))
    return text.getvalue()


def plain(text):
    """Returns a text, escaped so that Markdown does not take a part of it as an HTML tag."""
    return str(text).replace("<", "&lt;")


def cells(rows):
    """Returns the rows of a table in Markdown."""
    return "".join("| " + " | ".join(plain(cell).replace("|", "/") for cell in row) + " |\n"
                   for row in rows)


def bullets(texts):
    """Returns a list in Markdown."""
    return "".join(f"- {plain(text)}\n" for text in texts)


# Facts about a chip in board.toml, with the titles that the page shows.
FACTS = {
    "part": "part {value}", "speed": "speed grade -{value}", "hse_hz": "clock (HSE) {value} Hz",
    "hse": "HSE mode {value}", "clock_hz": "oscillator {value} Hz", "vccaux": "VCCAUX {value} V",
    "banks": "VCCO of banks 0 to 3: {value} V", "reset_low": "active-low reset key: {value}",
    "ddr": "DDR3 of the module in use: {value}", "debugger": "debugger {value}"}


def fact_text(value):
    """Returns the value of a fact as text."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    return ", ".join(map(str, value)) if isinstance(value, list) else str(value)


def page(board: Board):
    """Returns the board's page in Markdown, docs/boards/NAME.md."""
    facts = board.facts
    text = (f"# {plain(facts['title'])}\n\n"
            f"<!-- Generated by `./icesoc board make {board.name} --docs`. -->\n")
    if facts["status"] == "never powered":
        text += ("\n**We have never powered this board.** All facts on this page come from "
                 "documents.\n")
    if facts.get("unknown"):
        text += ("\n**This description is not complete enough to build the board.** `./icesoc "
                 f"board make {board.name}` fails.\n\nUnknown:\n\n{bullets(facts['unknown'])}")
    if facts.get("summary"):
        text += f"\n{plain(' '.join(facts['summary'].split()))}\n"
    text += "\n## Chips\n| chip | facts |\n|---|---|\n"
    for role, noun in (("mcu", "microcontroller"), ("fpga", "FPGA")):
        shown = [FACTS.get(key, "{key}: {value}").format(key=key, value=fact_text(value))
                 for key, value in facts[role].items() if key not in ("module", "connectors")]
        text += f"| {noun} | {'; '.join(shown)} |\n"
    if board.modem:
        text += (f"| modem | {board.modules['modem'].facts['title']}; profile {board.modem} "
                 "([modems on sale](../modem.md#modems-on-sale)) |\n")
    if board.ddr:
        text += f"| memory | {board.ddr['part']}, bank {board.ddr['bank']} |\n"
    if facts.get("open"):
        text += "\n## Before you connect anything\nOpen these bridges of the Nucleo:\n\n"
        uses = board.modules["mcu"].occupied
        text += "| bridge | frees | from |\n|---|---|---|\n" + cells(
            (bridge, pin, use["by"]) for bridge in facts["open"] for pin, use in uses.items()
            if use.get("release") == bridge)
    rows = wires(board)
    if rows:
        text += (f"\n## Wiring\n![wires]({board.name}.svg)\n\n{len(rows)} wires. Grounds: "
                 f"{grounds(board)}\n\n| from | | to | net | remark |\n|---|---|---|---|---|\n"
                 + cells(row[1:] for row in rows))
    if board.modules:
        text += "\n## Bill of materials\n| quantity | item | remark |\n|---|---|---|\n"
        text += cells(materials(board))
    if facts.get("supplies"):
        text += "\n## Supplies\n| supply | V | A | source | feeds |\n|---|---|---|---|---|\n"
        text += cells(
            (s["name"], f"{s['volts']:g}", f"{s.get('amperes', 0):g}", s["source"],
             ", ".join(s.get("feeds", []))) for s in facts["supplies"])
    notes = [*facts.get("notes", []), *(note for module in board.modules.values()
                                        for note in module.facts.get("notes", []))]
    if notes:
        text += f"\n## Notes\n{bullets(notes)}"
    sources = [*facts.get("sources", []), *(source for module in board.modules.values()
                                            for source in module.facts.get("sources", []))]
    if sources:
        text += f"\n## Sources\n{bullets(sources)}"
    return text
