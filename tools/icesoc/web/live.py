# SPDX-License-Identifier: MIT
"""live: serves the page that shows a mission as it runs, on the loopback interface only.

Each connection has a separate thread and one request: a slow, silent or endless client makes no
other wait, and ends after PATIENCE seconds of silence.
"""

import sys


def refuse(kind, error, trace):
    """Reports a lack of memory, which Python may also report as a library that cannot be loaded."""
    if issubclass(kind, (MemoryError, ImportError)):
        print("icesoc-live: error: not enough memory for the page", file=sys.stderr)
    else:
        sys.__excepthook__(kind, error, trace)


sys.excepthook = refuse

import argparse
import http.server
import json
import os
import re
import signal
from http import HTTPStatus

from icesoc.call import objects
from icesoc.regs.model import Block, Wrong
from icesoc.util import record
from icesoc.util.errors import Stop
from icesoc.web import bridge

HERE = os.path.dirname(os.path.abspath(__file__))

PATIENCE = 10  # seconds
NEWEST = 128 << 10  # bytes of events.jsonl that a page shows: a long flight does not make it large
MOST_VEHICLES = 32  # vehicles per modem on the ground
FILES = {  # path: MIME type, file
    "/": ("text/html; charset=utf-8", HERE + "/flight/index.html"),
    "/live.css": ("text/css", HERE + "/flight/live.css"),
    "/live.js": ("text/javascript", HERE + "/flight/live.js"),
    "/slice.js": ("text/javascript", HERE + "/flight/slice.js"),
    "/fields.js": ("text/javascript", HERE + "/flight/fields.js"),
    "/objects.js": ("text/javascript", HERE + "/flight/objects.js"),
    "/common.css": ("text/css", HERE + "/common.css"),
    "/common.js": ("text/javascript", HERE + "/common.js")}
STATUS = record.of_tree("testbench/status/sim_status.toml")
SCHEMA = HERE + "/../cli/flight.schema.json"
# The page loads only from its server, and no other page may frame it.
POLICY = ("default-src 'self'; img-src 'self' data: blob:; style-src 'self' 'unsafe-inline'; "
          "worker-src blob:; "  # timers of Ice for JavaScript
          "frame-ancestors 'none'; base-uri 'none'; form-action 'none'")
COUNTERS = ("ns", "cycles", "bytesUp", "bytesDown", "packets", "lost", "wallNs")
WRITTEN = 2


def contents(path):
    """Returns a file's content; empty if it cannot be read."""
    try:
        with open(path, "rb") as file:
            return file.read()
    except OSError:
        return b""


def rows(lines):
    """Returns the JSON objects in lines; the last one may be incomplete."""
    for line in lines:
        try:
            row = json.loads(line)
        except ValueError:
            continue
        if isinstance(row, dict):
            yield row


def newest(path):
    """Returns the lines in the last bytes of a file."""
    try:
        with open(path, "rb") as file:
            size = file.seek(0, os.SEEK_END)
            file.seek(max(0, size - NEWEST))
            if size > NEWEST:
                file.readline()  # the end of one line
            return file.readlines()
    except OSError:
        return []


def picture(folder, address):
    """Path of a vehicle's picture of this flight: with corners, once it has answered."""
    paths = (f"{folder}/{name}{address}.png" for name in ("after", "before"))
    return next(filter(os.path.exists, paths), "")


def blocks_by_slot(registers):
    """Returns [(slot, name, its block or None)]; `registers`: file that lists the blocks'
    *.regs.json, one a line."""
    with open(registers) as paths:
        found = [Block.read(path, is_built=True) for path in filter(None, paths.read().split("\n"))]
    blocks = {block.name: block for block in found}
    slots = []
    for constant in blocks["map"].constants:
        prefix, _, name = constant.name.lower().partition("slot_")
        if not prefix and name not in ("", "count"):
            slots.append((constant.value, name, blocks.get(name)))
    return sorted(slots, key=lambda slot: slot[0])


