# SPDX-License-Identifier: MIT
"""live: web server for two pages. The page of a flight shows a mission in progress, on the loopback
interface only. The page of a gateway calls the gateway's vehicles; the installed program
icesoc-page serves it.

The page of a flight calls through this server (bridge.py). The page of a gateway calls the gateway
directly through ws or wss, as any other client does.

Each connection has a separate thread and one request. A slow, silent or endless client therefore
does not delay others, and is disconnected after PATIENCE seconds of silence.
"""

import sys


def refuse(kind, error, trace):
    """Prints an exception. If memory is exhausted, prints only a short message; Python may report
    this case as a library that cannot be loaded."""
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
import socket
import ssl
import threading
import time
import webbrowser
from http import HTTPStatus

import places

from icesoc.call import objects
from icesoc.util import chip
from icesoc.util.errors import Stop, reason_of
from icesoc.web import bridge, mission

HERE = os.path.dirname(os.path.abspath(__file__))

PATIENCE = 10  # seconds
FILES = {  # path -> MIME type, file
    "/": ("text/html; charset=utf-8", HERE + "/flight/index.html"),
    "/live.css": ("text/css", HERE + "/flight/live.css"),
    "/live.js": ("text/javascript", HERE + "/flight/live.js"),
    "/slice.js": ("text/javascript", HERE + "/flight/slice.js"),
    "/fields.js": ("text/javascript", HERE + "/flight/fields.js"),
    "/objects.js": ("text/javascript", HERE + "/flight/objects.js"),
    "/common.css": ("text/css", HERE + "/common.css"),
    "/common.js": ("text/javascript", HERE + "/common.js")}
# The page may load data only from its server, and no other page may embed it in a frame.
POLICY = ("connect-src 'self'%s; default-src 'self'; "
          "img-src 'self' data: blob:; style-src 'self' 'unsafe-inline'; "
          "worker-src blob:; "  # Ice for JavaScript uses a worker for its timers
          "frame-ancestors 'none'; base-uri 'none'; form-action 'none'")
COMMAND = "icesoc-call" if places.IS_INSTALLED else "./icesoc call"


def mark_viewed(folder, is_viewed=True):
    """Writes or removes the file from which the flight learns that a browser shows its page."""
    path = os.path.join(folder, objects.VIEWED)
    try:
        if not is_viewed:
            os.remove(path)
        elif not os.path.exists(path) or time.time() - os.stat(path).st_mtime > 1:
            with open(path, "w"):
                os.utime(path)
    except OSError:
        pass  # the folder was removed, or another request has already removed the file


def open_page(address, folder):
    """Opens the page in a browser. If the browser is still starting when the mission ends, the
    flight waits for it for some time (stay.py), because the file contains "opening"."""
    path = os.path.join(folder, objects.VIEWED)
    if folder:
        with open(path, "w") as file:
            file.write("opening")
    if not webbrowser.open(address) and folder:
        mark_viewed(folder, False)


class Vehicle:
    """A vehicle of a gateway, given as NAME=PROTOCOL:PORT in the form that the gateway passes."""

    def __init__(self, text):
        found = re.fullmatch(r"([^=]+)=(wss?):(\d{1,5})", text)
        if not found:
            raise argparse.ArgumentTypeError(f"expected NAME=ws:PORT, got '{text}'")
        self.name, self.protocol, self.port = found.groups()

    def policy(self, host):
        """Returns the addresses to which a page from `host` may connect. For wss they include
        https, because the page first sends a request by https; the browser then selects its
        certificate."""
        plain = {"ws": "http", "wss": "https"}[self.protocol]
        return f" {self.protocol}://{host}:{self.port} {plain}://{host}:{self.port}"


def gateway(folder):
    """Returns (host, port) of the gateway: the option --gateway, or the first vehicle of the
    flight; None if both are missing."""
    if Page.gateway:
        return Page.gateway
    live = objects.flight(folder)
    found = live and re.search(r"-h (\S+) -p (\d+)", next(iter(live.vehicles.values())))
    return (found[1], int(found[2])) if found else None


def described(build):
    """Returns the vehicle's objects, with the declarations of their interfaces."""
    try:
        catalogue = objects.Catalogue(build)
    except Stop as stop:
        return {"objects": [], "declarations": {}, "error": stop.text}
    return {"objects": [{"identity": each.identity, "interface": each.interface, "block": each.core}
                        for each in catalogue.objects.values() if each.interface],
            "declarations": catalogue.slices.declarations}


