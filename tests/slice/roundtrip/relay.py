#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""relay: forwards connections from clients to a server on 127.0.0.1, prints its own port, and runs
until it is killed. Usage: relay.py PCAP PORT. It writes every byte to the file PCAP as TCP over
IPv4, with the start and end of each connection."""
import asyncio
import socket
import struct
import sys
import time

FIN, SYN, PSH, ACK = 1, 2, 8, 16
PORT = int(sys.argv[2])


class Capture:
    """One TCP connection in the pcap file (LINKTYPE_IPV4). `side` is 0 for bytes from the
    client."""
    file = open(sys.argv[1], "wb")
    file.write(struct.pack("<IIIIII", 0xA1B2C3D4, 0x00040002, 0, 0, 0xFFFF, 228))

    def __init__(self, client):
        self.ports, self.sequence = (client, PORT), [1000, 2000]
        self.packet(0, SYN)
        self.packet(1, SYN | ACK)

    def packet(self, side, flags, data=b""):
        hosts = [socket.inet_aton("127.0.0.1"), socket.inet_aton("127.0.0.2")]
        ip = struct.pack(">BBHIBBH4s4s", 0x45, 0, 40 + len(data), 0x4000, 64, socket.IPPROTO_TCP, 0,
                         hosts[side], hosts[1 - side])
        tcp = struct.pack(">HHIIBBHHH", self.ports[side], self.ports[1 - side], self.sequence[side],
                          self.sequence[1 - side], 0x50, flags, 0xFFFF, 0, 0)
        self.sequence[side] += len(data) + bool(flags & (SYN | FIN))
        packet = ip + tcp + data
        microseconds = time.time_ns() // 1000
        self.file.write(struct.pack("<IIII", microseconds // 10**6, microseconds % 10**6,
                                    len(packet), len(packet)) + packet)
        self.file.flush()


async def connection(reader, writer):
    """Forwards bytes in both directions until one side closes the connection."""
    try:
        server_reader, server_writer = await asyncio.open_connection("127.0.0.1", PORT)
    except OSError:  # the server no longer listens
        writer.close()
        return
    capture = Capture(writer.get_extra_info("peername")[1])

    async def pump(side, source, target):
        while data := await source.read(4096):
            capture.packet(side, PSH | ACK, data)
            target.write(data)
            await target.drain()
        capture.packet(side, FIN | ACK)
        target.close()

    await asyncio.gather(pump(0, reader, server_writer), pump(1, server_reader, writer),
                         return_exceptions=True)


async def main():
    listener = await asyncio.start_server(connection, "127.0.0.1")
    print(listener.sockets[0].getsockname()[1], flush=True)
    await listener.serve_forever()


asyncio.run(main())
