#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""objects_test: tests how a flight's page shows and calls objects, in Chromium, with a server of
stock Ice in place of a vehicle. Also tests which pages may call.

Usage: objects_test.py page|strangers work-folder build-folder
"""
import contextlib
import http.server
import json
import os
import re
import socket
import subprocess
import sys
import threading
import urllib.request
from pathlib import Path

from PIL import Image

from script import TREE, Script, fresh, main, write
from icesoc.util.browser import Browser
import vehicles

BUILD = Path(sys.argv[3]).resolve()
TRIAL = TREE / "tests/cli/call.ice"
MANY = 200  # number of operations of the object with many operations


class Cases(Script):
    def setUp(self):
        if not (BUILD / "page/ice.js").stat().st_size:
            self.skipTest("Ice for JavaScript could not be fetched")
        self.work = fresh(sys.argv[2])
        self.server = subprocess.Popen(["/usr/bin/python3", TREE / "tests/cli/call_server.py"],
                                       stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.addCleanup(self.stop)
        port = self.server.stdout.readline().strip()
        many = " ".join(f"int act{n}(int value);" for n in range(MANY))
        write("many.ice", f"module Many {{ interface Lots {{ {many} }}; }};\n")
        listed = [{"identity": name, "core": name, "registers": "", "slice": [str(file)],
                   "interface": interface}
                  for name, file, interface in (("try", TRIAL, "::Trial::Try"),
                                                ("many", self.work / "many.ice", "::Many::Lots"))]
        slots = json.loads((BUILD / "gen/chip.json").read_text())["slots"]
        write("build/gen/chip.json", json.dumps({"slots": slots, "objects": listed}))
        for name in "slice", "page":
            os.symlink(BUILD / name, f"build/{name}")
        self.gateway = f"127.0.0.1:{port}"
        write("vehicles.conf", vehicles.text({"uav1": f"tcp -h 127.0.0.1 -p {port}"},
                                             Process=os.getpid(), Build=self.work / "build"))
        self.page = subprocess.Popen(
            [TREE / "tools/python", "-m", "icesoc.web.live", "--dir", self.work, "--build",
             "build"], stdout=subprocess.PIPE, text=True)
        self.port = int(re.search(r":(\d+)/", self.page.stdout.readline())[1])
        self.address = f"http://127.0.0.1:{self.port}/"

    def stop(self):
        self.server.stdin.close()
        self.server.wait(20)
        self.server.stdout.close()
        self.page.terminate()
        self.page.wait(20)
        self.page.stdout.close()

    def call(self, browser, operation, fields):
        """Fills in a form and presses its button. Returns the text that then appears."""
        browser.run(f"""(() => {{
            window.form = [...document.querySelectorAll('#cards form')].find(each =>
                each.querySelector('h4').innerText.split(' ')[0] === '{operation}');
            for (const [name, value] of Object.entries({json.dumps(fields)})) {{
                const field = document.getElementById('try.{operation}.' + name);
                if (field.type === 'checkbox') field.checked = value;
                else field.value = value;
                for (const kind of ['input', 'change'])
                    field.dispatchEvent(new Event(kind, {{bubbles: true}}));
            }}
            form.querySelector('button:not([type])').click();
        }})()""")
        return browser.until("/done in|./.test(form.querySelector('output').innerText) && "
                             "form.querySelector('output').innerText !== 'calling ...' && "
                             "form.querySelector('output').innerText")

    def test_page(self):
        with Browser() as browser:
            browser.open(self.address)
            browser.run("document.getElementById('objects').open = true")
            browser.until("document.querySelectorAll('#cards details').length > 2")
            browser.run("[...document.querySelectorAll('#cards details')].find(d => "
                        "d.innerText.startsWith('try')).open = true")
            browser.until("document.getElementById('try.add.left') !== null")
            for operation, fields, wanted in (
                    ("add", {"left": "7", "threshold": "0x10"}, "23"),
                    ("add", {"left": "7", "threshold": "300"},
                     "threshold: expected 0 to 255, got 300"),
                    ("big", {"small": "1", "middle": "-1", "large": "9223372036854775807"},
                     "9223372036854775807"),
                    ("real", {"small": "0.5", "large": "1e300"}, "1e+300"),
                    ("flip", {"value": True}, "false"), ("echo", {"text": "\u20ac"}, "\u20ac"),
                    ("next", {"value": "green"}, '"blue"'), ("move", {"from.x": "3", "dx": "4"},
                                                             '{"x":7,"y":7}'),
                    ("turn", {"list": '[{"x":1},{"x":2}]'}, '[{"x":2,"y":7},{"x":1,"y":7}]'),
                    ("turn", {"list": '[{"x":1},{"z":2}]'}, "list[1].z: Trial.Point has no such"),
                    ("reverse", {"list": "[1,2,255]"}, "3 bytes: ff 02 01"),
                    ("reverse", {"list": "0x0102fF"}, "3 bytes: ff 02 01"),
                    ("maybe", {}, "result\nnull"), ("maybe", {"value": "5"}, "result\n5"),
                    ("chain", {"first": "Trial.Leaf", "first.name": "a", "first.weight": "4"},
                     '{"name":"leaf","next":{"name":"a","next":null,"weight":4},"weight":4}'),
                    ("chain", {"first": "null"}, '{"name":"leaf","next":null,"weight":0}'),
                    ("reverse", {"list": json.dumps([1] * 4096)}, "4096 bytes: 01 01"),
                    ("reverse", {"list": json.dumps([1] * 4097)}, "at most 4096 elements"),
                    ("count", {"words": '{"a":2}'}, '{"a":4}'),
                    ("fail", {"code": "42"}, 'Trial.Overflow {"why":"too large","code":42,'
                                             '"colour":"green"}')):
                self.assertIn(wanted, self.call(browser, operation, fields), operation)
            self.assertIn("done in", self.call(browser, "watch", {"events": "2"}))
            browser.until("document.querySelectorAll('#arrived li').length === 3")
            self.assertIn('Watcher.peak {"value":1,"where":"red"}',
                          browser.run("document.getElementById('arrived').innerText"))
            before = browser.run("document.querySelectorAll('#history li').length")
            browser.run("document.querySelector('#history button').click()")
            browser.until(f"document.querySelectorAll('#history li').length > {before}")
            self.table(browser)
            self.pictures(browser)
            self.copies(browser)
            self.keyboard(browser)
            self.sizes(browser)
            self.assertEqual(browser.errors, [])
        self.other_vehicle()

    def other_vehicle(self):
        """The same page works with a gateway, without a flight."""
        os.remove("vehicles.conf")
        with subprocess.Popen([TREE / "icesoc", "call", "--page", "--gateway", self.gateway,
                               "--build", self.work / "build"], stdout=subprocess.PIPE,
                              text=True) as process, Browser() as browser:
            browser.open(re.search("http://.*", process.stdout.readline())[0])
            browser.until("document.querySelectorAll('#cards details').length > 2")
            browser.run("document.querySelectorAll('#cards details').forEach(d => d.open = true)")
            browser.until("document.getElementById('try.add.left') !== null")
            self.assertIn("9", self.call(browser, "add", {"left": "7", "threshold": "2"}))
            process.terminate()

    def table(self, browser):
        """A sequence is shown as a table, in which rows can be added, pasted, filled in and
        removed."""
        browser.run("""(() => {
            window.form = document.getElementById('try.count.words').closest('form');
            document.getElementById('try.count.words').value = '[]';
            document.getElementById('try.count.words').dispatchEvent(new Event('input'));
            [...form.querySelectorAll('button')].find(b => b.innerText === 'Add a row').click();
        })()""")
        browser.press(*"one")  # the focus is in the new row
        browser.press("Tab")
        browser.press(*"2")
        self.assertEqual(browser.run("document.getElementById('try.count.words').value"),
                         '[["one",2]]')
        took = browser.run("""(async () => {
            const begin = performance.now(), text = [...Array(200).keys()].map(n => `k${n},${n}`);
            const clipboardData = new DataTransfer();
            clipboardData.setData('text', text.join('\\n'));
            form.querySelector('tbody input').dispatchEvent(
                new ClipboardEvent('paste', {bubbles: true, cancelable: true, clipboardData}));
            form.querySelector('tbody button').click();
            form.requestSubmit();
            while (!form.querySelector('output').innerText.includes('done in'))
                await new Promise(r => setTimeout(r, 5));
            return performance.now() - begin;
        })()""")
        self.assertEqual(browser.run("form.querySelectorAll('tbody tr').length"), 199)
        self.assertIn('"k199":398', browser.run("form.querySelector('output').innerText"))
        self.assertNotIn('"k0":', browser.run("form.querySelector('output').innerText"))
        self.assertLess(took, 5000)

    def pictures(self, browser):
        """A picture from a file is sent to the server, and the picture in the reply is drawn."""
        write("black.pgm", "P2 4 2 255\n0 0 0 0 0 0 0 0\n")
        Image.open("black.pgm").save("black.png")
        browser.choose("[id='try.negative.frame'] > [type=file]", self.work / "black.png")
        browser.until("document.getElementById('try.negative.frame.width').value === '4'")
        browser.run("document.getElementById('try.negative.frame').closest('form').requestSubmit()")
        browser.until("!!document.querySelector('output canvas')")
        self.assertEqual(browser.run("""(() => {
            const canvas = document.querySelector('output canvas');
            const data = canvas.getContext('2d').getImageData(3, 1, 1, 1).data;
            return [canvas.width, canvas.height, ...data];
        })()"""), [4, 2, 255, 255, 255, 255])

    def copies(self, browser):
        """The page offers texts to copy that make the same call as the form. The Python program
        among them runs unchanged."""
        texts = browser.run("""(() => {
            const object = station.objects.find(o => o.identity === 'try');
            const operation = station.slice.operations(object.interface)
                .find(o => o.name === 'add');
            const values = {left: 7n, threshold: 16n};
            return [asShell(object, operation, values), asPython(object, operation, values)];
        })()""")
        self.assertEqual(texts[0], "./icesoc call try.add left=7 threshold=16")
        write("copied.py", texts[1])
        self.ask("/usr/bin/python3", "copied.py")
        self.has("^23$")

    def keyboard(self, browser):
        """A form can be used with the keyboard alone, and each of its fields has a name."""
        browser.run("document.getElementById('try.add.threshold').value = '16'; "
                    "document.getElementById('try.add.left').value = '40'; "
                    "document.getElementById('try.add.left').focus()")
        browser.press("Enter")
        browser.until("document.getElementById('try.add.left').closest('form')"
                      ".querySelector('output').innerText.includes('56')")
        nameless = browser.run("""
            [...document.querySelectorAll('#objects :is(input, select, textarea)')]
            .filter(e => !e.labels.length && !e.getAttribute('aria-label')).map(e => e.id)""")
        self.assertEqual(nameless, [])

    def sizes(self, browser):
        """In a narrow window nothing is cut off. An object with many operations opens quickly."""
        for width, dark in (400, False), (400, True), (1400, True), (1400, False):
            browser.resize(width, 1000, dark)
            self.assertEqual(browser.run(
                "[...document.querySelectorAll('#objects :not(.rows *)')].filter(e => "
                f"e.offsetParent && e.getBoundingClientRect().right > {width} + 1)"
                ".map(e => e.tagName + e.id)"), [])
        took = browser.run("""(async () => {
            const begin = performance.now();
            const card = [...document.querySelectorAll('#cards details')]
                .find(d => d.innerText.startsWith('many'));
            card.open = true;
            while (card.querySelectorAll('form').length < %d)
                await new Promise(r => setTimeout(r, 1));
            return performance.now() - begin;
        })()""" % MANY)
        self.assertLess(took, 5000)

    def test_strangers(self):
        """Requests from pages of other origins, with other names of this host, or with a wrong
        token are rejected."""
        token = re.search('data-token="([0-9a-f]{32})"',
                          urllib.request.urlopen(self.address).read().decode())[1]
        host = f"127.0.0.1:{self.port}"

        def upgrade(origin, token=token, host=host):
            with socket.create_connection(("127.0.0.1", self.port), timeout=60) as connection:
                connection.sendall((
                    f"GET /ice?token={token} HTTP/1.1\r\nHost: {host}\r\n"
                    + (f"Origin: {origin}\r\n" if origin else "")
                    + "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                    "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n").encode())
                return connection.recv(12).decode()[-3:]

        self.assertEqual(upgrade(f"http://{host}"), "101")
        for origin in ("http://evil.example", f"http://localhost:{self.port}", "null", "",
                       f"https://{host}", f"http://{host}.evil.example"):
            self.assertEqual(upgrade(origin), "403", origin)
        self.assertEqual(upgrade(f"http://{host}", token="0" * 32), "403")
        self.assertEqual(upgrade("http://evil.example:80", host="evil.example:80"), "403")
        with self.other_page(token) as address, Browser() as browser:
            browser.open(address)
            said = browser.until("document.title")
            self.assertEqual(said, "socket refused, page unreadable, frame empty")
        self.nonsense(host, token)

    @contextlib.contextmanager
    def other_page(self, token):
        """Serves a page of another origin, which even has the token."""
        text = f"""<body><script>
            const socket = new Promise(done => {{
                const s = new WebSocket("ws://127.0.0.1:{self.port}/ice?token={token}",
                                        "ice.zeroc.com");
                s.onopen = () => done("opened");
                s.onerror = () => done("refused");
            }});
            const page = fetch("{self.address}").then(() => "read", () => "unreadable");
            const frame = document.createElement("iframe");
            frame.src = "{self.address}";
            document.body.append(frame);
            Promise.all([socket, page]).then(([s, p]) => {{
                let inner = "empty";
                try {{
                    const its = frame.contentDocument;
                    inner = its && its.body.innerText ? "shown" : "empty";
                }} catch {{}}
                document.title = `socket ${{s}}, page ${{p}}, frame ${{inner}}`;
            }});
        </script></body>"""

        class Other(http.server.BaseHTTPRequestHandler):
            def do_GET(self):
                self.send_response(200)
                self.send_header("Content-Type", "text/html")
                self.end_headers()
                self.wfile.write(text.encode())

            def log_message(self, *_):
                pass

        with http.server.ThreadingHTTPServer(("127.0.0.1", 0), Other) as server:
            threading.Thread(target=server.serve_forever, daemon=True).start()
            yield f"http://127.0.0.1:{server.server_address[1]}/"
            server.shutdown()

    def nonsense(self, host, token):
        """A WebSocket that violates the protocol is closed, and the page's server still answers
        afterwards."""
        for data in (b"\x82\x05hello", b"\x82\xff" + b"\xff" * 12, b"\xf2\x80\0\0\0\0", b"\0" * 99):
            with socket.create_connection(("127.0.0.1", self.port), timeout=60) as connection:
                connection.sendall((
                    f"GET /ice?token={token} HTTP/1.1\r\nHost: {host}\r\nOrigin: http://{host}\r\n"
                    "Upgrade: websocket\r\nSec-WebSocket-Key: x\r\n\r\n").encode() + data)
                while connection.recv(1 << 16):
                    pass
        self.assertEqual(urllib.request.urlopen(self.address).status, 200)


main(Cases)
