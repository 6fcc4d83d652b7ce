#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""call_server: a server of stock Ice with the object `try` of call.ice, for call_test.py. It prints
its port. Arguments are Ice properties, such as --Trial.AdapterId=uav7."""
import sys
import threading
import time
from pathlib import Path

import Ice

Ice.loadSlice("", [f"-I{Ice.getSliceDir()}", str(Path(__file__).with_name("call.ice"))])
import Trial  # noqa: E402


class Try(Trial.Try):
    def add(self, left, threshold, current=None):
        if left == 32766:
            raise Ice.UnknownException("::Ice::UnknownException: the servant failed")
        return left + threshold

    def big(self, small, middle, large, current=None):
        return small + middle + large

    def real(self, small, large, current=None):
        return small + large

    def flip(self, value, current=None):
        return not value

    def echo(self, text, current=None):
        return text

    def next(self, value, current=None):
        return Trial.Colour.blue, value.value

    def move(self, start, dx, current=None):
        return Trial.Point(start.x + dx, start.y)

    def turn(self, list, current=None):
        return list[::-1]

    def reverse(self, list, current=None):
        return list[::-1]

    def pixels(self, frame, current=None):
        return frame.width * frame.height * 1000 + len(frame.pixels)

    def negative(self, frame, current=None):
        return Trial.Picture(frame.width, frame.height,
                             bytes(255 - level for level in frame.pixels))

    def count(self, words, current=None):
        return {word: 2 * number for word, number in words.items()}

    def colours(self, map, current=None):
        return sum(point.x * colour.value for point, colour in map.items())

    def places(self, map, current=None):
        return map

    def maybe(self, value, current=None):
        return value

    def chain(self, first, current=None):
        return Trial.Leaf("leaf", first, first.weight if isinstance(first, Trial.Leaf) else 0)

    def _import(self, text, current=None):
        return text

    def fail(self, code, current=None):
        raise Trial.Overflow("too large", code, Trial.Colour.green)

    def refuse(self, current=None):
        raise ValueError("no reason")

    def unreachable(self, current=None):  # the answer of a gateway without a modem
        raise Ice.UnknownLocalException(
            "icesoc-gateway: cannot reach the vehicle: the modem is lost; see the log")

    def sleep(self, ms, current=None):
        time.sleep(ms / 1000)

    def context(self, name, current=None):
        return current.ctx.get(name, "") + current.facet

    def _self(self, other, current=None):
        return other

    def watch(self, listener, events, current=None):
        listener = listener.ice_fixed(current.con)

        def raise_events():
            for value in range(events):
                listener.peak(value, Trial.Colour.red)
            listener.finished()

        threading.Thread(target=raise_events, daemon=True).start()

    def nothing(self, current=None):
        pass


settings = ["call_server", "--Ice.ThreadPool.Server.Size=4", "--Ice.Warn.Dispatch=0",
            "--Trial.Endpoints=tcp -h 127.0.0.1", *sys.argv[1:]]
data = Ice.InitializationData()
data.properties = Ice.createProperties(settings)
data.properties.parseCommandLineOptions("Trial", settings)
with Ice.initialize(data) as communicator:
    adapter = communicator.createObjectAdapter("Trial")
    adapter.add(Try(), Ice.stringToIdentity("try"))
    adapter.addFacet(Try(), Ice.stringToIdentity("try"), "side")
    adapter.activate()
    info = adapter.getEndpoints()[0].getInfo()
    while info.underlying:
        info = info.underlying
    print(info.port, flush=True)
    sys.stdin.read()  # runs until the test closes standard input