def register(block, word, value, seen):
    """Returns a word with its name and its fields. What was written to EVENT is not a state: each 1
    has cleared an event."""
    common = ("ID", "EVENT", "MASK")
    found = next((r for r in block.registers if r.word == word), None) if block else None
    clears = word == 1 and seen == WRITTEN
    fields = []
    for f in found.fields if found and word else []:
        bits = value >> f.lsb & (1 << f.width) - 1
        if bits or not clears:
            fields.append({"name": f.name, "value": "cleared" if clears else bits, "doc": f.doc})
    name = found.name if found else common[word] if word < 3 else f"word {word}"
    return {"word": word, "value": value, "written": seen == WRITTEN, "name": name,
            "doc": found.doc if found and word > 2 else "", "fields": fields}


def heading(folder):
    """The options of this flight (flight.json) that are not the defaults."""
    try:
        with open(SCHEMA) as schema, open(folder + "/flight.json") as file:
            fields, flight = json.load(schema)["properties"], json.load(file)
    except (OSError, ValueError):
        return ""
    hidden = ("version", "out", "firmware", "key", "port", "live")
    return ", ".join(f"{name} {value if not isinstance(value, list) else ' '.join(value)}"
                     for name, value in flight.items()
                     if name not in hidden and value != fields.get(name, {}).get("default"))


def state(folder, slots):
    """Returns the data of the page, read from files of simulator and ground station; fields of
    missing files are empty."""
    shown = {"calls": [], "features": [], "slots": [], "flight": heading(folder)}
    status = contents(folder + "/status")
    if len(status) >= STATUS.size and status.startswith(STATUS.constants["SIM_MAGIC"].encode()):
        values = STATUS.unpack(status)
        shown["air"] = {name: values[name] for name in COUNTERS}
        registers, seen = values["registers"], values["seen"]
        for slot, name, block in slots:
            words = [register(block, word, registers[slot * 16 + word], seen[slot * 16 + word])
                     for word in range(16) if seen[slot * 16 + word]]
            shown["slots"].append({"slot": slot, "block": name, "doc": block.doc if block else "",
                                   "words": words})
    for row in rows(contents(folder + "/calls.jsonl").split(b"\n")):
        if "features" in row:
            shown.update(features=row["features"], found=row["found"])
        else:
            shown["calls"].append(row)
    shown["events"] = list(rows(newest(folder + "/events.jsonl")))
    changed = {name: os.stat(path).st_mtime_ns for name in ("before.png", "report.json")
               if os.path.exists(path := f"{folder}/{name}")}
    shown["frame"] = "before.png" in changed
    others = ((address, picture(folder, address)) for address in range(2, MOST_VEHICLES + 1))
    shown["others"] = [[address, os.path.basename(path)] for address, path in others if path]
    # A report older than the picture is of the previous mission.
    shown["over"] = len(changed) == 2 and changed["report.json"] >= changed["before.png"]
    return shown


def gateway(folder):
    """Returns (host, port) of --gateway, or of the first vehicle in the flight, or None."""
    if Page.gateway:
        return Page.gateway
    live = objects.flight(folder)
    found = live and re.search(r"-h (\S+) -p (\d+)", next(iter(live["vehicles"].values())))
    return (found[1], int(found[2])) if found else None


def described(build, address):
    """Returns the vehicle's objects with the declarations of their interfaces, and the address at
    which programs call them."""
    try:
        catalogue = objects.Catalogue(build)
    except Stop as stop:
        return {"objects": [], "declarations": {}, "error": stop.text}
    host, port = address or ("127.0.0.1", 10000)
    return {"objects": [{"identity": each.identity, "interface": each.interface, "block": each.core}
                        for each in catalogue.objects.values() if each.interface],
            "declarations": catalogue.slices.declarations, "endpoint": f"tcp -h {host} -p {port}",
            "command": "./icesoc call"}


