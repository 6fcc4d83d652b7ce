#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""call_test: tests ./icesoc call with a server of stock Ice instead of a flight: values of all
types, including hostile ones, options, exit statuses, events, completion.

Usage: call_test.py case build-folder
"""
import contextlib
import importlib.util
import io
import json
import os
import re
import resource
import socket
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path
from unittest import mock

from script import LONGEST, TREE

BUILD = Path(sys.argv[2]).resolve()
HERE = Path(__file__).resolve().parent
os.chdir(TREE)
os.environ.pop("MAKEFLAGS", None)
from icesoc.cli import main  # noqa: E402
from icesoc.cli.commands.call import choices  # noqa: E402
from icesoc.cli.options import ADDRESS  # noqa: E402
from icesoc.call.objects import Catalogue  # noqa: E402
from icesoc.util.errors import Stop  # noqa: E402

# Arguments for operations of `try`, each with the output that --json must give.
CALLS = [
    ("add 1 2", {"result": 3}), ("add threshold=0x10 left=-5", {"result": 11}),
    ("add -32768 255", {"result": -32513}),
    ("big 255 -2147483648 9223372036854775807", {"result": 2**63 - 1 - 2**31 + 255}),
    ("real 0.5 -1e300", {"result": -1e300}), ("flip true", {"result": False}),
    (["echo", "a b=\"\u20ac\\\n"], {"result": "a b=\"\u20ac\\\n"}),
    (["echo", ""], {"result": ""}), (["echo", "@file"], {"result": "@file"}),
    ("next green", {"result": "blue", "number": 5}),
    (["move", '{"x": 3, "y": 4}', "2"], {"result": {"x": 5, "y": 4}}),
    (["move", '{"x": 3}', "-2"], {"result": {"x": 1, "y": 7}}),
    (["turn", '[{"x": 1}, {"x": 2, "y": 3}]'],
     {"result": [{"x": 2, "y": 3}, {"x": 1, "y": 7}]}),
    (["reverse", "[1, 2, 255]"], {"result": [255, 2, 1]}),
    ("reverse 0x0102ff", {"result": [255, 2, 1]}), ("reverse []", {"result": []}),
    (["count", '{"a": 1, "b": -2}'], {"result": {"a": 2, "b": -4}}),
    (["colours", '[[{"x": 3, "y": 0}, "green"], [{"x": 2}, "blue"]]'], {"result": 27}),
    (["places", '{"-7": {"x": 1}}'], {"result": {"-7": {"x": 1, "y": 7}}}),
    ("maybe", {"result": None}), ("maybe null", {"result": None}),
    ("maybe value=5", {"result": 5}), ("chain null", {"result": {
        "name": "leaf", "next": None, "weight": 0}}),
    (["chain", '{"@type": "Trial.Leaf", "name": "a", "next": null}'],
     {"result": {"name": "leaf", "weight": 3, "next": {"name": "a", "next": None, "weight": 3}}}),
    ("import lambda=x", {"result": "x"}), ("context seed --context seed=7", {"result": "7"}),
    ("context seed --facet side", {"result": "side"}), ("nothing", {}),
    ("nothing --oneway", {}), ("self null", {"result": None}),
    ("add 1 2 --encoding 1.0", {"result": 3}), ("ice_id", {"result": "::Trial::Try"}),
    ("ice_isA ::Trial::Base", {"result": True}), ("--json add 1 --timeout 5 2", {"result": 3}),
]
# Arguments that must be rejected before anything is sent, each with the message.
REFUSED = {
    "add 1 300": "threshold: expected 0 to 255, got 300",
    "add 1 -1": "threshold: expected 0 to 255, got -1",
    "add 32768 0": "left: expected -32768 to 32767, got 32768",
    "add 1.5 0": "left: expected -32768 to 32767, got '1.5'",
    "add x 0": "left: expected -32768 to 32767, got 'x'",
    "add 0x8000 0": "left: expected -32768 to 32767, got 32768",
    "add true 0": "left: expected -32768 to 32767, got 'true'",
    "add \u0663 0": "left: expected -32768 to 32767, got '\u0663'",
    "add 1": "threshold: missing; expected short 0..255 grey levels: try.add(left: short, ",
    "add 1 2 3": "add: expected 2 arguments (left, threshold), got '3' as well",
    "add 1 left=2 left=3": "left: given twice",
    "add 1 2 tresh=3": "got 'tresh=3' as well",
    "big 256 0 0": "small: expected 0 to 255, got 256",
    "big 0 0 9223372036854775808": "large: expected -9223372036854775808 to",
    "big 0 0 " + 5000 * "9": "large: expected -9223372036854775808 to 9223372036854775807, got '99",
    "real 1e39 0": "small: expected -3.402823e+38 to 3.402823e+38, got 1e+39",
    "real one 0": "small: expected a number, got 'one'",
    "flip yes": "value: expected true or false, got 'yes'", "flip 1": "true or false, got '1'",
    "next gren": "value: expected red, green, blue, got 'gren'; did you mean green?",
    "next 5": "value: expected red, green, blue, got '5'",
    "move 5 1": "from: expected an object with x, y, got 5",
    "move {} 1": "from.x: missing; expected int",
    'move {"x":1,"z":2} 1': "from.z: Trial.Point has no such field; it has x, y",
    'move {"x":2147483648} 1': "from.x: expected -2147483648 to 2147483647, got 2147483648",
    'move {"x":1,"x":2} 1': "from.x: given twice",
    'move {"x":1.0} 1': "from.x: expected -2147483648 to 2147483647, got 1.0",
    'move {"x":1 1': "from: expected JSON, got '{\"x\":1' (column",
    'turn [{"x":1},{"x":true}]': "list[1].x: expected -2147483648 to 2147483647, got true",
    'turn [{"x":1},{"x":1},{"x":1},{"x":1}]': "list: expected at most 3 elements, got 4",
    'turn {"x":1}': "list: expected a list of Trial.Point, got {\"x\": 1}",
    "reverse [256]": "list[0]: expected 0 to 255, got 256",
    "reverse 0x012": "list: expected JSON, got '0x012'",
    "reverse @none": "list: cannot read ", "reverse @large": "expected at most 4096 elements, got",
    "reverse " + 20000 * "[": "list: expected JSON",
    "pixels @text": "frame: expected a picture, got ",
    'count {"a":2147483648}': "words[\"a\"]: expected -2147483648 to 2147483647",
    "count [1]": "words: expected an object, or a list of [key, value], got [1]",
    'colours [[{"x":1},"red"],[{"x":1,"y":7},"blue"]]': "duplicate key",
    'places {"x":{"x":1}}': "key of map: expected -2147483648 to 2147483647, got 'x'",
    'chain {"@type":"Trial.Point","name":"a"}': "first.@type: expected ::Trial::Node or a class",
    "self ::": "other: expected a proxy such as",
    "watch watch 1": "listener: expected --watch with the listener",
    "ad 1 2": "try has no operation 'ad'; did you mean add?",
    "ice_pong": "try has no operation 'ice_pong'; did you mean ice_ping?",
    "echo a --oneway": "--oneway: expected an operation without results and exceptions, got echo",
    "nothing --context x": "--context: expected NAME=VALUE, got 'x'",
    "nothing --events 2": "--events: expected --watch as well",
    "nothing --page --gateway x": "--page: expected --gateway HOST:PORT, got 'x'",
    "nothing --encoding 2.0": "--encoding: expected 1.0 or 1.1, got '2.0'",
    "nothing --gateway x": "--gateway: expected HOST:PORT",
    "nothing --address 65536": "--address: expected 0 to 65535, or 0x0000 to 0xFFFF, got '65536'",
    "nothing --address 09": "--address: expected 0 to 65535, or 0x0000 to 0xFFFF, got '09'",
    "nothing --device /dev/null --flight x": "--flight, --device exclude each other; give only one",
    "echo " + "\udcff": "text: expected text in UTF-8",
}
# Calls that fail, each with exit status and message
FAILURES = {
    "fail 42": (3, "try.fail: Trial.Overflow: why = too large, code = 42, colour = green"),
    "sleep 2000 --timeout 0.2": (4, "no answer from 127.0.0.1:"),
    "nothing --gateway 127.0.0.1:1": (4, "cannot reach 127.0.0.1:1: Connection refused"),
    "nothing --facet none": (5, "'try' has no facet 'none'"),
    "refuse": (6, "try.refuse: the call was refused: ValueError: no reason"),
    # the reply of a servant of IceC that gives no reason
    "add 32766 17": (6, "try.add: the vehicle refused the call and gave no reason; check the "
                        "arguments: add(left: short, threshold: short 0..255 grey levels) -> int"),
    "unreachable": (4, "cannot reach the vehicle: the modem is lost; see the log\n")}


class Call(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = subprocess.Popen(["/usr/bin/python3", HERE / "call_server.py"],
                                      stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        cls.port = cls.server.stdout.readline().strip()
        cls.work = tempfile.TemporaryDirectory()
        for name, data in (("bytes", bytes(range(256))), ("large", bytes(4097)), ("text", b"no"),
                           ("json", b'{"x": 9}')):
            Path(cls.work.name, name).write_bytes(data)

    @classmethod
    def tearDownClass(cls):
        cls.server.stdin.close()
        cls.server.wait(20)
        cls.server.stdout.close()
        cls.work.cleanup()

    def ask(self, words, *more, operation=True):
        """Runs `call` in this process. Returns exit status, output and messages."""
        words = words.split(" ") if isinstance(words, str) else list(words)
        if operation:
            at = 1 if words[0] == "--json" else 0
            words[at] = f"try.{words[at]}"
        if not {"--gateway", "--device", "--locator"} & set(words):
            words += ["--gateway", f"127.0.0.1:{self.port}"]
        words = ["call", *words, "--slice", str(HERE / "call.ice"), "--build", str(BUILD), *more]
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err), \
                mock.patch.object(main, "surroundings", lambda: self.work.name), \
                mock.patch.object(main, "hear_signals", lambda: None):
            status = main.main(words)
        self.assertNotIn("Traceback", out.getvalue() + err.getvalue())
        return status, out.getvalue(), err.getvalue()

    def test_values(self):
        """Values of every Slice type reach the server and return unchanged."""
        for words, answer in CALLS:
            status, out, err = self.ask(words, "--json")
            self.assertEqual((status, json.loads(out or "0")), (0, answer), f"{words}: {err}")
        self.assertEqual(json.loads(self.ask("reverse @bytes", "--json")[1]),
                         {"result": list(range(255, -1, -1))})
        from PIL import Image
        Image.new("RGB", (20, 10)).save(Path(self.work.name, "picture.png"))
        self.assertEqual(json.loads(self.ask("pixels @picture.png", "--json")[1]),
                         {"result": 200200})

    def test_text(self):
        """Without --json, results are printed in a form for people."""
        self.assertEqual(self.ask("add 1 2")[1], "3\n")
        self.assertEqual(self.ask("next green")[1], 'result: "blue"\nnumber: 5\n')
        self.assertEqual(self.ask("move @json 1")[1], "  x: 10\n  y: 7\n")
        self.assertEqual(self.ask("reverse 0x0102")[1], "2 bytes: 02 01\n")
        self.assertRegex(self.ask("nothing")[2], r"^done in [0-9.]+ ms\n$")

    def test_refused(self):
        """Wrong arguments are rejected before anything is sent: the calls name an address at which
        no server listens."""
        self.assertEqual([ADDRESS.read(text) for text in ("9", "0x9", "0x0009", "65535")],
                         ["0x0009", "0x0009", "0x0009", "0xFFFF"])
        for words, message in REFUSED.items():
            # These two calls need the server: `call` must ask the object for its interface before
            # it knows that the operation does not exist.
            unknown = words.split()[0] in ("ad", "ice_pong")
            target = () if unknown or {"--gateway", "--device"} & set(words.split()) \
                else ("--gateway", "127.0.0.1:1")
            status, out, err = self.ask(words.split(" ") + list(target))
            self.assertEqual((status, out), (2, ""), f"{words}: {err}")
            self.assertIn(message, err, words)
        self.assertEqual(self.ask("add 1 2 --check", "--json")[1],
                         '{"left": 1, "threshold": 2}\n')

    def test_failures(self):
        for words, (status, message) in FAILURES.items():
            answer = self.ask(words)
            self.assertEqual(answer[:2], (status, ""), words)
            self.assertIn(message, answer[2], words)
        status, out, _ = self.ask("fail 42", "--json")
        self.assertEqual((status, json.loads(out)), (3, {
            "error": "Trial.Overflow", "why": "too large", "code": 42, "colour": "green",
            "text": "Trial.Overflow: why = too large, code = 42, colour = green"}))
        status, _, err = self.ask("other.add 1 2", operation=False)
        self.assertEqual((status, "has no object 'other'" in err), (5, True), err)

    def test_silent(self):
        """Only the call has a time-out, not the connection. Ice 3.7 may use freed memory if both
        expire at the same time."""
        with socket.create_server(("127.0.0.1", 0)) as silent:
            where = f"127.0.0.1:{silent.getsockname()[1]}"
            status, _, err = self.ask(f"add 1 2 --gateway {where} --timeout 0.2 --repeat 3")
            self.assertEqual(status, 4)
            self.assertIn(f"no answer from {where} within 0.2 s", err)
            silent.setblocking(False)
            silent.accept()[0].close()
            with self.assertRaises(BlockingIOError, msg="a call has opened another connection"):
                silent.accept()

    def test_repeat(self):
        out = json.loads(self.ask("add 1 2 --repeat 20", "--json")[1])
        self.assertEqual((out["calls"], out["failures"]), (20, 0))
        self.assertTrue(0 < out["min"] <= out["median"] <= out["p99"] <= out["max"] < 5000, out)
        status, out, _ = self.ask("fail 1 --repeat 3")
        self.assertEqual((status, out), (3, "calls 0, failures 3\n"))

    def test_events(self):
        """`call` creates a listener, and the server calls this listener over the connection of the
        call."""
        status, out, err = self.ask("watch events=2 --watch --events 3", "--json")
        self.assertEqual(status, 0, err)
        self.assertEqual([json.loads(line) for line in out.splitlines()], [
            {}, {"event": "Watcher.peak", "values": {"value": 0, "where": "red"}},
            {"event": "Watcher.peak", "values": {"value": 1, "where": "red"}},
            {"event": "Watcher.finished", "values": {}}])
        self.assertIn(' Watcher.peak value=0 where="red"\n',
                      self.ask("watch events=1 --watch --events 1")[1])

    def test_lists(self):
        """Lists the objects of the chip with their doc comments, and the words for completion."""
        status, out, err = self.ask("--list", operation=False)
        self.assertEqual(status, 0, err)
        self.assertRegex(out, r"(?s)hwengine1: Autopilot.HwProcessingEngine\n.*"
                         r"  setParameterA\(value: short 0..255 grey levels\)\n.*"
                         r"fir: Cores.Fir\n  setCoefficient\(index: byte 0..15, "
                         r"value: int -131072..131071\)\n      \w+")
        self.assertEqual(self.ask("--list nothing", operation=False)[0], 2)
        self.assertIn("fir", json.loads(self.ask("--list fir", "--json", operation=False)[1]))
        catalogue = Catalogue(str(BUILD), [str(HERE / "call.ice")])
        self.assertTrue({"fir.filter", "uav.isAlive"} <= set(choices(catalogue, [])))
        self.assertEqual(list(choices(catalogue, ["uav.setFlightState"])),
                         ["value=onGround", "value=flying"])
        lines = (("./icesoc call fir.se", "fir.setShift"),
                 ("./icesoc call --json uav.setFlightState v", "value=flying"),
                 ("./icesoc call fir.setShift ", "bits="))
        for line, wanted in lines if importlib.util.find_spec("argcomplete") else ():
            done = subprocess.run(
                ["bash", "-c", "./icesoc 8>&1 9>/dev/null >/dev/null 2>&1"], capture_output=True,
                text=True, env={**os.environ, "_ARGCOMPLETE": "1", "COMP_TYPE": "9",
                                "_ARGCOMPLETE_IFS": "\n", "COMP_LINE": line,
                                "COMP_POINT": str(len(line)),
                                "_ARGCOMPLETE_SUPPRESS_SPACE": "1"})
            self.assertIn(wanted, done.stdout.split("\n"), line)
        self.assertIn("several objects have this operation",
                      self.ask("ice_ping", operation=False)[2])
        self.assertIn("did you mean filter", self.ask("fliter", operation=False)[2])
        with self.assertRaisesRegex(Stop, "no object 'fri'; did you mean fir"):
            Catalogue(str(BUILD)).find("fri.filter")

    def test_registers(self):
        """Calls a core through its registers. Unknown names and wrong values are rejected."""
        build = Path(self.work.name, "build")
        (build / "gen").mkdir(parents=True)
        (build / "slice").symlink_to(BUILD / "slice")
        (build / "gen/chip.json").write_text(json.dumps({"objects": [{
            "identity": "eye", "core": "eye", "registers": str(TREE / "ip/vision/vision.regs.json"),
            "slice": [str(TREE / "sw/hw/registers/Registers.ice")],
            "interface": "::Hw::Registers"}]}))
        for words, message in (
                ("set THRESHOLD 300", "THRESHOLD: expected 0 to 255, got 300"),
                ("set THRESHOLD -1", "THRESHOLD: expected 0 to 255, got -1"),
                ("set TRESHOLD 3", "TRESHOLD: not a register; did you mean THRESHOLD?"),
                ("set STATUS 3", "STATUS: ro: it cannot be written; expected "),
                ("wait 600001", "ms: expected 0 to 600000, got 600001")):
            status, _, err = self.ask(f"eye.{words}", "--check", "--build", str(build),
                                      operation=False)
            self.assertEqual((status, message in err), (2, True), err)
        for words in "set THRESHOLD 255", "get 0x40", "get THRESHOLD":
            self.assertEqual(self.ask(f"eye.{words}", "--check", "--build", str(build),
                                      operation=False)[0], 0, words)
        self.assertIn("name=THRESHOLD", choices(Catalogue(str(build)), ["eye.set"]))

    def test_locator(self):
        """IceGrid finds the vehicle by its name."""
        work, endpoint = Path(self.work.name, "registry"), "tcp -h 127.0.0.1"
        work.mkdir()
        log = open(Path(self.work.name, "registry.log"), "w+")
        self.addCleanup(log.close)
        registry = subprocess.Popen([
            BUILD / "icegrid/icegridregistry", "--IceGrid.InstanceName=IceGrid",
            *(f"--IceGrid.Registry.{side}.Endpoints={endpoint}"
              for side in ("Internal", "Server", "Client")),
            "--IceGrid.Registry.DynamicRegistration=1", "--IceGrid.Registry.Discovery.Enabled=0",
            f"--IceGrid.Registry.LMDB.Path={work}", "--Ice.Trace.Network=1",
            "--Ice.PrintAdapterReady=1"], stdout=log, stderr=log)
        self.addCleanup(registry.wait, 20)
        self.addCleanup(registry.terminate)
        while "Registry.Client ready" not in (text := Path(log.name).read_text()):
            self.assertIsNone(registry.poll(), text)
            time.sleep(0.05)
        port = re.findall(r"accepting tcp connections at .*:(\d+)", text)[-1]
        locator = f"IceGrid/Locator:{endpoint} -p {port}"
        server = subprocess.Popen(
            ["/usr/bin/python3", HERE / "call_server.py", "--Trial.AdapterId=uav7",
             f"--Ice.Default.Locator={locator}"], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
            text=True)
        server.stdout.readline()
        for vehicle, wanted in (
                ("uav7", (0, "3\n", "")),
                ("uav8", (4, "", "try.add: IceGrid has no vehicle 'uav8'; check that its "
                          "gateway is running and the vehicle is in reach"))):
            status, out, err = self.ask(["add", "1", "2", "--locator", locator, "--vehicle",
                                         vehicle])
            self.assertEqual((status, out), wanted[:2], err)
            self.assertIn(wanted[2], err)
        server.communicate(timeout=LONGEST)
        self.assertEqual(self.ask(["add", "1", "2", "--locator", f"x:{endpoint} -p 1"])[0], 4)

    def test_speed(self):
        """The first call takes at most 1.5 times the CPU time of a small program that makes only
        this call."""
        program = ["/usr/bin/python3", "-c", f"""
