#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""live_test: tests the page of a mission in headless Chromium, or the errors of the page's server.

Usage: live_test.py mission|late|errors work-folder build-folder
"""
import contextlib
import http.client
import json
import os
import re
import shutil
import socket
import subprocess
import sys
import urllib.error
import urllib.request
from pathlib import Path

from script import TREE, Script, edit, fresh, main, write
from icesoc.util.browser import Browser, elements

BUILD = Path(sys.argv[3]).resolve()
LIVE = [TREE / "tools/python", "-m", "icesoc.web.live"]
PAGE = TREE / "tools/icesoc/web/flight"


class Cases(Script):
    def setUp(self):
        self.work = fresh(sys.argv[2])

    @contextlib.contextmanager
    def serving(self, *words, until, **environment):
        """Starts a process that serves its page. Yields the port."""
        with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                              env={**os.environ, **environment}) as self.process:
            try:
                yield int(re.search(r"http://127\.0\.0\.1:(\d+)/", self.hear(until))[1])
            finally:
                self.process.terminate()
                self.process.stdout.close()
        self.ended = self.process.returncode

    def hear(self, text):
        """Reads the output of the process until it contains a text. Returns the output."""
        said = ""
        for line in self.process.stdout:
            said += line
            if text in line:
                return said
        self.fail(f"the process has ended: {said}")

    def test_mission(self):
        """The page opens together with the flight, and the vehicle keeps running until the page is
        closed."""
        write("browser", f"#!/bin/sh\necho \"$1\" >{self.work}/opened\n")
        flight = ("run", "--built", "--build", BUILD, "--size", "96x64", "--guard", "20", "--cpu",
                  "m3", "--out", self.work, "--show", "yes")
        with self.serving(TREE / "icesoc", *flight, until="http://",
                          BROWSER=f"{self.work}/browser %s") as port:
            address = f"http://127.0.0.1:{port}/"
            # The browser cannot resolve names, so that a resource on another host would be missing
            # and reported.
            with Browser("--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1",
                         width=1280, height=1500) as browser:
                browser.open(address)
                self.hear("The page stays until you close it")
                self.assertEqual(Path("opened").read_text(), address + "\n")
                browser.until("/equals/.test(document.getElementById('phase').innerText)")
                page = browser.elements()
                state = urllib.request.urlopen(address + "state").read().decode()
                self.calls()
                self.calls_of_the_page(browser)
                self.assertEqual(browser.errors, [])
                self.assertIsNone(self.process.poll())
                browser.open("about:blank")
            self.hear("The flight has ended")
            self.assertEqual(self.process.wait(60), 0)
            self.said = page
        self.has(
            "the mission is over", '<p id="flight">size 96x64, cpu m3, guard 20</p>',
            r"hwengine1.getResult\(\)", r"Station.vehicleState\(uptimeMs",
            '<td>THRESHOLD</td><td class="n">0x00000018</td>',
            # the fields of the vision core's register FRAME_SIZE
            ">WIDTH 96</span>.*>HEIGHT 64</span>",
            # the firmware has cleared this event of the vision core by writing 1
            ">DONE cleared</span>",
            'y="[0-9]*">UAV_radioTask</text>',
            "the result equals the C[+][+] reference, bit by bit", "corners, the strongest",
            '<text x="0" y="[0-9]*">vision</text>',
            r"<title>hwengine1.getResult\(\): until [0-9.]* s</title>",
            'id="phase" role="status" class="good">the mission is over, [0-9]+ corners, the result')
        # the view begins with the calls, not with the set-up of the modems
        self.lacks(">0.00 s</text>")
        drawn = re.findall('data-features="([0-9]*)"', self.said)
        found = [len(call["features"]) for call in self.lines("calls") if "features" in call]
        self.assertEqual(drawn, [str(found[-1])])
        # The JSON Lines of the flight contain all packets, and an event for the end of the core's
        # work.
        events, whole = self.lines("events"), self.lines("flight")[-1]["end"]
        packets = [event for event in events if "packet" in event]
        self.assertEqual((len(packets), sum(event["lost"] for event in packets)),
                         (whole["packets"], whole["lost"]))
        self.assertEqual({event["from"] for event in packets}, {"ground", "uav"})
        self.assertTrue(any(e.get("slot", 0) >= 2 and e["events"] for e in events))
        self.assertGreater(sum(sum(e.get("accesses", {}).values()) for e in events), 100)
        for file in (*PAGE.glob("*.html"), *PAGE.glob("*.css")):
            # the page does not contain the name of another host
            self.lacks("(https?:)?//[a-z]", file)
        self.narrow(state)

    def test_late(self):
        """A browser that loads the page only after the mission shows how the mission ended; the
        flight does not wait for a browser that cannot be started."""
        write("browser", "#!/bin/sh\n")
        flight = (TREE / "icesoc", "run", "--built", "--build", BUILD, "--size", "48x32",
                  "--guard", "20", "--out", self.work, "--show", "yes")
        with self.serving(*flight, until="http://", BROWSER=f"{self.work}/browser %s") as port:
            self.hear("The page stays until you close it")
            with Browser() as browser:
                browser.open(f"http://127.0.0.1:{port}/")
                browser.until("/mission is over/.test(document.getElementById('phase').innerText)")
                self.said = browser.elements()
                browser.open("about:blank")
            self.hear("The flight has ended")
            self.assertEqual(self.process.wait(), 0)
        self.has(">WIDTH 48</span>.*>HEIGHT 32</span>", r"hwengine1.getResult\(\)")
        with self.serving(*flight, until="http://", BROWSER="false", DISPLAY="",
                          WAYLAND_DISPLAY=""):
            self.hear("Pictures and report: ")
            self.assertNotIn("The page stays", self.process.stdout.read())
            self.assertEqual(self.process.wait(), 0)

    def calls(self):
        """After the mission, the vehicle can be called from the shell."""
        call = TREE / "icesoc", "call", "--json", "--flight", self.work, "--build", BUILD
        self.ask(*call, "hwengine1.setParameterA", "300", status=2)
        self.has("value: expected 0 to 255, got 300")
        found = []
        for threshold in "24", "60":
            self.ask(*call, "setParameterA", threshold)
            self.ask(*call, "hwengine1.startProcessing", "--oneway")
            self.ask(*call, "hwengine1.getResult")
            found.append(json.loads(self.said)["res"]["found"])
        self.assertGreater(found[0], found[1])
        self.ask(*call, "fir.filter", "[]", status=6)
        self.has('{"error": "Ice.UnknownException", "text": "the vehicle refused the call ')
        self.ask(*call, "keys.count", status=6)
        self.has("maintenance")
        self.ask(*call, "update.getStatus", status=5)

    def calls_of_the_page(self, browser):
        """The page can call the vision core, and draws the corners in the reply."""
        if not (BUILD / "page/ice.js").stat().st_size:
            return print("without a call of the page: Ice for JavaScript could not be fetched")
        browser.run("document.getElementById('objects').open = true")
        browser.until("document.querySelectorAll('#cards details').length > 4")
        browser.run("document.querySelectorAll('#cards details').forEach(d => d.open = true)")
        browser.until("document.getElementById('hwengine1.setParameterA.value') !== null")
        calls = browser.run("""(async () => {
            const slider = document.querySelector(
                '[id="hwengine1.setParameterA.value"] ~ input');
            slider.value = 60;
            slider.dispatchEvent(new Event('input'));
            const forms = [...slider.closest('details').querySelectorAll('form')];
            for (const form of forms) {
                form.requestSubmit();
                while (!form.querySelector('output').innerText.includes('done in'))
                    await new Promise(r => setTimeout(r, 10));
            }
            return forms.map(form => form.innerText);
        })()""")
        found = re.search(r'"found":(\d+)', calls[2])[1]
        browser.until("document.getElementById('found').innerText"
                      f".startsWith('{found} corners')")
        self.assertLess(int(found), 121)
        # The registers of the core are shown next to its operations, and registers that change are
        # marked.
        card = "document.querySelector('#cards [data-block=vision]')"
        browser.until(f"/THRESHOLD\\s+0x0000003c/.test({card}.innerText)")
        browser.until(f"!{card}.querySelector('.changed')")
        browser.run("document.querySelector('[id=\"hwengine1.setParameterA.value\"]')"
                    ".value = 61; document.querySelector('[id="
                    "\"hwengine1.setParameterA.value\"]').closest('form').requestSubmit()")
        browser.until(f"{card}.querySelector('.changed')?.innerText.includes('0x0000003d')")

    def narrow(self, state):
        """At a width of 420 pixels, nothing is cut off, and no scroll bar is needed."""
        for file in (*PAGE.iterdir(), *(TREE / "tools/icesoc/web").glob("common.*")):
            write(file.name, file.read_text())
        common = '<script src="common.js">'
        edit("index.html", common, f"""<script>
