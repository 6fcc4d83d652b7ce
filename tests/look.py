#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""look: checks a page in headless Chromium, 420 to 2560 pixels wide, light and dark.

Only elements that scroll are wider than the window, text has a contrast of 4.5 at least to its
background (WCAG 2, AA), and no script ends by an error. Usage: look.py page.html
"""
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path


def browse(address, *options):
    """(the elements of a page when its scripts have run, what the browser said)."""
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as home:
        done = subprocess.run(["chromium", "--headless", "--no-sandbox", "--disable-gpu",
                               "--disable-dev-shm-usage", f"--user-data-dir={home}", "--dump-dom",
                               "--virtual-time-budget=20000", *options, address],
                              capture_output=True, text=True, env={**os.environ, "HOME": home})
    if done.returncode:
        sys.exit(f"chromium: {done.stderr[-1000:]}")
    return done.stdout, done.stderr


def fault(page):
    """What is wrong with a page, or an empty text."""
    page = Path(page).resolve()
    for number, theme in enumerate(("dark", "light")):
        dom, log = browse(f"{Path(__file__).with_suffix('.html').as_uri()}#{theme},{page.as_uri()}",
                          "--allow-file-access-from-files", "--enable-logging=stderr",
                          f"--blink-settings=preferredColorScheme={number}")
        # For a script that ends by an error: the page's line and its text.
        uncaught = r':CONSOLE\S* "(Uncaught .*)", source: file:\S* \((\d+)\)$'
        if error := re.search(uncaught, log, re.M):
            line = page.read_text().split("\n")[int(error[2]) - 1].strip()
            return f"{page.name}:{error[2]}: {error[1]}: {line[:120]}"
        said = re.findall(r"looked at (\d+; .*)\.", dom)
        if not said or not said[-1].endswith("; "):
            return f"{page}: {said[-1] if said else 'Chromium did not end: ' + log[-1000:]}"
    return ""


if __name__ == "__main__":
    sys.exit(fault(sys.argv[1]) or 0)