class Page(http.server.BaseHTTPRequestHandler):
    """A request for the page of a mission."""
    protocol_version, timeout = "HTTP/1.1", PATIENCE
    error_message_format, error_content_type = "%(code)d %(message)s\n", "text/plain"
    folder, slots, build, gateway = "", [], "", None
    names: tuple = ()  # names of this host
    vehicles: list = []  # vehicles of the gateway; empty for a flight
    secret = ""  # value of the cookie without which the gateway refuses calls from a browser
    is_https = False

    def do_GET(self):
        port = self.server.socket.getsockname()[1]
        hosts = self.headers.get_all("Host", [])
        # A request with another Host header may come from a page whose host name resolves to this
        # address (DNS rebinding).
        if len(hosts) != 1 or not self.is_own(hosts[0], port):
            return self.send_error(HTTPStatus.FORBIDDEN)
        path, _, query = self.path.partition("?")
        if path == "/closed":
            mark_viewed(self.folder, False)
            return self.send_error(HTTPStatus.NO_CONTENT)
        if path == "/ice" and not self.vehicles:
            return bridge.serve(self, hosts[0], query, gateway(self.folder))
        frame = self.folder + "/before.png" if path == "/frame.png" else ""
        if vehicle := re.fullmatch(r"/vehicle(\d{1,2})\.png", path):
            frame = mission.picture(self.folder, vehicle[1])
        kind, file = FILES.get(path, ("image/png", frame))
        if path == "/ice.js":
            kind, file = "text/javascript", self.build + "/page/ice.js"
        if path == "/state":
            mark_viewed(self.folder)
            kind = "application/json"
            content = json.dumps(mission.state(self.folder, self.slots)).encode()
        elif path == "/objects":
            kind, content = "application/json", json.dumps(
                self.described(hosts[0].rpartition(":")[0] or hosts[0])).encode()
        else:
            content = mission.contents(file)
        if path == "/":
            content = content.replace(b"%TOKEN%", bridge.TOKEN.encode())
            content = content.replace(b"%KIND%", b"vehicle" if self.vehicles else b"flight")
        if not content:
            return self.send_error(HTTPStatus.NOT_FOUND)
        self.send_response(HTTPStatus.OK)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(content)))
        host = hosts[0].rpartition(":")[0] or hosts[0]
        self.send_header("Content-Security-Policy", POLICY % "".join(
            vehicle.policy(host) for vehicle in self.vehicles))
        if self.vehicles and path == "/":
            self.send_header("Set-Cookie", f"icesoc-{port}={self.secret}; Path=/; HttpOnly; "
                             "SameSite=Strict" + "; Secure" * self.is_https)
        self.send_header("X-Content-Type-Options", "nosniff")
        self.send_header("Connection", "close")
        self.end_headers()
        self.wfile.write(content)

    def described(self, host):
        """Returns the vehicles, with the endpoints for the browser and for programs, and their
        objects."""
        port = self.server.socket.getsockname()[1]
        vehicles = [{"name": each.name, "tls": each.protocol == "wss", "port": each.port,
                     "browser": f"{each.protocol} -h {host} -p {each.port}",
                     "program": f"{each.protocol} -h {host} -p {each.port}"}
                    for each in self.vehicles]
        if not vehicles:
            address = gateway(self.folder) or ("127.0.0.1", 10000)
            vehicles = [{"name": "", "tls": False, "program": "tcp -h %s -p %s" % address,
                         "browser": f'ws -h {host} -p {port} -r "/ice?token={bridge.TOKEN}"'}]
        target = [f"--gateway '{vehicles[0]['program']}'"] if Page.gateway or self.vehicles else []
        return {**described(self.build), "vehicles": vehicles,
                "command": " ".join([COMMAND, *target])}

    def is_own(self, host, port):
        """Returns whether `host`, a Host header, names this server."""
        return any(host in (f"{name}:{port}", *([name] if port in (80, 443) else []))
                   for name in self.names)

    def log_message(self, *_):
        pass


class Server(http.server.ThreadingHTTPServer):
    request_queue_size = 128

    def handle_error(self, *_):
        # the error is ignored, because it only means that the client has closed the connection or
        # was silent for too long
        pass