window.fetch = async () => ({{json: () => ({state})}});
document.querySelector("details").open = true;
setTimeout(() => top.document.body.append("cut: " + [...document.querySelectorAll("*")].filter(e =>
  e.getBoundingClientRect().right > 421 || getComputedStyle(e).overflowX !== "visible" &&
  e.scrollWidth > e.clientWidth + 1).map(e => e.tagName + e.id) + ";"), 1000);</script>{common}""")
        write("frame.html", '<iframe src="index.html" width="420"></iframe>')
        self.said = elements((self.work / "frame.html").as_uri(),
                             "--allow-file-access-from-files")
        self.has("cut: ;")

    def lines(self, name):
        return [json.loads(line) for line in Path(f"{name}.jsonl").read_text().splitlines()]

    def contrasts(self):
        """The contrast of the pages' bars, marks and texts with the light and with the dark
        background is sufficient."""
        def light(colour):
            digits = colour[1:] if len(colour) == 7 else "".join(2 * d for d in colour[1:])
            parts = [int(digits[i:i + 2], 16) / 255 for i in (0, 2, 4)]
            parts = [p / 12.92 if p <= 0.03928 else ((p + 0.055) / 1.055) ** 2.4 for p in parts]
            return 0.2126 * parts[0] + 0.7152 * parts[1] + 0.0722 * parts[2]

        for theme in re.findall(":root {(.*?)}", (PAGE.parent / "common.css").read_text()):
            colours = dict(re.findall("--([a-z]+): (#[0-9a-f]+)", theme))
            for name in "bar", "mark", "good", "bad", "skip", "soft", "ink":
                for ground in "paper", "wash":
                    low, high = sorted((light(colours[name]), light(colours[ground])))
                    self.assertGreaterEqual((high + 0.05) / (low + 0.05), 3, (name, ground))

    def test_errors(self):
        self.contrasts()
        page = *LIVE, "--dir", self.work, "--build"
        self.ask(*LIVE, "--help")
        self.has("--build")
        self.ask(*page, self.work / "none", status=1)
        self.has("cannot read")
        self.ask(*LIVE, "--dir", self.work, status=2)
        self.has("required")
        with self.serving(*page, BUILD, until="127.0.0.1") as port:
            self.ask(*page, BUILD, "--port", str(port), status=1)
            self.has("the port may be in use")
            self.ask(TREE / "icesoc", "run", "--built", "--build", BUILD, "--size", "96x64",
                     "--out", "unflown", "--port", str(port), status=1)
            self.has("the port may be in use")
            # without its page, the simulator does not fly
            self.assertFalse(Path("unflown/status").exists())
            self.requests(port)
        self.assertEqual(self.ended, 0)

    def requests(self, port):
        """If no flight has run in this folder yet, the page answers nevertheless, and only on the
        loopback interface."""
        base, ours = f"http://127.0.0.1:{port}/", f"127.0.0.1:{port}"

        def state():
            return json.load(urllib.request.urlopen(base + "state"))

        def status(headers):
            client = http.client.HTTPConnection("127.0.0.1", port, timeout=60)
            client.request("GET", "/live.js", headers=headers)
            return client.getresponse().status

        def connect():
            return socket.create_connection(("127.0.0.1", port), timeout=60)

        def talk(data):
            with connect() as connection:
                connection.sendall(data)
                return connection.recv(1000)

        empty = state()
        self.assertEqual((empty["calls"], empty["slots"], bool(empty["frame"])), ([], [], False))
        # Sends other names of this address and malformed lines, and connects clients that are slow,
        # never end a request, or are silent.
        self.assertEqual(status({}), 200)
        self.assertEqual(status({"Host": f"evil.example:{port}"}), 403)
        self.assertEqual(status({"Host": ours, "HOST": "evil.example"}), 403)
        ranges = ",".join(f"0-{i}" for i in range(400, 800))
        # the answer contains the whole file
        self.assertEqual(status({"Range": f"bytes={ranges}"}), 200)
        self.assertIn(b"400 ", talk(b"EHLO\r\n\r\n"))
        self.assertIn(b" 501 ", talk(f"POST /state HTTP/1.1\r\nHost: {ours}\r\n\r\n".encode()))
        with connect() as endless, self.assertRaises(ConnectionError):
            for _ in range(10000):
                endless.sendall(b"GET / HTTP/1.1\r\n" + b"A: b\r\n" * 1000)
        Path("calls.jsonl").write_bytes(b'7\n[1, 2]\n"text"\n{"what": "\xff"}\n'
                                        b'{"at": 1.0, "who": "a", "what": "b"}\n{"half')
        self.assertEqual([call["who"] for call in state()["calls"]], ["a"])
        for name in "before2.png", "before3.png", "after3.png":
            shutil.copy(TREE / "docs/pictures/mission.png", name)
        self.said = elements(base)
        self.has(r"uav2 \(0x0002\)</figcaption>", r"uav3 \(0x0003\), corners drawn<")
        self.assertEqual(urllib.request.urlopen(base + "vehicle3.png?after3.png").status, 200)
        crowd = [connect() for _ in range(400)]
        for connection in crowd[-20:]:
            connection.send(b"GET / HTTP/1.1\r\nHost: ")
        self.assertEqual(status({}), 200)
        for connection in crowd:
            connection.close()
        for path, wanted in ("", 200), ("live.js", 200), ("frame.png", 404), ("../main.cpp", 404):
            try:
                got = urllib.request.urlopen(base + path).status
            except urllib.error.HTTPError as error:
                got = error.code
            self.assertEqual(got, wanted, path)


main(Cases)
