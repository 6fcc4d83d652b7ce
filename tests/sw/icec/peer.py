#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""peer: stock ZeroC Ice in Python for Interop.ice.

peer.py client WHAT PORT|ENDPOINT   full: every operation, to a bridge; minimal: what that run time
                                    has; slow: fewer and smaller calls, over the radio
peer.py crowd PORT                  many programs at once
peer.py server                      prints its port
"""

import os
import socket
import sys
import threading

import Ice

Ice.loadSlice("", [os.path.join(os.path.dirname(__file__), "Interop.ice")])
import Interop  # noqa: E402

CROWD = 20  # far more than the server has numbers for
# By Ice_Status of IceC, which says of some more only that they are others.
FAILURES = {2: Ice.ObjectNotExistException, 3: Ice.FacetNotExistException,
            4: Ice.OperationNotExistException, 5: Ice.UnknownLocalException,
            6: Ice.UnknownUserException, 7: Ice.UnknownException, 8: Ice.UnknownLocalException,
            9: Ice.UnknownLocalException, 10: Ice.UnknownException, 13: Ice.UnknownException}


class CallbackI(Interop.Callback):
    def __init__(self):
        self.event = threading.Event()
        self.percent = None

    def progress(self, percent, current):
        self.percent = percent
        self.event.set()

    def ask(self, question, current):
        return 10 * question


def expect(exception, function, *arguments):
    try:
        function(*arguments)
    except exception as e:
        return e
    raise AssertionError("no " + exception.__name__)


def calls(base, minimal, slow):
    """Calls what both run times serve, in the proxy's encoding."""
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
    for i in range(5 if slow else 1000):
        assert service.add(i, -2 * i) == -i
    assert service.add(1, 2, {"context": "is tolerated"}) == 3
    items = [Interop.Item("n%d" % i, i - 3, Interop.Colour.valueOf(i % 3), i / 3.0)
             for i in range(20)]
    assert service.reverse(items) == (items[::-1], "".join(i.name for i in items))
    for size in (0, 254, 255, 256, 1000) if slow else (0, 1, 254, 255, 256, 4000, 8000, 8092):
        data = bytes(i % 251 for i in range(size))
        assert bytes(service.echo(data)) == data, size
    service.fail(0)
    e = expect(Interop.Failure, service.fail, 1)
    assert e.reason == "as asked"
    for status, exception in FAILURES.items():
        if minimal and status == 3:
            continue
        e = expect(exception, service.fail, status)
        if status <= 4:
            assert e.id.name == "service" and e.operation == "fail"
    expect(Ice.ObjectNotExistException, base.ice_identity(Ice.Identity("nobody", "")).ice_ping)
    wrong = Interop.CallbackPrx.uncheckedCast(base)
    expect(Ice.OperationNotExistException, wrong.progress, 1)
    missing = Ice.ObjectNotExistException if minimal else Ice.FacetNotExistException
    expect(missing, base.ice_facet("other").ice_ping)
    other = base.ice_identity(Ice.Identity("service", "other"))
    expect(Ice.ObjectNotExistException, other.ice_ping)


def oneways(service, minimal):
    expected = 10 if minimal else 20
    before = service.notifications()
    oneway = Interop.ServicePrx.uncheckedCast(service.ice_oneway())
    for _ in range(10):
        oneway.notify("hello")
    if not minimal:
        batch = Interop.ServicePrx.uncheckedCast(service.ice_batchOneway())
        for _ in range(10):
            batch.notify("hello")
        batch.ice_flushBatchRequests()
    while service.notifications() < before + expected:  # a server's threads may be overtaken
        pass
    assert service.notifications() == before + expected


def limits(base, encoding):
    """Sends what is refused: the caller learns it, and the next call works."""
    service = Interop.ServicePrx.uncheckedCast(base)
    # Longer than a message may be, in each of its parts: the limit is named.
    large = base.ice_identity(Ice.Identity(10000 * "x", ""))
    context = {"entry %d" % i: "a value" for i in range(1000)}
    for call in (lambda: service.echo(bytes(9000)), large.ice_ping,
                 lambda: base.ice_ping(context)):
        e = expect(Ice.UnknownLocalException, call)
        assert "ICE_MESSAGE_MAX (8192)" in e.unknown, e.unknown
    # An idempotent operation called as a normal one.
    none = b"\x06\0\0\0\x01" + bytes([int(encoding[2])])
    expect(Ice.UnknownLocalException, service.ice_invoke, "add", Ice.OperationMode.Normal, none)
    # A compressed request; the connection is closed in good order.
    compressed = service.ice_compress(True).ice_connectionId("z" + encoding)
    compressed = Interop.ServicePrx.uncheckedCast(compressed)
    expect(Ice.CloseConnectionException, compressed.echo, bytes(4000))
    assert service.echo(b"still there") == b"still there"


