#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""relay: stands between a client and a server on 127.0.0.1, prints its own port, runs until it is
killed."""
import argparse
import asyncio
import socket
import struct
import time

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--pcap",
                    help="every byte as TCP over IPv4, with openings and ends, as a capture would "
                         "hold it")
parser.add_argument("--cut", type=int,
                    help="bytes after which every connection ends without a word")
parser.add_argument("port", type=int, help="the server's")
words = parser.parse_args()
FIN, SYN, PSH, ACK = 1, 2, 8, 16


class Capture:
    """One TCP connection in the pcap file (LINKTYPE_IPV4); `side` 0: from the client."""
    file = open(words.pcap, "wb") if words.pcap else None

    def __init__(self, client):
        self.ports, self.sequence = (client, words.port), [1000, 2000]
        self.packet(0, SYN)
        self.packet(1, SYN | ACK)

    def packet(self, side, flags, data=b""):
        if not self.file:
            return
        hosts = [socket.inet_aton("127.0.0.1"), socket.inet_aton("127.0.0.2")]
        ip = struct.pack(">BBHIBBH4s4s", 0x45, 0, 40 + len(data), 0x4000, 64, socket.IPPROTO_TCP, 0,
                         hosts[side], hosts[1 - side])
        tcp = struct.pack(">HHIIBBHHH", self.ports[side], self.ports[1 - side], self.sequence[side],
                          self.sequence[1 - side],
                          0x50, flags, 0xFFFF, 0, 0)
        self.sequence[side] += len(data) + bool(flags & (SYN | FIN))
        packet = ip + tcp + data
        microseconds = time.time_ns() // 1000
        self.file.write(struct.pack("<IIII", microseconds // 10**6, microseconds % 10**6,
                                    len(packet), len(packet)) + packet)
        self.file.flush()


async def connection(reader, writer):
    """Passes bytes on from either side until one ends, or the bytes are through."""
    try:
        server_reader, server_writer = await asyncio.open_connection("127.0.0.1", words.port)
    except OSError:  # it listens no longer
        writer.close()
        return
    capture = Capture(writer.get_extra_info("peername")[1])
    passed = 0

    async def pump(side, source, target):
        nonlocal passed
        while data := await source.read(4096):
            passed += len(data)
            if words.cut and passed > words.cut:
                return
            capture.packet(side, PSH | ACK, data)
            target.write(data)
            await target.drain()
        capture.packet(side, FIN | ACK)

    pumps = [asyncio.ensure_future(pump(0, reader, server_writer)),
             asyncio.ensure_future(pump(1, server_reader, writer))]
    await asyncio.wait(pumps, return_when=asyncio.FIRST_COMPLETED)
    for pump_ in pumps:
        pump_.cancel()
    await asyncio.gather(*pumps, return_exceptions=True)
    writer.close()
    server_writer.close()


async def main():
    if Capture.file:
        Capture.file.write(struct.pack("<IIIIII", 0xA1B2C3D4, 0x00040002, 0, 0, 0xFFFF, 228))
    listener = await asyncio.start_server(connection, "127.0.0.1")
    print(listener.sockets[0].getsockname()[1], flush=True)
    await listener.serve_forever()


asyncio.run(main())
