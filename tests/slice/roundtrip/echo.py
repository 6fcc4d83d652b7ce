#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""echo: the programs with stock ZeroC Ice on both sides of generated C code, which forwards calls.

echo.py generate SEED FOLDER     writes Random.ice, Hidden.ice and Definer.ice
echo.py server SEED FOLDER       returns the values that it receives; prints its port
echo.py client SEED FOLDER PORT  sends random values of every type, in both encodings, and compares
                                 them with the returned values
"""

import os
import sys

import Ice

from model import Model


def same(t, a, b, encoding, seen):
    """Returns True if two values are equal. In encoding 1.0 optional members are lost, so they are
    not compared."""
    if a is None or b is None:
        return a is None and b is None
    if t.kind == "sequence":
        if t.element.kind == "byte":
            return bytes(a) == bytes(b)
        return len(a) == len(b) and all(same(t.element, x, y, encoding, seen) for x, y in zip(a, b))
    if t.kind == "dictionary":
        return a.keys() == b.keys() and all(same(t.element, a[k], b[k], encoding, seen) for k in a)
    if t.kind == "struct":
        return all(same(ft, getattr(a, n), getattr(b, n), encoding, seen) for n, ft, _ in t.fields)
    if t.kind == "class":
        if id(a) in seen:
            # an instance that was sent in several places must be received as one instance
            return seen[id(a)] is b
        if type(a) is not type(b):
            return False
        seen[id(a)] = b
        t = next(d for d in model.declared if d.name == type(a).__name__)
        return members(t, a, b, encoding, seen)
    # encoding 1.0 does not transfer the encoding of a proxy
    if t.kind == "proxy" and encoding == "1.0":
        return a.ice_encodingVersion(Ice.Encoding_1_0) == b.ice_encodingVersion(Ice.Encoding_1_0)
    return a == b


def members(t, a, b, encoding, seen):
    for name, ft, tag in t.all_fields():
        x, y = getattr(a, name), getattr(b, name)
        if tag is not None and (x is Ice.Unset or encoding == "1.0"):
            if y is not Ice.Unset:
                return False
        elif not same(ft, x, y, encoding, seen):
            return False
    return True


class Members:
    """An object with the members of an exception as attributes."""


def check(what, ok, *values):
    if not ok:
        print("echo: seed %s: %s: what came back differs:" % (sys.argv[2], what))
        for v in values:
            print("  ", repr(v)[:2000])
        sys.exit(1)


def plain(echo, module, ic, encoding, form, i, t):
    budget = [40]
    v = model.value(t, module, ic, budget, [])
    result, w = getattr(echo, "plain%d%s" % (i, form))(v)
    what = "%s in %s, %s" % (t.slice(), encoding, form)
    check(what, same(t, v, result, encoding, {}) and same(t, v, w, encoding, {}), v, result, w)


def maybe(echo, module, ic, encoding, i, t):
    for v in (Ice.Unset, model.value(t, module, ic, [40], [])):
        result, w = getattr(echo, "maybe%d" % i)(v)
        what = "optional %s in %s" % (t.slice(), encoding)
        if v is Ice.Unset or encoding == "1.0":
            check(what, result is Ice.Unset and w is Ice.Unset, v, result, w)
        else:
            check(what, same(t, v, result, encoding, {}) and same(t, v, w, encoding, {}), v, result,
                  w)


def thrown(echo, module, ic, encoding, form, e):
    sent, graph = Members(), []
    for name, ft, tag in e.all_fields():
        unset = tag is not None and model.random.random() < 0.5
        setattr(sent, name, Ice.Unset if unset else model.value(ft, module, ic, [15], graph))
    values = [getattr(sent, name) for name, _, _ in e.all_fields()]
    try:
        getattr(echo, "raise%s%s" % (e.name, form))(*values)
        check(e.name, False, "nothing was thrown")
    except getattr(module, model.root(e).name) as got:
        what = "exception %s in %s, %s" % (e.name, encoding, form)
        check(what, type(got).__name__ == e.name and members(e, sent, got, encoding, {}),
              vars(sent), got)


def hide(v, t, module, ic, values):
    """Fills an instance of the class or exception Hidden..., which is derived from `t`, with random
    members. `values` limits the number of values in each member of `t`."""
    # members of the instance may refer to the instance itself
    graph = [(v, t)] if t.kind == "class" else []
    for name, ft, tag in t.all_fields():
        setattr(v, name, model.value(ft, module, ic, [values], graph))
    v.more, v.last = "unknown to C", Ice.Unset if model.random.random() < 0.5 else 5
    return graph


def same_hidden(t, v, got, encoding):
    """Returns True if `got` is the value that was sent. If slices are preserved, `got` must be
    unchanged; otherwise it must be reduced to the type `t`."""
    kept = t.preserves() and encoding == "1.1"
    if type(got).__name__ != ("Hidden" if kept else "") + t.name or not members(t, v, got, encoding,
                                                                                {id(v): got}):
        return False
    return not kept or (got.more, got.last) == (v.more, v.last)


def unknown(echo, module, ic, encoding, t):
    """Sends an instance of a type that the C side does not know. If the format does not contain the
    size of a slice, the instance must be rejected."""
    v = getattr(module, "Hidden" + t.name)()
    graph = hide(v, t, module, ic, 15)
    v.other = v.same = model.value(t, module, ic, [15], graph)
    i = model.types.index(t)
    if encoding == "1.1":
        try:
            getattr(echo, "plain%dCompact" % i)(v)
            check(t.name, False, "an unknown class in the compact format was taken")
        except Ice.UnknownLocalException:
            pass
    result, w = getattr(echo, "plain%dSliced" % i)(v)
    check(t.name, result is w)
    what = "%s of a derived type in %s" % (t.name, encoding)
    check(what, same_hidden(t, v, result, encoding), v, result)
    if type(result) is type(v):
        check(what, result.other is result.same
              and members(t, v, result, encoding, {id(v): result}), v, result)
        check(what, (result.other is result) == (v.other is v)
              and (v.other is None) == (result.other is None), v, result)


def lone(echo, module, encoding):
    """Sends a graph of a type that the C side does not know through a parameter of type Object; the
    graph must return unchanged."""
    first, second = module.Lone(1, None, "one"), module.Lone(2)
    first.next, second.next, first.any = second, first, second
    if encoding == "1.0":
        try:
            echo.any(first)
            check("Object", False, "an unknown class was taken in 1.0")
        except Ice.UnknownLocalException:
            return
    result, w = echo.any(first)
    check("Object", result is w and type(result) is module.Lone
          and (result.number, result.text) == (1, "one"), result)
    second = result.next
    check("Object", second.next is result and result.any is second
          and (second.number, second.text) == (2, Ice.Unset), result)
    check("Object", echo.any(None) == (None, None))


def declared(echo, module, encoding):
    """Sends an instance of a class that the operation's Slice file declares but does not define,
    and interfaces by value. The compact format forbids interface names that the receiver does not
    know; with encoding 1.0 Python returns no interfaces."""
    for form in ("Compact", "Sliced"):
        sent = module.Later(7)
        sent.next = sent
        for names in (["::T::Marker", "::T::Tag"], ["::T::Marker", "::T::SubTag"]):
            tags = [Ice.InterfaceByValue(n) if encoding == "1.1" else None for n in names]
            (got,), *back = getattr(echo, "declared" + form)(sent, *tags)
            check("declared in %s, %s" % (encoding, form), got.id == 7 and got.next is got
                  and [b is None for b in back] == [t is None for t in tags], got, back)


class Thrower:
    """An object that throws the exception `what` when the server forwards a call to it."""

    def forward(self, to, current):
        raise self.what


def forwarded(echo, module, ic, encoding, thrower, own, e):
    """Makes the server throw an exception of a type that the C side does not know; the C side must
    pass it on."""
    thrower.what = sent = getattr(module, "Hidden" + e.name)()
    hide(sent, e, module, ic, 15)
    sent.other = module.Lone(7)
    sent.other.next = sent.other
    try:
        getattr(echo, "forward" + e.name)(own)
        check(e.name, False, "nothing was thrown")
    except getattr(module, model.root(e).name) as got:
        what = "exception %s of a derived type in %s" % (e.name, encoding)
        check(what, same_hidden(e, sent, got, encoding), vars(sent), type(got), got)
        if type(got) is type(sent):
            check(what, got.other.number == 7 and got.other.next is got.other, got)


def raiser(module, e):
    def throw(self, *values):  # the last argument is the Current
        thrown = getattr(module, e.name)()
        for (name, _, _), value in zip(e.all_fields(), values):
            setattr(thrown, name, value)
        raise thrown
    return throw


def forwarder(module, e):
    def forward(self, to, current):
        getattr(module.EchoPrx.uncheckedCast(to), "forward" + e.name)(None)
    return forward


def server(module):
    """Serves an object that returns every value it receives, until `shutdown` is called."""
    def echo(self, v, current):
        return v, v

    def declared(self, v, m, t, current):
        return [v], m, t

    operations = {"any": echo, "shutdown": lambda self, current: ic.shutdown(),
                  "declaredCompact": declared, "declaredSliced": declared}
    for i, t in enumerate(model.types):
        names = ["plain%d%s" % (i, form) for form in model.formats(t)]
        operations.update((name, echo) for name in names + ["maybe%d" % i])
    for e in model.exceptions:
        for form in ("Compact", "Sliced"):
            operations["raise%s%s" % (e.name, form)] = raiser(module, e)
        operations["forward" + e.name] = forwarder(module, e)
    with communicator() as ic:
        adapter = ic.createObjectAdapterWithEndpoints("Echo", "tcp -h 127.0.0.1")
        adapter.add(type("Echoes", (module.Echo,), operations)(), Ice.stringToIdentity("echo"))
        square = {"area": lambda self, side, current: side * side,
                  "label": lambda self, current: "square"}
        adapter.add(type("Squares", (module.SquareDisp,), square)(), Ice.stringToIdentity("square"))
        adapter.activate()
        print(adapter.getEndpoints()[0].getInfo().port, flush=True)
        ic.waitForShutdown()


def communicator():
    data = Ice.InitializationData()
    data.properties = Ice.createProperties()
    for setting in "MessageSizeMax=64", "Warn.Dispatch=0":
        data.properties.setProperty(*("Ice." + setting).split("="))
    return Ice.initialize(data)


def client(module, port):
    calls = 0
    with communicator() as ic:
        names = {"forward" + e.name: Thrower.forward for e in model.exceptions}
        thrower = type("Throws", (Thrower, module.Echo), names)()
        adapter = ic.createObjectAdapterWithEndpoints("Thrower", "tcp -h 127.0.0.1")
        own = adapter.addWithUUID(thrower)
        adapter.activate()
        for encoding in ("1.1", "1.0"):
            def at(name):
                return ic.stringToProxy("%s -e %s:tcp -h 127.0.0.1 -p %s" % (name, encoding, port))

            echo = module.EchoPrx.uncheckedCast(at("echo"))
            square = module.SquarePrx.checkedCast(at("square"))
            check("a class that is called", square.area(3) == 9 and
                  module.LabelledPrx.checkedCast(square).label() == "square" and
                  square.ice_ids()[1:] == ["::T::Labelled", "::T::Named", "::T::Square"])
            for i, t in enumerate(model.types):
                for _ in range(12):
                    for form in model.formats(t):
                        plain(echo, module, ic, encoding, form, i, t)
                    maybe(echo, module, ic, encoding, i, t)
                    calls += 3
            for t in model.classes() * 6:
                unknown(echo, module, ic, encoding, t)
                calls += 1
            lone(echo, module, encoding)
            declared(echo, module, encoding)
            for e in model.exceptions:
                for form in ("Compact", "Sliced"):
                    for _ in range(12):
                        thrown(echo, module, ic, encoding, form, e)
                        calls += 1
                for _ in range(4):
                    forwarded(echo, module, ic, encoding, thrower, own, e)
                    calls += 1
        echo.shutdown()
    print("echo: seed %s: %d types, %d exceptions, %d values each came back as they went" % (
        sys.argv[2], len(model.types), len(model.exceptions), calls))


model = Model(sys.argv[2])
if sys.argv[1] == "generate":
    for name, hidden in (("Random.ice", False), ("Hidden.ice", True)):
        with open(os.path.join(sys.argv[3], name), "w") as f:
            f.write(model.slice_text(hidden))
    with open(os.path.join(sys.argv[3], "Definer.ice"), "w") as f:
        f.write(Model.DEFINER)
else:
    Ice.loadSlice("", [os.path.join(sys.argv[3], name) for name in ("Definer.ice", "Hidden.ice")])
    import T
    server(T) if sys.argv[1] == "server" else client(T, sys.argv[4])
