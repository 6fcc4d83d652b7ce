#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Stock Ice for Python over the radio: threads, proxies, callbacks. Usage: client.py SLICE PLUGINS
ENDPOINT GUARD (PLUGINS '': none)"""

import sys
import threading

import Ice

slice_file, plugins, endpoint, guard = sys.argv[1:]
Ice.loadSlice("", [slice_file])
import RadioTest  # made by loadSlice


class Listener(RadioTest.Listener):
    def heard(self, number, current):
        return 2 * number


def pattern(number, size):
    return bytes((i * 7 + number * 31) & 0xFF for i in range(size))


def work(proxy, first, errors):
    try:
        for number in range(first, first + 10):
            data = pattern(number, 30 + number % 200)
            if bytes(proxy.repeat(number, data)) != data:
                errors.append(f"call {number}: a wrong answer")
    except Ice.Exception as error:
        errors.append(f"from {first}: {error}")


def main():
    options = [
        "--Ice.Default.InvocationTimeout=60000",
        "--Ice.ThreadPool.Client.Size=4",
    ]
    if plugins:
        options += [f"--Ice.Plugin.XBeeAT={plugins}/xbeeat:createXBeeAT", f"--XBeeAT.Guard={guard}"]
    errors = []
    with Ice.initialize(options) as communicator:
        proxy = RadioTest.UavPrx.uncheckedCast(communicator.stringToProxy("echo:" + endpoint))
        threads = [
            threading.Thread(target=work,
                             args=(proxy.ice_connectionId(str(n % 3)), 100 * n, errors))
            for n in range(6)
        ]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        adapter = communicator.createObjectAdapter("")
        adapter.add(Listener(), Ice.stringToIdentity("listener"))
        adapter.activate()
        proxy = proxy.ice_connectionId("0")
        proxy.ice_getConnection().setAdapter(adapter)
        if proxy.callBack(10) != 90:
            errors.append("callBack: a wrong sum")
        try:
            proxy.repeat(9999, bytes(9000))
            errors.append("9000 bytes passed")
        except (Ice.MemoryLimitException, Ice.UnknownLocalException):
            pass  # by the plugin; by the gateway
    for error in errors:
        print("client.py:", error, file=sys.stderr)
    return 1 if errors else 0


sys.exit(main())