def full(ic, where, encoding):
    """Calls what only the full run time serves, at the bridge as at the server behind it."""
    base = ic.stringToProxy("tester -e %s%s" % (encoding, where))
    t = Interop.TesterPrx.checkedCast(base)
    assert t.context("who", {"a": "b", "who": "me"}) == "me" and t.context("who") == "-"
    with_context = Interop.TesterPrx.uncheckedCast(t.ice_context({"who": "proxy"}))
    assert with_context.context("who") == "proxy"
    side = Interop.TesterPrx.checkedCast(base, "side")
    assert side.whoAmI() == "/tester -f side mode 0", side.whoAmI()
    other = Interop.TesterPrx.uncheckedCast(base.ice_identity(Ice.Identity("whoever", "any")))
    assert other.whoAmI() == "any/whoever -f  mode 0"
    expect(Ice.FacetNotExistException, base.ice_facet("none").ice_ping)
    # Asynchronous calls, answered in the reverse order; others are served meanwhile.
    sent = (1, "a"), (2, Ice.Unset), (-3, "c")
    futures = [t.laterAsync(Interop.Node(number), text) for number, text in sent]
    assert t.context("meanwhile") == "-"
    released = 0
    while released < 3:  # the calls may overtake each other
        released += t.release()
    for future, (number, text) in zip(futures[:2], sent):
        node, same = future.result()
        assert node.id == number and node.next is node
        assert same == (text if encoding == "1.1" else Ice.Unset)
    e = expect(Interop.Worse, futures[2].result)
    assert e.reason == "negative" and e.how == 7
    # The servant calls back before it answers.
    adapter = ic.createObjectAdapterWithEndpoints("Callback" + encoding, "tcp -h 127.0.0.1")
    callback = Interop.CallbackPrx.uncheckedCast(adapter.addWithUUID(CallbackI()))
    adapter.activate()
    base.ice_getConnection().setAdapter(adapter)
    assert t.callBack(callback, 5) == 100
    for text in ("x @ adapter", "y -s", "u:udp -h h -p 7", "s:ssl -h h -p 8:ws -h h -p 9",
                 "cat/o -f f -o:tcp -h 127.0.0.1 -p 9:opaque -t 99 -e 1.0 -v QUI="):
        proxy = ic.stringToProxy(text)  # 1.0 does not carry a proxy's own encoding
        sent = proxy.ice_encodingVersion(base.ice_getEncodingVersion())
        assert t.same(text, proxy, "")[1] == sent, text
    # A class that is called, and what it implements.
    square = Interop.SquarePrx.checkedCast(ic.stringToProxy("square" + where))
    names = ["::Ice::Object"] + ["::Interop::" + n for n in ("Labelled", "Named", "Square")]
    assert square.ice_ids() == names and square.ice_id() == names[-1]
    assert not Interop.TesterPrx.checkedCast(square)
    assert square.area(3) == 9 and Interop.LabelledPrx.checkedCast(square).label() == "square"
    assert expect(Interop.Failure, square.area, -1).reason == "negative"