class Page(http.server.BaseHTTPRequestHandler):
    """A request for the page of a mission."""
    protocol_version, timeout = "HTTP/1.1", PATIENCE
    error_message_format, error_content_type = "%(code)d %(message)s\n", "text/plain"
    folder, slots, build, gateway = "", [], "", None

    def do_GET(self):
        port = self.server.socket.getsockname()[1]
        hosts = self.headers.get_all("Host", [])
        # A page on another host may use another name for this address.
        if len(hosts) != 1 or hosts[0] not in (f"127.0.0.1:{port}", f"localhost:{port}"):
            return self.send_error(HTTPStatus.FORBIDDEN)
        path, _, query = self.path.partition("?")
        if path == "/ice":
            return bridge.serve(self, hosts[0], query, gateway(self.folder))
        frame = self.folder + "/before.png" if path == "/frame.png" else ""
        if vehicle := re.fullmatch(r"/vehicle(\d{1,2})\.png", path):
            frame = picture(self.folder, vehicle[1])
        kind, file = FILES.get(path, ("image/png", frame))
        if path == "/ice.js":
            kind, file = "text/javascript", self.build + "/page/ice.js"
        if path == "/state":
            kind, content = "application/json", json.dumps(state(self.folder, self.slots)).encode()
        elif path == "/objects":
            kind, content = "application/json", json.dumps(
                described(self.build, gateway(self.folder))).encode()
        else:
            content = contents(file)
        if path == "/":
            content = content.replace(b"%TOKEN%", bridge.TOKEN.encode())
        if not content:
            return self.send_error(HTTPStatus.NOT_FOUND)
        self.send_response(HTTPStatus.OK)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(content)))
        self.send_header("Content-Security-Policy", POLICY)
        self.send_header("X-Content-Type-Options", "nosniff")
        self.send_header("Connection", "close")
        self.end_headers()
        self.wfile.write(content)

    def log_message(self, *_):
        pass


class Server(http.server.ThreadingHTTPServer):
    request_queue_size = 128

    def handle_error(self, *_):
        pass  # the client has gone, or is not worth waiting for


def port_number(text):
    if not 0 <= (port := int(text)) <= 65535:
        raise argparse.ArgumentTypeError(f"{port} is not in 0..65535")
    return port


def place(text):
    host, _, port = text.rpartition(":")
    return host.strip("[]"), port_number(port)


def main():
    parser = argparse.ArgumentParser(
        prog="icesoc-live",
        description="Serves the page that shows a mission as it runs, on 127.0.0.1.")
    parser.add_argument("--dir", required=True,
                        help="the mission's folder: status, calls.jsonl, before.png")
    parser.add_argument("--registers", required=True,
                        help="file that lists the *.regs.json of all blocks; map.regs.json assigns "
                        "blocks to slots")
    parser.add_argument("--gateway", type=place, help="HOST:PORT of a gateway to call instead of "
                        "the flight's")
    parser.add_argument("--port", type=port_number, default=0, help="0: any that is free")
    parser.add_argument("--try", dest="only_try", action="store_true",
                        help="only look whether the page can be served")
    words = parser.parse_args()
    try:
        Page.folder, Page.slots = words.dir, blocks_by_slot(words.registers)
        Page.gateway = words.gateway
        Page.build = os.path.dirname(os.path.dirname(os.path.abspath(words.registers)))
    except (OSError, ValueError, KeyError, Wrong) as error:
        sys.exit(f"icesoc-live: error: cannot read '{words.registers}': {error}")
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: os._exit(0))
    try:
        server = Server(("127.0.0.1", words.port), Page)
    except OSError:
        sys.exit("icesoc-live: error: cannot listen on 127.0.0.1: is the port taken? PORT=0 takes "
                 "any that is free")
    if not words.only_try:
        address = f"http://127.0.0.1:{server.server_address[1]}/"
        print(f"The vehicle: {address}#objects" if words.gateway
              else f"The mission as it runs: {address}", flush=True)
        server.serve_forever()


if __name__ == "__main__":
    main()
