# SPDX-License-Identifier: MIT
"""browser: drives a headless Chromium through its debugging pipe: opens pages, runs scripts in
them, presses keys, takes pictures. Only this module starts Chromium."""
import base64
import json
import os
import subprocess
import tempfile
import time
from pathlib import Path


class Browser:
    """A Chromium with one page, for use with `with`. `errors`: exceptions in scripts, and errors in
    the page's log."""

    def __init__(self, *options, width=1400, height=1000, home=None):
        """home: folder for the profile and certificates; by default a temporary folder."""
        self.temporary = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        folder = home or self.temporary.name
        commands, self.send_to = os.pipe()
        self.read_from, answers = os.pipe()

        def connect():  # Chromium reads commands from file descriptor 3, and writes answers to 4
            high = os.dup(answers), os.dup(commands)
            os.dup2(high[1], 3)
            os.dup2(high[0], 4)

        self.process = subprocess.Popen(
            ["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
             "--remote-debugging-pipe", f"--user-data-dir={folder}",
             "--hide-scrollbars", f"--window-size={width},{height}", *options, "about:blank"],
            close_fds=False, preexec_fn=connect, stdout=subprocess.DEVNULL,
            # Chromium leaves its temporary files behind, because it is killed
            stderr=subprocess.DEVNULL, env={**os.environ, "HOME": str(folder),
                                            "TMPDIR": self.temporary.name})
        os.close(commands)
        os.close(answers)
        self.stream, self.number, self.session, self.errors = b"", 0, None, []
        target = next(each for each in self.ask("Target.getTargets")["targetInfos"]
                      if each["type"] == "page")
        self.session = self.ask("Target.attachToTarget", targetId=target["targetId"],
                                flatten=True)["sessionId"]
        for domain in "Page", "Runtime", "Log":
            self.ask(f"{domain}.enable")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()
        os.close(self.send_to)
        os.close(self.read_from)
        self.temporary.cleanup()

    def receive(self):
        while b"\0" not in self.stream:
            data = os.read(self.read_from, 1 << 16)
            if not data:
                raise RuntimeError("Chromium has ended")
            self.stream += data
        text, _, self.stream = self.stream.partition(b"\0")
        return json.loads(text)

    def ask(self, method, **parameters):
        """Returns the answer to a command of the DevTools protocol."""
        self.number += 1
        command = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            command["sessionId"] = self.session
        os.write(self.send_to, json.dumps(command).encode() + b"\0")
        while (answer := self.receive()).get("id") != self.number:
            self.note(answer)
        if "error" in answer:
            raise RuntimeError(f"{method}: {answer['error']}")
        return answer["result"]

    def note(self, event):
        """Records an event."""
        if event.get("method") == "Runtime.exceptionThrown":
            self.errors.append(event["params"]["exceptionDetails"])
        elif event.get("method") == "Log.entryAdded":
            if (entry := event["params"]["entry"])["level"] == "error":
                self.errors.append(entry)

    def pass_time(self, milliseconds):
        """Advances the page's timers by this time, without waiting in real time."""
        self.ask("Emulation.setVirtualTimePolicy", policy="pauseIfNetworkFetchesPending",
                 budget=milliseconds)
        while (event := self.receive()).get("method") != "Emulation.virtualTimeBudgetExpired":
            self.note(event)

    def elements(self):
        """Returns the page's elements as HTML."""
        return self.run("document.documentElement.outerHTML")

    def shoot(self, path):
        """Saves a picture of the window."""
        data = self.ask("Page.captureScreenshot", format="png")["data"]
        Path(path).write_bytes(base64.b64decode(data))

    def open(self, address):
        """Opens a page and waits until it is loaded."""
        self.ask("Page.navigate", url=address)
        self.until("document.readyState === 'complete'")

    def run(self, script):
        """Returns the value of an expression in the page; waits for a promise."""
        answer = self.ask("Runtime.evaluate", expression=script, awaitPromise=True,
                          returnByValue=True, userGesture=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(answer["exceptionDetails"].get("exception", {}).get("description"))
        return answer["result"].get("value")

    def until(self, condition, seconds=600):
        """Waits until an expression is true, and returns its value. The default time-out is long,
        so that a test does not fail because the machine is loaded."""
        end = time.monotonic() + seconds
        while not (value := self.run(condition)):
            if time.monotonic() > end:
                raise RuntimeError(f"not true within {seconds} s: {condition}; the page has: "
                                   + self.run("document.body.innerText")[-3000:])
            time.sleep(0.05)
        return value

    def choose(self, selector, path):
        """Selects a file in the file input that `selector` matches."""
        root = self.ask("DOM.getDocument")["root"]["nodeId"]
        node = self.ask("DOM.querySelector", nodeId=root, selector=selector)["nodeId"]
        self.ask("DOM.setFileInputFiles", nodeId=node, files=[str(path)])

    def press(self, *keys):
        """Presses keys one after the other. A key is a name such as Tab, or one character."""
        codes = {"Tab": 9, "Enter": 13, " ": 32}
        for key in keys:
            text = "\r" if key == "Enter" else key if len(key) == 1 else ""
            more = {"key": key, "windowsVirtualKeyCode": codes.get(key, 0)}
            self.ask("Input.dispatchKeyEvent", type="keyDown", **more,
                     **({"text": text} if text else {}))
            self.ask("Input.dispatchKeyEvent", type="keyUp", **more)

    def resize(self, width, height, dark=False):
        self.ask("Emulation.setDeviceMetricsOverride", width=width, height=height,
                 deviceScaleFactor=1, mobile=False)
        self.ask("Emulation.setEmulatedMedia", features=[
            {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])


def elements(address, *options, **size):
    """Opens a page, advances its timers by 20 s, and returns the page's elements."""
    with Browser(*options, **size) as browser:
        browser.open(address)
        browser.pass_time(20000)
        return browser.elements()


def fault(page):
    """Opens a page, and returns the first exception in its scripts, with line and text; "" if
    no exception occurred."""
    page = Path(page).resolve()
    with Browser() as browser:
        browser.open(page.as_uri())
        browser.pass_time(20000)
        found = next((each for each in browser.errors if "exception" in each), None)
    if not found:
        return ""
    number, lines = found["lineNumber"], page.read_text().split("\n")
    what = found["exception"].get("description", found["text"]).split("\n")[0]
    return f"{page.name}:{number + 1}: Uncaught {what}: {lines[number].strip()[:120]}"
