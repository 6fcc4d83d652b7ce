#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""messages: compares how IceC and stock Ice react to hostile and unusual messages: which operations
they execute, what they reply, and whether they close the connection.

usage: messages.py PROGRAM ECHO_ICE
       messages.py --serve ECHO_ICE     (the stock server)"""
import concurrent.futures
import socket
import struct
import subprocess
import sys
import threading
import time

HEAD = b"IceP\1\0\1\0"
# Time-outs, s, for each reply. The wait begins after a call on a second connection has been
# answered. On a loaded machine QUICK may be too short, so messages that cause different reactions
# are sent again with PATIENT.
QUICK, PATIENT = 0.3, 10
PAIRS = 6  # number of pairs of servers; while one pair waits for a time-out, the other pairs work


def size(n):
    return bytes([n]) if n < 255 else b"\xff" + struct.pack("<i", n)


def string(s):
    s = s if isinstance(s, bytes) else s.encode()
    return size(len(s)) + s


def number(n):
    return struct.pack("<i", n)


def message(kind, body, compression=0, head=HEAD):
    return head + bytes([kind, compression]) + number(14 + len(body)) + body


def encapsulation(p, version=(1, 1), more=0):
    return number(6 + len(p) + more) + bytes(version) + p


def target(op, name="echo", mode=0, category="", facet=b"\0", context=b"\0"):
    return string(name) + string(category) + facet + string(op) + bytes([mode]) + context


def request(op, params=b"", rid=1, version=(1, 1), more=0, **where):
    return message(0, number(rid) + target(op, **where) + encapsulation(params, version, more))


def one(op, params=b""):  # Returns a request for a batch.
    return target(op) + encapsulation(params)


def tag(n, form):
    return bytes([n << 3 | form]) if n < 30 else bytes([30 << 3 | form]) + size(n)


N7, HI = number(7), tag(5, 5) + string("hi")
COUNT = request("count", string("ab"))
NODE = b"\1\x21" + string("::Stock::Node") + N7 + b"\0"  # marker of an instance, flags, one slice

CASES = {
    "a call": COUNT,
    "a batch of 2": message(1, number(2) + one("hit") * 2),
    "a batch that promises 3 and has 2": message(1, number(3) + one("hit") * 2),
    "a batch that promises 1 and has 2": message(1, number(1) + one("hit") * 2),
    "a batch of 2^31-1": message(1, number(2**31 - 1) + one("hit") * 2),
    "a batch of -1": message(1, number(-1) + one("hit") * 2),
    "a batch of 0": message(1, number(0)),
    "a batch of -2^31": message(1, number(-2**31) + one("hit")) + COUNT,
    "a batch and more bytes": message(1, number(2) + one("hit") * 2 + b"zz") + COUNT,
    "a batch with an unknown object": message(1, number(3) + one("hit") + target("hit", "no")
                                              + encapsulation(b"") + one("hit")) + COUNT,
    "a batch with an unknown operation": message(1, number(3) + one("hit") + one("no")
                                                 + one("hit")) + COUNT,
    "a batch with a wrong parameter": message(1, number(3) + one("hit") + one("count", b"\xff")
                                              + one("hit")) + COUNT,
    "a batch with encoding 2.0": message(1, number(3) + one("hit") + target("hit")
                                         + encapsulation(b"", (2, 0)) + one("hit")) + COUNT,
    "a batch with a cut second request": message(1, number(2) + one("hit") + one("hit")[:-3]),
    "no optional": request("say", N7),
    "an optional": request("say", N7 + HI),
    "an unknown optional before it": request("say", N7 + tag(3, 2) + N7 + HI),
    "an unknown optional after it": request("say", N7 + HI + tag(40, 5) + string("zz")),
    "an unknown optional alone": request("say", N7 + tag(9, 0) + b"x"),
    "an unknown optional of 4 bytes and a size": request(
        "say", N7 + HI + tag(300, 6) + number(3) + b"abc"),
    "an unknown optional that is cut": request("say", N7 + HI + tag(9, 3) + b"abc"),
    "tag 31": request("say", N7 + HI + bytes([31 << 3 | 2]) + N7),
    "tag 31 before tag 5": request("say", N7 + bytes([31 << 3]) + b"\1" + HI),
    "bytes after the end mark": request("say", N7 + b"\xffjunk"),
    "the end mark alone": request("say", N7 + b"\xff"),
    "a tag with another format": request("say", N7 + tag(5, 2) + N7),
    "a tag twice": request("say", N7 + HI + HI),
    "tags in the wrong order": request("say", N7 + tag(9, 0) + b"x" + HI),
    "optionals in 1.0": request("say", N7 + HI, version=(1, 0)),
    "a string with a zero": request("count", string(b"a\0b")),
    "a size of -1": request("count", b"\xff" + number(-1)),
    "a size of 2^31-1": request("count", b"\xff" + number(2**31 - 1)),
    "a size of 2 in five bytes": request("count", b"\xff" + number(2) + b"ab"),
    "a parameter too many": request("count", string("ab") + b"zz"),
    "a byte too many in 1.0": request("count", string("ab") + b"z", version=(1, 0)),
    "two bytes too many in 1.0": request("count", string("ab") + b"zz", version=(1, 0)),
    "an optional too many": request("count", string("ab") + tag(1, 2) + N7),
    "an optional too many, and a byte": request("count", string("ab") + tag(1, 2) + N7 + b"\xff"),
    "no parameter": request("count"),
    "parameters of an operation without": request("hit", b"zz"),
    "parameters of an operation without, in 1.0": request("hit", b"zz", version=(1, 0)),
    "an optional of an operation without": request("hit", tag(1, 2) + N7),
    "a sequence": request("sum", size(2) + N7 + N7),
    "a sequence that is cut": request("sum", size(2) + N7 + b"ab"),
    "a sequence and more": request("sum", size(2) + N7 + N7 + b"a"),
    "a sequence of 2^31-1": request("sum", b"\xff" + number(2**31 - 1)),
    "a sequence of 2^29": request("sum", b"\xff" + number(2**29) + N7 * 9),
    "a dictionary": request("pairs", N7 + string("x") + size(1) + string("k") + N7),
    "a dictionary that is cut": request("pairs", N7 + string("x") + size(2) + string("k") + N7),
    "an enumerator": request("colour", b"\2\1"),
    "an enumerator over the last": request("colour", b"\3\1"),
    "an enumerator of five bytes": request("colour", b"\xff" + number(1) + b"\1"),
    "a bool of 2": request("colour", b"\1\2"),
    "no instance": request("walk", b"\0"),
    "an instance": request("walk", NODE),
    "an instance and more": request("walk", NODE + b"z"),
    "an instance without the mark of its last slice": request("walk", b"\1\1" + NODE[2:]),
    "an index of an instance in a compact value": request("walk", b"\5"),
    "an instance of an unknown class": request("walk", b"\1\x21" + string("::No") + N7 + b"\0"),
    "an instance in 1.0 that is missing": request("walk", number(-1), version=(1, 0)),
    "encoding 1.2": request("count", string("ab"), version=(1, 2)),
    "encoding 2.0": request("count", string("ab"), version=(2, 0)),
    "encoding 1.2 without parameters": request("hit", version=(1, 2)),
    "a size of the encapsulation beyond the message": request("count", string("ab"), more=9),
    "a size of the encapsulation of 5": request("count", string("ab"), more=-4),
    "a size of the encapsulation of -1": request("count", string("ab"), more=-10),
    "an encapsulation that ends early": request("count", string("ab"), more=-1),
    "bytes after the encapsulation": message(0, COUNT[14:] + b"zz"),
    "a message size of 13": HEAD + b"\0\0" + number(13),
    "a message size of -1": HEAD + b"\0\0" + number(-1),
    "a message size of 14, a request": HEAD + b"\0\0" + number(14),
    "a request that is cut in its identity": message(0, number(1) + b"\7ec"),
    "a request that is cut in its context": message(0, COUNT[14:32]) + COUNT,
    "a request that is cut in its encapsulation": message(0, COUNT[14:-3]) + COUNT,
    "a request without an encapsulation": message(0, number(1) + target("hit")) + COUNT,
    "another magic": b"IceQ" + COUNT[4:],
    "protocol 1.1": message(0, COUNT[14:], head=b"IceP\1\1\1\0"),
    "protocol 2.0": message(0, COUNT[14:], head=b"IceP\2\0\1\0"),
    "protocol 2.0 and a size of 2^24": b"IceP\2\0\1\0\0\0" + number(2**24) + COUNT[14:],
    "encoding 1.1 of the protocol": message(0, COUNT[14:], head=b"IceP\1\0\1\1"),
    "compression offered": message(0, COUNT[14:], 1),
    "compression of 3": message(0, COUNT[14:], 3),
    "compression of 255": message(0, COUNT[14:], 255),
    "a message size of 0": HEAD + b"\0\0" + number(0) + COUNT,
    "a message size of 2^31-1": HEAD + b"\0\0" + number(2**31 - 1) + COUNT[14:],
    "a message that never ends": HEAD + b"\0\0" + number(200) + COUNT[14:],
    "half a head": COUNT[:9],
    "a line of HTTP": b"GET / HTTP/1.1\r\n\r\n",
    "zeros": b"\0" * 100,
    "a validation with a body": message(3, b"xx") + COUNT,
    "a validation, then a call": message(3, b"") + COUNT,
    "an unexpected reply": message(2, number(77) + b"\0" + encapsulation(b"")) + COUNT,
    "a reply without an id": message(2, b"") + COUNT,
    "a reply that is cut in its id": message(2, b"\1\0\0") + COUNT,
    "a reply that is cut after its id": message(2, number(77)) + COUNT,
    "a reply of an unknown status": message(2, number(77) + b"\x09") + COUNT,
    "a type of 9": message(9, b"") + COUNT,
    "a type of 128": message(128, b"") + COUNT,
    "a mode of 3": request("count", string("ab"), mode=3),
    "an idempotent call of another operation": request("count", string("ab"), mode=2),
    "a nonmutating call of another operation": request("count", string("ab"), mode=1),
    "a normal call of an idempotent operation": request("same", b"\1"),
    "a nonmutating call of an idempotent operation": request("same", b"\1", mode=1),
    "an empty identity": request("count", string("ab"), name=""),
    "an identity that is missing": request("count", string("ab"), name="missing"),
    "another category": request("count", string("ab"), category="c"),
    "a facet that is missing": request("count", string("ab"), facet=b"\1" + string("f")),
    "an empty facet": request("count", string("ab"), facet=b"\1\0"),
    "two facets": request("count", string("ab"), facet=b"\2" + string("a") + string("b")),
    "an operation that is missing": request("nothing"),
    "an empty operation": request(""),
    "an operation in another case": request("Count", string("ab")),
    "a context": request("count", string("ab"), context=b"\1" + string("k") + string("v")),
    "a context that is cut": request("count", string("ab"), context=b"\2" + string("k")),
    "a key twice in a context": request("hit", context=b"\2" + (string("k") + string("v")) * 2),
    "ice_ping": request("ice_ping"),
    "ice_ping with parameters": request("ice_ping", b"zz"),
    "ice_ping with parameters in 1.0": request("ice_ping", b"zz", version=(1, 0)),
    "ice_isA": request("ice_isA", string("::Stock::Echo")),
    "ice_isA and more": request("ice_isA", string("::Stock::Echo") + b"z"),
    "ice_isA without": request("ice_isA"),
    "ice_ids": request("ice_ids", mode=1),
    "ice_id and more": request("ice_id", b"z"),
    "ice_ping as idempotent": request("ice_ping", mode=2),
    "ice_ping of a missing facet": request("ice_ping", facet=b"\1" + string("f")),
    "a one-way call that is missing": request("nothing", rid=0) + COUNT,
    "a one-way call of a missing object": request("hit", rid=0, name="missing") + COUNT,
    "a one-way call of a missing facet": request("hit", rid=0, facet=b"\1" + string("f")) + COUNT,
    "a one-way call of two facets": request("hit", rid=0, facet=b"\2" + string("a") * 2) + COUNT,
    "a one-way call in encoding 2.0": request("hit", rid=0, version=(2, 0)) + COUNT,
    "a facet of size -1": request("hit", facet=b"\xff" + number(-1)) + COUNT,
    "a context of size -1": request("hit", context=b"\xff" + number(-1)) + COUNT,
    "a context of size 2^31-1": request("hit", context=b"\xff" + number(2**31 - 1)) + COUNT,
    "an encapsulation as a parameter": request("count", encapsulation(string("ab"))),
    "an identity with a zero": request("hit", name=b"echo\0") + COUNT,
    "an operation with a zero": request("hit\0") + COUNT,
    "a missing operation in encoding 2.0": request("no", version=(2, 0)),
    "a missing object in encoding 2.0": request("hit", name="no", version=(2, 0)),
    "encoding 0.0": request("hit", version=(0, 0)),
    "encoding 1.255": request("count", string("ab"), version=(1, 255)),
    "a mode of 8": request("hit", mode=8),
    "a mode of 128": request("hit", mode=128),
    "a mode of 130": request("same", b"\1", mode=130),
    "a mode of 255": request("hit", mode=255),
    "a one-way call with too much": request("count", string("ab") + b"z", rid=0) + COUNT,
    "a negative request id": request("hit", rid=-5),
    "two calls with one id": request("hit") + request("hit"),
    "a close, then a call": message(4, b"") + COUNT,
}

# Messages to which IceC and stock Ice react differently, on purpose or because of a fault in stock
# Ice: (replies of IceC, number of executed operations, reason).
FAILED = [(2, b"\x01\0\0\0\x05"), "open"], 0  # UnknownLocalException
CLOSED = [""], 0
ANSWERED = [(2, number(1) + b"\0" + encapsulation(number(2))), "open"],  # by COUNT
IN_PYTHON = "stock Ice in Python has another exception, or none; in C++ it has this one"
MALFORMED = "a malformed message closes the connection: nothing after it can be trusted"
LIMIT = "IceC answers a request that is too long, and skips it; stock Ice closes the connection"
ENCODING = "IceC checks the encoding of every request, before it looks for object and operation"
COMPRESSED = "IceC refuses all values but 0 and 1, so that the caller may repeat the call"
DIFFERENT = {
    "a request that is cut in its context": (*CLOSED, MALFORMED),
    "a request that is cut in its encapsulation": (*CLOSED, MALFORMED),
    "a request without an encapsulation": (*CLOSED, MALFORMED),
    "a message size of 2^31-1": ([(2, b"\x01\0\0\0\x05"), "open"], 0, LIMIT),
    "compression of 3": ([(4, b""), ""], 0, COMPRESSED),
    "compression of 255": ([(4, b""), ""], 0, COMPRESSED),
    "an instance without the mark of its last slice": (*FAILED, "IceC checks the mark"),
    "a batch with a cut second request": ([""], 1, MALFORMED),
    "a size of the encapsulation beyond the message": (*CLOSED, MALFORMED),
    "a size of the encapsulation of 5": (*CLOSED, MALFORMED),
    "a size of the encapsulation of -1": (*CLOSED, MALFORMED),
    "parameters of an operation without, in 1.0": (*FAILED, IN_PYTHON),
    "a sequence of 2^31-1": (*FAILED, IN_PYTHON),
    "a sequence of 2^29": (*FAILED, IN_PYTHON),
    "an index of an instance in a compact value": (*FAILED, "stock Ice in Python dies"),
    "an instance of an unknown class": (*FAILED, "stock Ice in Python dies"),
    "encoding 1.2 without parameters": (*FAILED, "stock Ice executes it, and fails to answer"),
    "encoding 0.0": (*FAILED, "stock Ice executes it, and fails to answer"),
    "a one-way call in encoding 2.0": (*ANSWERED, 1, ENCODING),
    "a batch with encoding 2.0": (*ANSWERED, 3, ENCODING),
    "a missing operation in encoding 2.0": (*FAILED, ENCODING),
    "a missing object in encoding 2.0": (*FAILED, ENCODING),
    "an operation with a zero": ([(2, b"\x01\0\0\0\x04\4echo\0\0\4hit\0"), *ANSWERED[0]], 1,
                                 "stock Ice in Python reads a name up to the zero"),
}


class Server:
    def __init__(self, command):
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                                        text=True)
        self.port = int(self.process.stdout.readline())
        self.executed = 0
        threading.Thread(target=self.listen, daemon=True).start()

    def listen(self):
        for _ in self.process.stdout:
            self.executed += 1

    def connect(self):
        s = socket.create_connection(("127.0.0.1", self.port), 60)
        s.settimeout(60)
        read(s, 14)
        return s

    def ask(self, data, timeout):
        """Sends messages. Returns the replies and the number of executed operations. timeout:
        longest wait for each reply, s; the wait begins when the messages have been handled."""
        before = self.executed
        s = self.connect()
        s.sendall(data)
        # when a call on this connection has been answered, all earlier messages have been handled
        other = self.connect()
        other.sendall(COUNT)
        read(other, 25)
        other.close()
        answers = []
        s.settimeout(timeout)
        while True:
            head = read(s, 14)
            if len(head) < 14:
                answers.append(head.decode() if head in (b"", b"open") else "cut")
                break
            body = read(s, struct.unpack("<i", head[10:])[0] - 14)
            status = body[4] if head[8] == 2 else 0
            answers.append((head[8], body[:5] if status > 4 else body))
        s.close()
        # gives the server's last line about an executed operation time to arrive
        time.sleep(timeout / 6)
        return answers, self.executed - before - 1


def read(s, n):
    data = b""
    while len(data) < n:
        try:
            more = s.recv(n - len(data))
        except socket.timeout:
            return data or b"open"
        except ConnectionError:
            return b""
        if not more:
            return b""
        data += more
    return data


def serve(ice):
    import Ice
    Ice.loadSlice(ice)
    import Stock

    def note():
        print("executed", flush=True)

    class Echo(Stock.Echo):
        def say(self, text, n, current=None):
            note()
            return text

        def count(self, s, current=None):
            note()
            return len(s)

        def hit(self, current=None):
            note()

        def sum(self, values, current=None):
            note()
            return len(values)

        def pairs(self, first, names, current=None):
            note()
            return len(names)

        def colour(self, c, b, current=None):
            note()
            return c.value

        def walk(self, first, current=None):
            note()
            return first.value if first else 0

        def same(self, b, current=None):
            note()
            return b

    options = ["--Ice.Warn.Dispatch=0", "--Ice.Warn.Connections=0"]
    with Ice.initialize(options) as ic:
        adapter = ic.createObjectAdapterWithEndpoints("A", "tcp -h 127.0.0.1")
        adapter.add(Echo(), Ice.stringToIdentity("echo"))
        adapter.activate()
        print(adapter.getEndpoints()[0].getInfo().port, flush=True)
        ic.waitForShutdown()


def compare(names):
    """Sends these messages to both servers. Returns one line for each difference that is not
    expected."""
    stock_words = [sys.executable, __file__, "--serve", sys.argv[2]]
    ours, stock, wrong = Server([sys.argv[1]]), Server(stock_words), []
    for name in names:
        for timeout in QUICK, PATIENT:
            mine = ours.ask(CASES[name], timeout)
            try:
                theirs = stock.ask(CASES[name], timeout)
            except OSError:  # the server crashed on this message
                theirs = "died", 0
                stock.process.kill()
                stock = Server(stock_words)
            expected = DIFFERENT.get(name, theirs)[:2]
            if mine == expected:
                break
        else:
            wrong.append(f"{name}: expected {expected}, got {mine}")
    for server in ours, stock:
        server.process.kill()
    return wrong


def main():
    if sys.argv[1] == "--serve":
        return serve(sys.argv[2])
    names = list(CASES)
    with concurrent.futures.ThreadPoolExecutor(PAIRS) as pool:
        parts = pool.map(compare, [names[first::PAIRS] for first in range(PAIRS)])
        wrong = [line for part in parts for line in part]
    print("\n".join([*wrong, f"{len(CASES)} messages, {len(wrong)} differ"]))
    return bool(wrong)


if __name__ == "__main__":
    sys.exit(main())