import Ice
Ice.loadSlice("", ["-I" + Ice.getSliceDir(), "{HERE}/call.ice"])
import Trial
with Ice.initialize() as communicator:
    print(Trial.TryPrx.uncheckedCast(communicator.stringToProxy(
        "try:tcp -h 127.0.0.1 -p {self.port}")).add(1, 2))"""]
        called = [TREE / "icesoc", "call", "try.add", "1", "2", "--gateway",
                  f"127.0.0.1:{self.port}", "--slice", HERE / "call.ice", "--build", BUILD]

        def used():
            usage = resource.getrusage(resource.RUSAGE_CHILDREN)
            return usage.ru_utime + usage.ru_stime

        times = {"own": [], "ours": []}
        # Compares CPU times, because elapsed times depend on the load of the machine.
        for _ in range(5):
            for name, words in ("own", program), ("ours", called):
                begin = used()
                said = subprocess.run(words, capture_output=True, text=True)
                times[name].append(used() - begin)
                self.assertEqual(said.stdout, "3\n", said.stderr)
        own, ours = min(times["own"]), min(times["ours"])
        print(f"first call: {1000 * ours:.0f} ms, by a program {1000 * own:.0f} ms, "
              f"{ours / own:.2f} times")
        self.assertLessEqual(ours, 1.5 * own)


if __name__ == "__main__":
    sys.exit(not unittest.main(argv=[sys.argv[0], f"Call.test_{sys.argv[1]}"],
                               exit=False).result.wasSuccessful())
