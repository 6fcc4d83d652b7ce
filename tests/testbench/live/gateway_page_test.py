#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""gateway_page_test: tests the page of a gateway. The calls of this page do not pass through the
page's server. The test checks which pages may call, and with which certificate.

Usage: gateway_page_test.py origins|certificate work-folder build-folder
"""
import json
import os
import pty
import re
import socket
import ssl
import struct
import subprocess
import sys
import urllib.error
import urllib.request
from pathlib import Path

from script import TREE, Script, fresh, main, write
from icesoc.util.browser import Browser
from icesoc.web.bridge import frame

BUILD = Path(sys.argv[3]).resolve()


def free_port():
    with socket.create_server(("127.0.0.1", 0)) as server:
        return server.getsockname()[1]


def text(value):
    return bytes([len(value)]) + value.encode()


def request(identity, operation):
    """Returns an Ice request without parameters."""
    body = struct.pack("<i", 1) + text(identity) + b"\0\0" + text(operation) + b"\1\0" \
        + struct.pack("<iBB", 6, 1, 1)
    return b"IceP\1\0\1\0\0\0" + struct.pack("<i", 14 + len(body)) + body


class Cases(Script):
    def setUp(self):
        self.work = fresh(sys.argv[2])

    def start(self, words, wanted):
        """Starts a program. Returns the line of its output that contains the text `wanted`."""
        process = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, text=True)

        def end():
            process.terminate()
            process.communicate(timeout=30)

        self.addCleanup(end)
        said = ""
        for line in process.stdout:
            said += line
            if wanted in line:
                return line
        return self.fail(f"{words[0]} has ended: {said}")

    def gateway(self, *words, wanted):
        """Starts a gateway with a modem that does not answer. Returns a line of its output."""
        master, slave = pty.openpty()
        self.addCleanup(os.close, master)
        self.addCleanup(os.close, slave)
        return self.start([BUILD / "ground/icesoc-gateway", "-d", os.ttyname(slave), "--no-setup",
                           "--wait", "1", *words], wanted)

    def answer(self, port, headers):
        """Makes a call over a WebSocket with these headers. Returns the answer."""
        with socket.create_connection(("127.0.0.1", port), timeout=60) as connection:
            connection.sendall((
                f"GET / HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\n"
                "Connection: Upgrade\r\nSec-WebSocket-Protocol: ice.zeroc.com\r\n"
                "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
                + "".join(f"{name}: {value}\r\n" for name, value in headers.items())
                + "\r\n").encode())
            message = frame(2, request("uav", "getName"))
            connection.sendall(message[:1] + bytes([message[1] | 0x80]) + bytes(4) + message[2:])
            said = b""
            while b"icesoc-gateway: " not in said:
                data = connection.recv(1 << 16)
                if not data:
                    break
                said += data
        return said.decode(errors="replace")

    def test_origins(self):
        """The gateway rejects calls from web pages, except from its own page and from --origin."""
        page, calls = free_port(), free_port()
        self.gateway("--page", f"127.0.0.1:{page}", "--origin", "https://example.org", "--listen",
                     f"tcp -h 127.0.0.1:ws -h 127.0.0.1 -p {calls}", wanted="The vehicle: http")
        own = f"http://127.0.0.1:{page}"
        with urllib.request.urlopen(own) as served:
            cookie = served.headers["Set-Cookie"].split(";")[0]
            self.assertNotIn("Secure", served.headers["Set-Cookie"])
            self.assertIn(f"connect-src 'self' ws://127.0.0.1:{calls} ",
                          served.headers["Content-Security-Policy"])
        with self.assertRaises(urllib.error.HTTPError):
            urllib.request.urlopen(urllib.request.Request(own, headers={"Host": "evil.example"}))
        refused = ({"Origin": "http://evil.example"}, {"Origin": "null"},
                   {"origin": f"http://127.0.0.1:{calls}"},
                   {"Origin": own + ".evil.example"},
                   {"Origin": "http://evil.example", "Cookie": cookie})
        for headers in refused:
            self.assertIn("are not allowed to call", self.answer(calls, headers), headers)
        wrong = cookie[:-1] + ("0" if cookie[-1] != "0" else "1")
        for headers in {"Origin": own}, {"Origin": own, "Cookie": wrong}, \
                {"Origin": own, "Cookie": "x" + cookie}:
            self.assertIn("reload it", self.answer(calls, headers), headers)
        for headers in {}, {"Origin": own, "Cookie": "a=b; " + cookie}, \
                {"Origin": "https://example.org"}:
            self.assertIn("for the radio", self.answer(calls, headers), headers)

    def certificates(self):
        """Makes certificates, and a browser profile that contains the pilot's certificate."""
        for name in "gateway", "pilot":
            self.ask(TREE / "icesoc", "key", self.work / f"{name}.pem", "--certificate")
        database = f"sql:{self.work}/home/.pki/nssdb"
        write("home/Default/Preferences", json.dumps({"profile": {"content_settings": {
            "exceptions": {"auto_select_certificate": {
                "https://127.0.0.1:*,*": {"setting": {"filters": [{}]}}}}}}}))
        Path("home/.pki/nssdb").mkdir(parents=True)
        self.ask("certutil", "-N", "-d", database, "--empty-password")
        self.ask("certutil", "-A", "-d", database, "-n", "authority", "-t", "CT,C,C", "-i",
                 "authority.pem")
        self.ask("openssl", "pkcs12", "-export", "-in", "pilot.pem", "-out", "pilot.p12",
                 "-passout", "pass:pilot", "-name", "pilot")
        self.ask("pk12util", "-i", "pilot.p12", "-d", database, "-W", "pilot")
        public = subprocess.check_output(
            "openssl x509 -in gateway.pem -pubkey -noout | openssl pkey -pubin -outform der |"
            "openssl dgst -sha256 -binary | base64", shell=True, text=True).strip()
        return f"--ignore-certificate-errors-spki-list={public}"

    def form(self, browser, name):
        """Fills the text fields of an operation's form, and submits it. Returns the text that then
        appears."""
        browser.until("document.querySelectorAll('#cards details').length > 0")
        return browser.run(f"""(async () => {{
            const card = [...document.querySelectorAll('#cards details')]
                .find(d => d.innerText.startsWith('{name.split(".")[0]}'));
            card.open = true;
            let form = null;
            while (!form) {{
                await new Promise(r => setTimeout(r, 20));
                form = [...card.querySelectorAll('form')].find(each => each.querySelector('h4')
                    .innerText.split(' ')[0] === '{name.split(".")[1]}');
            }}
            for (const input of form.querySelectorAll('input[type=text]')) input.value = '7';
            form.requestSubmit();
            const output = form.querySelector('output');
            while (!output.innerText || output.innerText.startsWith('calling'))
                await new Promise(r => setTimeout(r, 20));
            return output.innerText;
        }})()""")

    def test_certificate(self):
        """The certificate in the browser decides which calls the page may make."""
        trust = self.certificates()
        page, calls = free_port(), free_port()
        write("rights.json", '[{"who": "CN=pilot", "identities": ["uav"], "operations": '
                             '["isAlive"]}]')
        security = [f"--IceSSL.CAs={self.work}/authority.pem",
                    f"--IceSSL.CertFile={self.work}/gateway.pem"]
        self.gateway("--page", f"127.0.0.1:{page}", "--listen", f"wss -h 127.0.0.1 -p {calls}",
                     "--rights", "rights.json", *security, wanted="The vehicle: https")
        context = ssl.create_default_context(cafile="authority.pem")
        context.check_hostname = False
        with urllib.request.urlopen(f"https://127.0.0.1:{page}", context=context) as served:
            self.assertIn("; Secure", served.headers["Set-Cookie"])
        # without a certificate, the gateway sends an alert or closes the connection before the test
        # reads the alert
        try:
            with context.wrap_socket(socket.create_connection(("127.0.0.1", calls))) as connection:
                connection.sendall(b"GET / HTTP/1.1\r\n\r\n")
                answer = connection.recv(1)
        except (ssl.SSLError, ConnectionError):
            answer = b""
        self.assertEqual(answer, b"")
        with Browser(trust, home=self.work / "home") as browser:
            browser.open(f"https://127.0.0.1:{page}/")
            self.assertIn("'CN=pilot' has no right to call setFlightState of 'uav'",
                          self.form(browser, "uav.setFlightState"))
            self.assertNotIn("has no right", self.form(browser, "uav.isAlive"))
        with Browser(trust) as browser:  # a browser that has no certificate
            browser.open(f"https://127.0.0.1:{page}/")
            self.assertNotRegex(self.form(browser, "uav.setFlightState"), "done|no right")
        self.server_with_tls(trust, security)

    def server_with_tls(self, trust, security):
        """Makes a complete call to a server of stock Ice, which is used instead of the gateway."""
        port, page = self.start(
            ["/usr/bin/python3", TREE / "tests/cli/call_server.py",
             "--Ice.Plugin.IceSSL=IceSSL:createIceSSL", "--Trial.Endpoints=wss -h 127.0.0.1",
             *security], "").strip(), free_port()
        write("build/gen/chip.json", json.dumps({"objects": [
            {"identity": "try", "core": "try", "registers": "", "interface": "::Trial::Try",
             "slice": [str(TREE / "tests/cli/call.ice")]}]}))
        for name in "slice", "page":
            os.symlink(BUILD / name, f"build/{name}")
        said = self.start([TREE / "tools/python", "-m", "icesoc.web.live", "--build", "build",
                           "--vehicle", f"uav1=wss:{port}", "--listen", f"127.0.0.1:{page}",
                           "--certificate", "gateway.pem"], "The vehicle")
        with Browser(trust, home=self.work / "home") as browser:
            browser.open(re.search(r"https://\S+", said)[0])
            self.assertRegex(self.form(browser, "try.add"), r"14\s+done in")


main(Cases)
