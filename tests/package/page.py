#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""page: calls a vehicle in the same way as the page of an installed gateway does in a browser: it
loads the page and its files, then calls uav.isAlive over a WebSocket with the origin and the cookie
of the page. It needs only Python.

Usage: page.py HOST:PORT    address of the gateway's option --page
"""
import json
import re
import socket
import struct
import sys
import urllib.request

origin = f"http://{sys.argv[1]}"


def load(path):
    """Returns the content of a file of the page."""
    with urllib.request.urlopen(origin + path, timeout=20) as answer:
        return answer.read()


def text(value):
    return bytes([len(value)]) + value.encode()


def read_frame(stream):
    """Returns the payload of a WebSocket frame. Frames from the gateway are not masked."""
    size = stream.read(2)[1]
    if size == 126:
        size, = struct.unpack(">H", stream.read(2))
    return stream.read(size)


with urllib.request.urlopen(origin, timeout=20) as page:
    cookie = page.headers["Set-Cookie"].split(";")[0]
    files = re.findall(r'(?:src|href)="([\w./]+\.(?:js|css))"', page.read().decode())
sizes = {file: len(load("/" + file.lstrip("/"))) for file in files}
print("page:", ", ".join(f"{file} {size} bytes" for file, size in sizes.items()))
described = json.loads(load("/objects"))
print("objects:", *(each["identity"] for each in described["objects"]))
print("shell:", described["command"])

host, port = re.fullmatch(r"ws -h (\S+) -p (\d+)", described["vehicles"][0]["browser"]).groups()
arguments = struct.pack("<h", 7)
body = (struct.pack("<i", 1) + text("uav") + b"\0\0" + text("isAlive") + b"\0\0"
        + struct.pack("<iBB", 6 + len(arguments), 1, 1) + arguments)
message = b"IceP\1\0\1\0\0\0" + struct.pack("<i", 14 + len(body)) + body
with socket.create_connection((host, int(port)), timeout=60) as connection:
    connection.sendall((
        f"GET / HTTP/1.1\r\nHost: {host}:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        "Sec-WebSocket-Protocol: ice.zeroc.com\r\nSec-WebSocket-Version: 13\r\n"
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
        f"Origin: {origin}\r\nCookie: {cookie}\r\n\r\n").encode())
    stream = connection.makefile("rb")
    while stream.readline().strip():
        pass  # skips the headers of the answer
    # A final binary frame with a mask of zeros.
    connection.sendall(bytes([0x82, 0x80 | len(message)]) + bytes(4) + message)
    reply = b""
    while reply[8:9] != b"\2":  # waits for a reply; the gateway first validates the connection
        reply = read_frame(stream)
# The header has 14 bytes. It is followed by request id, status, size and encoding of the results,
# and the result.
print("isAlive:", reply[14 + 4] == 0 and reply[-1] == 1)
