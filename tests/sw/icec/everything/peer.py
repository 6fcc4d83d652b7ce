#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""peer: stock ZeroC Ice in Python for Everything.ice.

peer.py client [slow] PORT|ENDPOINT   every operation against the server on PORT; `slow`: fewer, smaller calls
peer.py lost PORT            a connection that is cut: calls fail cleanly and the next ones work
peer.py server               prints its port
peer.py strings              reads proxies, prints what Ice makes of them, and their bytes in 1.1 and 1.0
"""

import os
import sys

import Ice

Ice.loadSlice("", ["-I" + os.path.dirname(__file__), os.path.join(os.path.dirname(__file__), "Everything.ice")])
import Everything as E  # noqa: E402


def expect(exception, function):
    try:
        function()
    except exception as e:
        return e
    raise AssertionError("no " + exception.__name__)


def numbers(i=1):
    return E.Numbers(True, 200, -3 * i, 1 << 30, -(1 << 62) + i, 0.5, -1e300)


class WatcherI(E.Watcher):
    def progress(self, percent, current):
        pass

    def ask(self, question, current):
        return 10 * question


def client(ic, port, slow):
    where = port if port.startswith(":") else ":tcp -h 127.0.0.1 -p " + port
    for encoding in ("1.1", "1.0"):
        base = ic.stringToProxy("tester -e %s%s" % (encoding, where))
        t = E.TesterPrx.checkedCast(base)
        version = Ice.EncodingVersion(1, int(encoding[2]))  # 1.0 does not carry a proxy's own

        def sent(proxy):
            return proxy.ice_encodingVersion(version) if proxy else None

        assert t and t.ice_ids() == ["::Everything::Tester", "::Ice::Object"]
        n = numbers()
        assert t.echoNumbers(n) == (n, n)
        prx = ic.stringToProxy("cat/other -f facet -o:tcp -h 127.0.0.1 -p 9:opaque -t 99 -e 1.0 -v QUI=")
        own = base if ":tcp" in where else prx  # an xbee-at endpoint leaves device and baud behind
        m = E.Mixed("text \u00e9", E.Small.two, E.Wide.far, n, prx)
        back = t.echoMixed(m)
        m.proxy = sent(prx)
        assert back == m, back
        for p in (None, prx, own, ic.stringToProxy("x @ adapter"), ic.stringToProxy("y -s"),
                  ic.stringToProxy("z:udp -h 127.0.0.1 -p 7"), ic.stringToProxy("s:ssl -h 127.0.0.1 -p 8:ws -h h -p 9")):
            assert t.echoProxy(p) == sent(p), (p, t.echoProxy(p))
        assert t.echoProxies([prx, None, own]) == [sent(prx), None, sent(own)]
        mixeds = [E.Mixed("n%d" % i, E.Small.valueOf([0, 5, 6][i % 3]), E.Wide.near, numbers(i), None) for i in range(4)]
        assert t.echoMixeds(mixeds) == (mixeds, 4)
        assert t.echoCounts({"a": 1, "b": -2}) == {"a": 1, "b": -2}
        assert t.echoLists({1: ["one"], 2: []}) == {1: ["one"], 2: []}
        for size in (0, 254, 255, 256, 1000) if slow else (0, 1, 254, 255, 256, 4000, 8000, 8092):
            data = bytes(i % 251 for i in range(size))
            assert t.echoBytes(data) == data, size
        # Longer than a message may be: the server closes, and lives.
        if not slow:
            expect(Ice.LocalException, lambda: t.echoBytes(bytes(9000)))
        if encoding == "1.1":
            assert t.echoOptionals(5, "a", n, [1, 2, 3]) == (5, "a", n, [1, 2, 3])
            assert t.echoOptionals(0, Ice.Unset, Ice.Unset, Ice.Unset) == (Ice.Unset,) * 4
            assert t.echoOptionals(1, Ice.Unset, n, Ice.Unset) == (1, Ice.Unset, n, Ice.Unset)
        else:
            assert t.echoOptionals(5, "a", n, [1]) == (Ice.Unset,) * 4
        assert t.echoNode(None) is None
        leaf = E.Leaf(2, None, "leaf")
        leaf.weight = 9 if encoding == "1.1" else Ice.Unset
        first = E.Node(1, leaf)
        leaf.next = first  # a cycle
        got = t.echoNode(first)
        assert got.id == 1 and got.next.name == "leaf" and got.next.next is got and got.next.weight == leaf.weight
        t.fail(0)
        e = expect(E.Failure, lambda: t.fail(1))
        assert type(e) is E.Failure and e.reason == "as asked"
        for call in (t.fail, t.failSliced):
            e = expect(E.Worse, lambda: call(2))
            assert e.reason == "worse" and e.how == 7
        e = expect(E.Unrelated, lambda: t.fail(3))
        assert e.counts == {"key": -1} and e.hint is Ice.Unset
        e = expect(E.Unrelated, lambda: t.fail(4))
        assert e.hint == ("hint" if encoding == "1.1" else Ice.Unset)
        for how, exception in ((11, Ice.ObjectNotExistException), (12, Ice.FacetNotExistException),
                               (13, Ice.OperationNotExistException), (15, Ice.UnknownException),
                               (16, Ice.UnknownLocalException), (20, Ice.UnknownException),
                               (22, Ice.UnknownLocalException), (23, Ice.UnknownUserException)):
            e = expect(exception, lambda: t.fail(how))
            if how < 15:
                assert e.id.name == "tester" and e.operation == "fail"
        # An idempotent operation called as a normal one is refused.
        ok, _ = False, None
        try:
            ok, _ = t.ice_invoke("echoNumbers", Ice.OperationMode.Normal, b"\x06\0\0\0\x01" + bytes([int(encoding[2])]))
            assert False
        except Ice.UnknownLocalException:
            pass
        assert t.context("who", {"a": "b", "who": "me"}) == "me" and t.context("who") == "-"
        perProxy = E.TesterPrx.uncheckedCast(t.ice_context({"who": "proxy"}))
        assert perProxy.context("who") == "proxy"
        side = E.TesterPrx.checkedCast(base, "side")
        assert side.whoAmI() == "/tester -f side mode 0", side.whoAmI()
        other = E.TesterPrx.uncheckedCast(base.ice_identity(Ice.Identity("whoever", "any")))
        assert other.whoAmI() == "any/whoever -f  mode 0"
        expect(Ice.FacetNotExistException, base.ice_facet("none").ice_ping)
        expect(Ice.ObjectNotExistException, base.ice_identity(Ice.Identity("none", "")).ice_ping)
        # Compressed requests are refused; the connection is closed in good order.
        compressed = E.TesterPrx.uncheckedCast(t.ice_compress(True).ice_connectionId("z%s" % encoding))
        if not slow:
            expect(Ice.CloseConnectionException, lambda: compressed.echoBytes(bytes(4000)))
        assert t.echoBytes(b"still there") == b"still there"

    # Asynchronous calls, answered later and in the reverse order; others are served meanwhile.
    futures = [t.laterAsync(v) for v in (1, 2, -3, 4)]
    assert t.echoBytes(b"meanwhile") == b"meanwhile"
    assert t.release() == 4
    assert [futures[i].result() for i in (0, 1, 3)] == [2, 4, 8]
    expect(E.Failure, futures[2].result)
    # The servant calls back before it answers.
    adapter = ic.createObjectAdapterWithEndpoints("Watcher", "tcp -h 127.0.0.1")
    watcher = E.WatcherPrx.uncheckedCast(adapter.addWithUUID(WatcherI()))
    adapter.activate()
    if not slow:
        assert t.callBack(watcher, 5) == 100
    # A class that is called, and its base and what it implements.
    square = E.SquarePrx.checkedCast(ic.stringToProxy("square" + where))
    assert square.ice_ids() == ["::Everything::" + n for n in ("Labelled", "Named", "Shape", "Square")] + ["::Ice::Object"]
    assert square.ice_id() == "::Everything::Square" and not E.TesterPrx.checkedCast(square)
    side = square.grow(0)
    assert square.grow(2) == side + 2 and square.area(3) == 3 * (side + 2) ** 2
    assert E.LabelledPrx.checkedCast(square).label() == "square"
    e = expect(E.Failure, lambda: E.ShapePrx.checkedCast(square).area(-1))
    assert e.reason == "negative"
    # One-way, batches.
    before = t.sum()
    oneway = E.TesterPrx.uncheckedCast(t.ice_oneway())
    batch = E.TesterPrx.uncheckedCast(t.ice_batchOneway())
    for i in range(20):
        oneway.note(i)
        batch.note(1000)
    batch.ice_flushBatchRequests()
    assert t.sum() == before + 190 + 20000, t.sum()
    for i in range(5 if slow else 1000):
        assert t.echoNumbers(n)[0] == n
    if ":tcp" in where:  # a vehicle is not shut down: who would close the connection with us?
        t.shutdown()
    print("peer: everything as expected")


def lost(ic, port):
    """The relay cuts every connection after some bytes; a call either answers or fails as lost."""
    t = E.TesterPrx.uncheckedCast(ic.stringToProxy("tester:tcp -h 127.0.0.1 -p " + port).ice_invocationTimeout(60000))
    answered = failed = 0
    for i in range(60):
        try:
            assert len(t.echoBytes(bytes(200))) == 200
            answered += 1
        except (Ice.ConnectionLostException, Ice.CloseConnectionException):
            failed += 1
    assert answered >= 20 and failed >= 3, (answered, failed)
    while True:  # the connection of the good-bye may be cut as well
        try:
            t.shutdown()
            break
        except (Ice.ConnectionLostException, Ice.CloseConnectionException):
            pass
        except Ice.ConnectFailedException:
            break
    print("peer: %d calls answered, %d lost with their connection" % (answered, failed))


class TesterI(E.Tester):
    def __init__(self):
        self.total = 0
        self.waiting = []

    def echoNumbers(self, v, current):
        return v, v

    def echoMixed(self, v, current):
        return v

    def echoMixeds(self, v, current):
        return v, len(v)

    def echoOptionals(self, required, a, b, c, current):
        return required if required else Ice.Unset, a, b, c

    def fail(self, how, current):
        if how == 1:
            raise E.Failure("as asked")
        if how == 2:
            raise E.Worse("worse", 7)
        if how == 3:
            raise E.Unrelated({"key": -1})
        if how == 4:
            raise E.Unrelated({"key": -1}, "hint")
        if how == 11:
            raise Ice.ObjectNotExistException(Ice.Identity("n", "c"), "f", "op")
        if how == 12:
            raise Ice.FacetNotExistException(Ice.Identity("n", "c"), "f", "op")
        if how == 13:
            raise Ice.OperationNotExistException(Ice.Identity("n", "c"), "f", "op")
        if how == 15:
            raise RuntimeError("as asked")
        if how == 16:
            raise Ice.MarshalException("as asked")

    failSliced = fail

    def context(self, key, current):
        return current.ctx.get(key, "-")

    def whoAmI(self, current):
        return "%s/%s -f %s mode %d" % (current.id.category, current.id.name, current.facet, current.mode.value)

    def callBack(self, watcher, times, current):
        # Over the caller's own connection: it may listen nowhere.
        bound = E.WatcherPrx.uncheckedCast(current.con.createProxy(watcher.ice_getIdentity()))
        return sum(bound.ask(i) for i in range(times))

    def later(self, v, current):
        future = Ice.Future()
        self.waiting.append((v, future))
        return future

    def release(self, current):
        n = len(self.waiting)
        for v, future in reversed(self.waiting):
            if v < 0:
                future.set_exception(E.Failure("negative"))
            else:
                future.set_result(2 * v)
        self.waiting = []
        return n

    def note(self, v, current):
        self.total += v

    def sum(self, current):
        return self.total

    def shutdown(self, current):
        current.adapter.getCommunicator().shutdown()


for name in ("echoBytes", "echoCounts", "echoLists", "echoProxy", "echoProxies", "echoNode"):
    setattr(TesterI, name, lambda self, v, current: v)


class SquareI(E.SquareDisp):
    side = 0

    def label(self, current):
        return "square"

    def area(self, scale, current):
        if scale < 0:
            raise E.Failure("negative")
        return scale * self.side ** 2

    def grow(self, by, current):
        self.side += by
        return Ice.Future.completed(self.side)


class OlderI(E.Older):
    def echoOptionals(self, required, a, current):
        return required


def server(ic):
    adapter = ic.createObjectAdapterWithEndpoints("Adapter", "tcp -h 127.0.0.1")
    servant = TesterI()
    adapter.add(servant, ic.stringToIdentity("tester"))
    adapter.addFacet(servant, ic.stringToIdentity("tester"), "side")
    adapter.add(SquareI(), ic.stringToIdentity("square"))
    adapter.add(OlderI(), ic.stringToIdentity("older"))
    adapter.addDefaultServant(servant, "any")
    adapter.activate()
    print(adapter.getPublishedEndpoints()[0].getInfo().port, flush=True)
    ic.waitForShutdown()


class Bytes(Ice.Blobject):
    """Answers with the parameters, and keeps them: what is in their encapsulation."""

    def ice_invoke(self, parameters, current):
        self.last = bytes(parameters)[6:]
        return True, parameters


def strings(ic):
    adapter = ic.createObjectAdapterWithEndpoints("Adapter", "tcp -h 127.0.0.1")
    servant = Bytes()
    sink = E.TesterPrx.uncheckedCast(adapter.addWithUUID(servant))
    adapter.activate()
    for line in sys.stdin:
        try:
            proxy = ic.stringToProxy(line.rstrip("\n"))
            print(ic.proxyToString(proxy))
            for encoding in Ice.Encoding_1_1, Ice.Encoding_1_0:
                sink.ice_encodingVersion(encoding).echoProxy(proxy)
                print(servant.last.hex())
        except Ice.LocalException:
            print("refused")


data = Ice.InitializationData()
data.properties = Ice.createProperties()
for key, value in (("Ice.Warn.Dispatch", "0"), ("Ice.Warn.Connections", "0"), ("Ice.RetryIntervals", "-1"),
                   ("Ice.ThreadPool.Server.Size", "4"), ("Ice.ThreadPool.Client.Size", "2"),
                   ("Ice.Plugin.IceSSL", "IceSSL:createIceSSL")):
    data.properties.setProperty(key, value)
with Ice.initialize(sys.argv, data) as communicator:
    role = sys.argv[1]
    if role == "client":
        client(communicator, sys.argv[-1], "slow" in sys.argv)
    else:
        {"lost": lambda: lost(communicator, sys.argv[2]), "server": lambda: server(communicator),
         "strings": lambda: strings(communicator)}[role]()