def client(ic, what, port):
    where = port if port.startswith(":") else ":tcp -h 127.0.0.1 -p " + port
    for encoding in ("1.1", "1.0"):
        base = ic.stringToProxy("service -e %s%s" % (encoding, where))
        calls(base, what == "minimal", what == "slow")
        if what == "full":
            full(ic, where, encoding)
            limits(base, encoding)
    service = Interop.ServicePrx.checkedCast(base)
    oneways(service, what == "minimal")
    if what == "slow":  # a vehicle is not shut down: who would close the connection with us?
        print("peer: all calls as expected")
        return
    adapter = ic.createObjectAdapterWithEndpoints("Callback", "tcp -h 127.0.0.1")
    callback = CallbackI()
    proxy = Interop.CallbackPrx.uncheckedCast(adapter.addWithUUID(callback))
    adapter.activate()
    if what == "full":
        service.ice_getConnection().setAdapter(adapter)
    service.work(proxy)
    assert callback.event.wait(30) and callback.percent == 100
    # Garbage, and a client that leaves in mid-message, disturb nobody else.
    for rubbish in (b"GET / HTTP/1.0\r\n\r\n", b"IceP\x01\x00\x01\x00\x00\x00\xff\xff\xff\x7f",
                    b"IceP\x01\x00"):
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
    programs = [Ice.initialize() for _ in range(CROWD)]
    services = [Interop.ServicePrx.uncheckedCast(ic.stringToProxy(where)) for ic in programs]
    for i in range(4):
        futures = [service.addAsync(number, i) for number, service in enumerate(services)]
        for number, future in enumerate(futures):
            assert future.result() == number + i
    services[0].shutdown()
    for ic in programs:
        ic.destroy()
    print("peer: %d clients at once were served" % CROWD)


def bound(callback, current):
    """Returns a proxy over the caller's own connection: it may listen nowhere."""
    return Interop.CallbackPrx.uncheckedCast(
        current.con.createProxy(callback.ice_getIdentity()))


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

    def fail(self, status, current):
        if status == 1:
            raise Interop.Failure("as asked")
        if 2 <= status <= 4:
            raise FAILURES[status](Ice.Identity("n", "c"), "f", "op")
        if status:
            raise FAILURES[status]("as asked")

    def work(self, callback, current):
        bound(callback, current).progressAsync(100)

    def shutdown(self, current):
        current.adapter.getCommunicator().shutdown()


class TesterI(Interop.Tester):
    def __init__(self):
        self.waiting = []

    def context(self, key, current):
        return current.ctx.get(key, "-")

    def whoAmI(self, current):
        return "%s/%s -f %s mode %d" % (current.id.category, current.id.name, current.facet,
                                        current.mode.value)

    def callBack(self, callback, times, current):
        return sum(bound(callback, current).ask(i) for i in range(times))

    def later(self, v, text, current):
        self.waiting.append((v, text, Ice.Future()))
        return self.waiting[-1][2]

    def release(self, current):
        waiting, self.waiting = self.waiting, []
        for node, text, future in reversed(waiting):
            node.next = node
            if node.id < 0:
                future.set_exception(Interop.Worse("negative", 7))
            else:
                future.set_result((node, text))
        return len(waiting)

    def same(self, text, proxy, printed, current):
        ic = current.adapter.getCommunicator()
        try:
            own = ic.stringToProxy(text)
        except Ice.LocalException:
            return not printed, proxy
        carried = own
        if current.encoding == Ice.Encoding_1_0:  # it does not carry a proxy's own
            carried = own.ice_encodingVersion(current.encoding)
        return proxy == carried and printed == ic.proxyToString(own), proxy


class OlderI(Interop.Older):
    def skip(self, required, text, current):
        return text


class SquareI(Interop.SquareDisp):
    def label(self, current):
        return "square"

    def area(self, side, current):
        if side < 0:
            raise Interop.Failure("negative")
        return side * side


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
    tester = TesterI()
    for name, servant in (("service", ServiceI()), ("tester", tester), ("square", SquareI()),
                          ("older", OlderI()), ("locator", LocatorI(adapter))):
        adapter.add(servant, ic.stringToIdentity(name))
    adapter.addFacet(tester, ic.stringToIdentity("tester"), "side")
    adapter.addDefaultServant(tester, "any")
    adapter.activate()
    print(adapter.getPublishedEndpoints()[0].getInfo().port, flush=True)
    ic.waitForShutdown()


data = Ice.InitializationData()
data.properties = Ice.createProperties()
for setting in ("Warn.Dispatch=0", "Warn.Connections=0", "RetryIntervals=-1",
                "ThreadPool.Server.Size=4", "ThreadPool.Client.Size=2",
                "Plugin.IceSSL=IceSSL:createIceSSL"):
    data.properties.setProperty(*("Ice." + setting).split("="))
with Ice.initialize(sys.argv, data) as communicator:
    if sys.argv[1] == "client":
        client(communicator, sys.argv[2], sys.argv[-1])
    elif sys.argv[1] == "crowd":
        crowd(sys.argv[2])
    else:
        server(communicator)
