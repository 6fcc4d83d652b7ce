# SPDX-License-Identifier: MIT
"""bridge: connects the WebSocket of a page to a TCP port of Ice, so that the browser is a stock Ice
client of the gateway.

Ice's WebSocket transport does not check the origin of a page. Any page that the user visits could
therefore call a gateway that listens for WebSockets. Here, a connection must have three properties:
its Host header names this server, which prevents DNS rebinding; its origin is the page of this
server; and it has the token of the page, which a page of another origin cannot read.
"""
import base64
import hashlib
import hmac
import secrets
import socket
import struct
import threading
from http import HTTPStatus

PROTOCOL = "ice.zeroc.com"
MAGIC = "258EAFA5-E914-47DA-95CA-C5AB0DC85B11"  # constant of RFC 6455, section 1.3
MOST_BYTES = 1 << 20  # longest frame, bytes; equals the longest message of Ice
MOST_CONNECTIONS = 16
TOKEN = secrets.token_hex(16)
CONTINUATION, TEXT, BINARY, CLOSE, PING, PONG = 0, 1, 2, 8, 9, 10

_free = threading.BoundedSemaphore(MOST_CONNECTIONS)


class Ended(Exception):
    """The connection has ended, or the browser has violated the protocol."""


def refusal(headers, query, host):
    """Returns the reason if a connection must be refused, otherwise an empty text. host: the Host
    header of the request, which do_GET has already checked."""
    if headers.get_all("Origin", []) != [f"http://{host}"]:
        return "a page of another origin"
    if not hmac.compare_digest(query.encode(), f"token={TOKEN}".encode()):
        return "a wrong token"
    if headers.get("Upgrade", "").lower() != "websocket" or not headers.get("Sec-WebSocket-Key"):
        return "no WebSocket"
    return ""


def exactly(stream, count):
    data = stream.read(count)
    if len(data) != count:
        raise Ended
    return data


def read_frame(stream):
    """Reads a masked frame from the browser. Returns (opcode, payload without the mask)."""
    first, second = exactly(stream, 2)
    size = second & 0x7F
    if size == 126:
        size, = struct.unpack(">H", exactly(stream, 2))
    elif size == 127:
        size, = struct.unpack(">Q", exactly(stream, 8))
    if first & 0x70 or not second & 0x80 or size > MOST_BYTES:
        raise Ended
    mask = exactly(stream, 4)
    data = exactly(stream, size)
    repeated = mask * (size // 4) + mask[:size % 4]
    plain = int.from_bytes(data, "big") ^ int.from_bytes(repeated, "big")
    return first & 0x0F, plain.to_bytes(size, "big")


def frame(opcode, data):
    """Returns an unmasked frame."""
    size = len(data)
    head = bytes([0x80 | opcode, size]) if size < 126 else \
        struct.pack(">BBH", 0x80 | opcode, 126, size) if size < 1 << 16 else \
        struct.pack(">BBQ", 0x80 | opcode, 127, size)
    return head + data


def accept(handler):
    """Answers the request for a WebSocket."""
    key = handler.headers["Sec-WebSocket-Key"] + MAGIC
    handler.send_response(HTTPStatus.SWITCHING_PROTOCOLS)
    handler.send_header("Upgrade", "websocket")
    handler.send_header("Connection", "Upgrade")
    handler.send_header("Sec-WebSocket-Accept",
                        base64.b64encode(hashlib.sha1(key.encode()).digest()).decode())
    handler.send_header("Sec-WebSocket-Protocol", PROTOCOL)
    handler.end_headers()
    handler.wfile.flush()
    handler.close_connection = True


def serve(handler, host, query, address):
    """Serves a request for a WebSocket. address: (host, port) of the gateway, or None."""
    if refusal(handler.headers, query, host):
        return handler.send_error(HTTPStatus.FORBIDDEN)
    if not address:
        return handler.send_error(HTTPStatus.SERVICE_UNAVAILABLE)
    if not _free.acquire(blocking=False):
        return handler.send_error(HTTPStatus.TOO_MANY_REQUESTS)
    try:
        with socket.create_connection(address, timeout=10) as gateway:
            accept(handler)
            handler.connection.settimeout(None)
            gateway.settimeout(None)
            exchange(handler, gateway)
    except OSError:
        pass  # one of the two sides has closed its connection
    finally:
        _free.release()
    return None


def exchange(handler, gateway):
    """Passes bytes in both directions until one side closes its connection."""
    browser, sending = handler.connection, threading.Lock()

    def send(opcode, data):
        with sending:
            browser.sendall(frame(opcode, data))

    def to_browser():
        try:
            while data := gateway.recv(1 << 16):
                send(BINARY, data)
            send(CLOSE, struct.pack(">H", 1000))
        except OSError:
            pass
        finally:
            shut(browser)

    answers = threading.Thread(target=to_browser, daemon=True)
    answers.start()
    try:
        while True:
            opcode, data = read_frame(handler.rfile)
            if opcode in (BINARY, CONTINUATION):
                gateway.sendall(data)
            elif opcode == PING:
                send(PONG, data)
            elif opcode != PONG:
                break
    except (Ended, OSError):
        pass
    finally:
        shut(gateway)
        shut(browser)
        answers.join(5)


def shut(connection):
    try:
        connection.shutdown(socket.SHUT_RDWR)
    except OSError:
        pass
