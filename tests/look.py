#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""look: opens a page in headless Chromium and reports whether one of its scripts failed.

Usage: look.py page.html
"""
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path


def browse(address, *options):
    """Returns (the elements of a page when its scripts have run, the browser's output)."""
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as home:
        done = subprocess.run(["chromium", "--headless", "--no-sandbox", "--disable-gpu",
                               "--disable-dev-shm-usage", f"--user-data-dir={home}", "--dump-dom",
                               "--virtual-time-budget=20000", "--enable-logging=stderr",
                               *options, address],
                              capture_output=True, text=True, env={**os.environ, "HOME": home})
    if done.returncode:
        sys.exit(f"chromium: {done.stderr[-1000:]}")
    return done.stdout, done.stderr


def fault(page):
    """A script's error, with the page's line and its text, or an empty text."""
    page = Path(page).resolve()
    uncaught = r':CONSOLE\S* "(Uncaught .*)", source: file:\S* \((\d+)\)$'
    if error := re.search(uncaught, browse(page.as_uri())[1], re.M):
        line = page.read_text().split("\n")[int(error[2]) - 1].strip()
        return f"{page.name}:{error[2]}: {error[1]}: {line[:120]}"
    return ""


if __name__ == "__main__":
    sys.exit(fault(sys.argv[1]) or 0)
