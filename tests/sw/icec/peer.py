#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""peer: stock ZeroC Ice in Python. `peer.py client [minimal] PORT`, `peer.py crowd PORT` or `peer.py server` (prints its port).

minimal: the server has IceC's minimal configuration."""

import os
import socket
import sys
import threading

import Ice

Ice.loadSlice("", [os.path.join(os.path.dirname(__file__), "Interop.ice")])
import Interop  # noqa: E402

CROWD = 20


class CallbackI(Interop.Callback):
    def __init__(self):
        self.event = threading.Event()
        self.percent = None

    def progress(self, percent, current):
        self.percent = percent
        self.event.set()


def expect(exception, function):
    try:
        function()
    except exception:
        return
    raise AssertionError("no " + exception.__name__)


def client(ic, port, minimal):
    where = ":tcp -h 127.0.0.1 -p " + port
    for encoding in ("1.1", "1.0"):
        base = ic.stringToProxy("service -e %s%s" % (encoding, where))
        service = Interop.ServicePrx.checkedCast(base)
        assert service
        service.ice_ping()
        if minimal:
            expect(Ice.OperationNotExistException, service.ice_id)
            expect(Ice.OperationNotExistException, service.ice_ids)
        else:
            assert service.ice_id() == "::Interop::Service"
            assert service.ice_ids() == ["::Ice::Object", "::Interop::Service"]
        assert service.ice_isA("::Interop::Service") and not service.ice_isA("::Interop::Other")
        for i in range(1000):
            assert service.add(i, -2 * i) == -i
        assert service.add(1, 2, {"context": "is tolerated"}) == 3
        items = [Interop.Item("n%d" % i, i - 3, Interop.Colour.valueOf(i % 3), i / 3.0) for i in range(20)]
        back, joined = service.reverse(items)
        assert back == items[::-1] and joined == "".join(i.name for i in items)
        for size in (0, 1, 254, 255, 256, 8000):
            data = bytes(i % 251 for i in range(size))
            assert bytes(service.echo(data)) == data, size
        expect(Ice.UnknownException, service.fail)
        nobody = Interop.ServicePrx.uncheckedCast(ic.stringToProxy("nobody" + where))
        expect(Ice.ObjectNotExistException, nobody.ice_ping)
        wrong = Interop.CallbackPrx.uncheckedCast(base)
        expect(Ice.OperationNotExistException, lambda: wrong.progress(1))
        missing = Ice.ObjectNotExistException if minimal else Ice.FacetNotExistException
        expect(missing, base.ice_facet("other").ice_ping)
        expect(Ice.ObjectNotExistException, base.ice_identity(Ice.Identity("service", "other")).ice_ping)
    before = service.notifications()
    oneway = Interop.ServicePrx.uncheckedCast(service.ice_oneway())
    for _ in range(10):
        oneway.notify("hello")
    if not minimal:
        batch = Interop.ServicePrx.uncheckedCast(service.ice_batchOneway())
        for _ in range(10):
            batch.notify("hello")
        batch.ice_flushBatchRequests()
    # batch and oneway proxies have connections of the same endpoint: order holds
    assert service.notifications() == before + (10 if minimal else 20), service.notifications()
    adapter = ic.createObjectAdapterWithEndpoints("Callback", "tcp -h 127.0.0.1")
    callback = CallbackI()
    proxy = Interop.CallbackPrx.uncheckedCast(adapter.add(callback, ic.stringToIdentity("callback")))
    adapter.activate()
    service.work(proxy)
    assert callback.event.wait(30) and callback.percent == 100
    # Garbage, and a client that leaves in mid-message, disturb nobody else.
    for rubbish in (b"GET / HTTP/1.0\r\n\r\n", b"IceP\x01\x00\x01\x00\x00\x00\xff\xff\xff\x7f", b"IceP\x01\x00"):
        s = socket.create_connection(("127.0.0.1", int(port)))
        s.sendall(rubbish)
        s.close()
    assert service.add(20, 22) == 42
    service.shutdown()
    expect(Ice.LocalException, service.ice_ping)
    print("peer: all calls as expected")


def crowd(port):
    """Many programs at once that stay connected: each is served, and served again."""
    where = "service:tcp -h 127.0.0.1 -p " + port
    failed = []

    def one(number):
        try:
            with Ice.initialize() as ic:
                service = Interop.ServicePrx.uncheckedCast(ic.stringToProxy(where))
                for i in range(3):
                    assert service.add(number, i) == number + i
                start.wait()  # all are there, and far more than the server has numbers for
                assert service.add(number, 1) == number + 1
        except (Ice.Exception, AssertionError) as e:
            failed.append("client %d: %r" % (number, e))
            start.abort()

    start = threading.Barrier(CROWD)
    threads = [threading.Thread(target=one, args=(i,)) for i in range(CROWD)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not failed, failed
    with Ice.initialize() as ic:
        Interop.ServicePrx.uncheckedCast(ic.stringToProxy(where)).shutdown()
    print("peer: %d clients at once were served" % CROWD)


class ServiceI(Interop.Service):
    def __init__(self):
        self.count = 0

    def add(self, a, b, current):
        return a + b

    def reverse(self, items, current):
        return items[::-1], "".join(i.name for i in items)

    def echo(self, data, current):
        return data

    def notify(self, text, current):
        self.count += text == "hello"

    def notifications(self, current):
        return self.count

    def fail(self, current):
        raise RuntimeError("as asked")

    def work(self, callback, current):
        pass

    def shutdown(self, current):
        current.adapter.getCommunicator().shutdown()


class LocatorI(Ice.Locator):
    """Like IceGrid's: knows the adapter by its name, and one object by itself."""

    def __init__(self, adapter):
        self.adapter = adapter

    def findAdapterById(self, name, current):
        if name != "Adapter":
            raise Ice.AdapterNotFoundException()
        return self.adapter.createDirectProxy(Ice.stringToIdentity("dummy"))

    def findObjectById(self, identity, current):
        if identity.name != "service":
            raise Ice.ObjectNotFoundException()
        return self.adapter.getCommunicator().stringToProxy("service @ Adapter")

    def getRegistry(self, current):
        return None


def server(ic):
    adapter = ic.createObjectAdapterWithEndpoints("Adapter", "tcp -h 127.0.0.1")
    adapter.add(ServiceI(), ic.stringToIdentity("service"))
    adapter.add(LocatorI(adapter), ic.stringToIdentity("locator"))
    adapter.activate()
    print(adapter.getPublishedEndpoints()[0].getInfo().port, flush=True)
    ic.waitForShutdown()


properties = Ice.createProperties()
properties.setProperty("Ice.Warn.Dispatch", "0")
data = Ice.InitializationData()
data.properties = properties
with Ice.initialize(data) as communicator:
    if sys.argv[1] == "client":
        client(communicator, sys.argv[-1], "minimal" in sys.argv)
    elif sys.argv[1] == "crowd":
        crowd(sys.argv[-1])
    else:
        server(communicator)
