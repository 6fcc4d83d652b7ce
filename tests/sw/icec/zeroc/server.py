#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""server: runs ZeroC's own server of a suite. Usage: server.py FOLDER SUITE ENCODING. Prints the
ports of its two adapters, and serves until `shutdown` is called."""
import os
import socket
import sys

import Ice

folder, suite, encoding = sys.argv[1:]
with socket.socket() as first, socket.socket() as second:
    for free in first, second:
        free.bind(("127.0.0.1", 0))
    ports = first.getsockname()[1], second.getsockname()[1]
os.chdir(os.path.join(folder, "Ice", suite))
sys.path[:0] = [".", folder]
import TestHelper  # noqa: E402


def createTestProperties(self, args=[], create=TestHelper.TestHelper.createTestProperties):
    made = create(self, list(args))
    made.setProperty("Ice.Default.EncodingVersion", encoding)
    # several threads, because an operation may call back
    made.setProperty("Ice.ThreadPool.Server.SizeMax", "3")
    return made


def waitForShutdown(self, wait=Ice.CommunicatorI.waitForShutdown):
    print(*ports, flush=True)
    wait(self)


Ice.CommunicatorI.waitForShutdown = waitForShutdown
TestHelper.TestHelper.createTestProperties = createTestProperties
TestHelper.TestHelper.getTestEndpoint = (
    lambda *_, num=0, **__: "tcp -h 127.0.0.1 -p %d" % (ports[num] if num < 2 else 0))
import Server  # noqa: E402
Server.Server().run([])