def server_at(host, port, certificate, program):
    """Returns the server. With a certificate, it serves https."""
    kind = type("Server", (Server, ), {"address_family": socket.getaddrinfo(host, port)[0][0]})
    server = kind((host, port), Page)
    if certificate:
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
        try:
            context.load_cert_chain(certificate)
        except (OSError, ssl.SSLError):
            sys.exit(f"{program}: error: '{certificate}': expected a PEM file with a certificate "
                     "and its key")
        # The TLS handshake takes place in the thread of the connection.
        server.socket = context.wrap_socket(server.socket, server_side=True,
                                            do_handshake_on_connect=False)
    return server


def port_number(text):
    if not 0 <= (port := int(text)) <= 65535:
        raise argparse.ArgumentTypeError(f"expected a port from 0 to 65535, got {port}")
    return port


def place(text):
    host, _, port = text.rpartition(":")
    return host.strip("[]"), port_number(port)


def options(program, build):
    """Returns the parser of the command line. build: folder of the installed vehicle, which has no
    flights; None in the source tree."""
    def of_flight(text):
        return argparse.SUPPRESS if build else text

    parser = argparse.ArgumentParser(
        prog=program, description="Serves the page on which a browser calls the vehicles of a "
        "gateway; icesoc-gateway --page starts this program." if build else
        "Serves the page of a mission in progress, on 127.0.0.1.")
    parser.add_argument("--dir", default="", help=of_flight(
        "folder of the mission: status, calls.jsonl, before.png"))
    parser.add_argument("--build", default=build, help=of_flight(
        "build folder of the vehicle; its gen/chip.json describes the slots and objects"))
    parser.add_argument("--vehicle", type=Vehicle, action="append", default=[],
                        help="NAME=ws:PORT or NAME=wss:PORT: a vehicle of the gateway; can be "
                        "repeated")
    parser.add_argument("--listen", type=place, help="HOST:PORT at which the page is served; the "
                        "address in the browser must contain this HOST; default: 127.0.0.1, and "
                        "the port of --port")
    parser.add_argument("--certificate", help="PEM file with certificate and key, for https")
    parser.add_argument("--gateway", type=place, help=of_flight(
        "HOST:PORT of a gateway to call instead of the gateway of the flight"))
    parser.add_argument("--port", type=port_number, default=0, help="port; default: any free port")
    parser.add_argument("--open", action="store_true", help="open the page in a browser")
    parser.add_argument("--try", dest="only_try", action="store_true",
                        help="only check whether the page can be served")
    return parser


def main(program="icesoc-live", build=None):
    parser = options(program, build)
    words = parser.parse_args()
    if not words.vehicle and not (words.dir and words.build):
        parser.error("--vehicle is required" if build else
                     "the arguments --dir and --build are required for the page of a flight")
    host, port = words.listen or ("127.0.0.1", words.port)
    Page.names = ("127.0.0.1", "localhost", "[::1]") if host in ("127.0.0.1", "localhost", "::1") \
        else (f"[{host}]" if ":" in host else host, )
    Page.folder, Page.gateway, Page.vehicles = words.dir, words.gateway, words.vehicle
    Page.secret = os.environ.get("ICESOC_PAGE_SECRET", "")
    Page.is_https = bool(words.certificate)
    try:
        Page.slots = mission.blocks_by_slot(words.build) if words.dir else []
        Page.build = words.build
    except (OSError, ValueError) as error:
        sys.exit(f"{program}: error: cannot read '{words.build}/{chip.FILE}': "
                 + (getattr(error, "strerror", None) or reason_of(error)))
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: os._exit(0))
    try:
        server = server_at(host, port, words.certificate, program)
    except OSError as error:
        sys.exit(f"{program}: error: cannot listen on {host}: {error.strerror or error}: the port "
                 "may be in use; port 0 selects a free one")
    if not words.only_try:
        shown = f"[{host}]" if ":" in host else host
        address = f"http{'s' if words.certificate else ''}://{shown}:{server.server_address[1]}/"
        print(f"The vehicle: {address}#objects" if words.gateway or words.vehicle
              else f"The mission as it runs: {address}", flush=True)
        if words.open:
            threading.Thread(target=open_page, args=(address, words.dir), daemon=True).start()
        server.serve_forever()


if __name__ == "__main__":
    main()
