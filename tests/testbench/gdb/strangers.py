#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""strangers: a peer that is no debugger is sent away, and one that leaves or talks nonsense makes room for the next.

Usage: strangers.py icesoc-sim firmware.elf out-folder
"""
import re
import socket
import subprocess
import sys

PATIENCE = 60  # seconds: ends a hang


def packet(text):
    return b"$%s#%02x" % (text, sum(text) & 255)


def main(sim, elf, out):
    command = [sim, "--image", "/usr/share/xplanet/images/earth.jpg", "--size", "96x64", "--cpu", "m3", "--firmware", elf, "--gdb", "0",
               "--speed", "max", "--out", out]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as simulator:
        try:
            port = next(int(found[1]) for found in (re.search(r"localhost:(\d+)", line) for line in simulator.stdout) if found)
            check(port)
            with socket.create_connection(("127.0.0.1", port), PATIENCE) as s:
                s.sendall(packet(b"k"))
                assert simulator.wait(PATIENCE) == 0
        finally:
            simulator.kill()


def check(port):
    def talk(*parts):
        """Returns the answer to these bytes, or b"" if the connection is ended."""
        with socket.create_connection(("127.0.0.1", port), PATIENCE) as s:
            answer = b""
            try:
                for part in parts:
                    s.sendall(part)
                while not re.search(rb"#..$", answer):
                    more = s.recv(1000)
                    if not more:
                        return b""
                    answer += more
            except ConnectionError:
                return b""
            return answer

    def leave(*parts):
        """Sends this, and disconnects."""
        with socket.create_connection(("127.0.0.1", port), PATIENCE) as s:
            for part in parts:
                s.sendall(part)
        assert talk(packet(b"?"))[:5] == b"+$T05", "the next one is not served after %r" % (parts[0][:20],)

    assert talk(b"POST / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n" + packet(b"k")) == b"", "a web page's request"
    assert talk(b"$" + b"m" * 100000) == b"", "a packet without an end"
    assert talk() == b"", "silence"
    for wrong in (b"m0,ffffffff", b"m", b"M0,5:00", b"M20000000,1:zz", b"pffffffffffffffff", b"P19"):
        assert b"E01" in talk(packet(wrong)), wrong
    go = packet(b"?") + packet(b"c")
    leave(go)
    leave(packet(b"?") + b"$c")
    leave(go, packet(b"g") * 100)
    leave(go, b"k" * 100000)  # while the processor runs
    leave(packet(b"?") + packet(b"s") * 50)
    leave(packet(b"D"))
    with socket.create_connection(("127.0.0.1", port), PATIENCE) as s:
        s.sendall(go)
    assert talk(b"GET /") == b"", "the processor runs, and a web page comes"


main(*sys.argv[1:])
