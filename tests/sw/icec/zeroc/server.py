#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""server: ZeroC's own server of a suite: server.py FOLDER SUITE ENCODING. Prints its port, serves until `shutdown`."""
import os
import socket
import sys

import Ice

folder, suite, encoding = sys.argv[1:]
with socket.socket() as free:
    free.bind(("127.0.0.1", 0))
    port = free.getsockname()[1]
os.chdir(os.path.join(folder, "Ice", suite))
sys.path[:0] = [".", folder]
import TestHelper  # noqa: E402


def createTestProperties(self, args=[], create=TestHelper.TestHelper.createTestProperties):
    made = create(self, list(args))
    made.setProperty("Ice.Default.EncodingVersion", encoding)
    return made


def waitForShutdown(self, wait=Ice.CommunicatorI.waitForShutdown):
    print(port, flush=True)
    wait(self)


Ice.CommunicatorI.waitForShutdown = waitForShutdown
TestHelper.TestHelper.createTestProperties = createTestProperties
TestHelper.TestHelper.getTestEndpoint = lambda *_, num=0, **__: "tcp -h 127.0.0.1 -p %d" % (0 if num else port)
import Server  # noqa: E402
Server.Server().run([])
