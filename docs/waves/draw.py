#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""draw: draws the waveforms of this folder, NAME.json (WaveJSON), as NAME.svg, by WaveDrom in
headless Chromium.

    draw.py FOLDER [--check]    FOLDER: for WaveDrom, which is fetched; --check: writes nothing, and
                                says which drawing is old
"""
import html
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
# A drawing keeps only the shapes of WaveDrom that it uses. Its background is light, also on a dark
# page.
PAGE = """<!doctype html><meta charset="utf-8"><body>
<script src="%s/wavedrom.unpkg.min.js"></script><script>
const draw = wave => {
    const tree = wavedrom.renderAny(0, wave, wavedrom.waveSkin);
    const text = wavedrom.onml.stringify(tree);
    const used = shape => !shape[1]?.id || text.includes("#" + shape[1].id);
    tree[1].style = "background:#fff";
    return wavedrom.onml.stringify(
        tree.map(node => node[0] === "defs" && Array.isArray(node) ? node.filter(used) : node));
};
document.body.textContent = JSON.stringify(%s.map(draw));
</script>"""


def drawn(folder, waves):
    with tempfile.TemporaryDirectory() as work:
        page = pathlib.Path(work, "page.html")
        page.write_text(PAGE % (folder, json.dumps(waves)))
        dom = subprocess.run(["chromium", "--headless", "--no-sandbox", "--disable-gpu",
                              "--disable-dev-shm-usage", f"--user-data-dir={work}", "--dump-dom",
                              page.as_uri()], capture_output=True, text=True,
                             env={**os.environ, "HOME": work}).stdout
    found = re.search("<body>(\\[.*\\])\n?</body>", dom, re.DOTALL)
    if not found:
        sys.exit("draw: WaveDrom gave no drawing: " + dom)
    return json.loads(html.unescape(found[1]))


def main(folder, *options):
    fetched = subprocess.run([HERE / "../../cmake/fetch.py", "wavedrom", folder])
    if fetched.returncode:
        sys.exit(fetched.returncode)
    files = sorted(HERE.glob("*.json"))
    waves = [json.loads(file.read_text()) for file in files]
    for file, svg in zip(files, drawn(pathlib.Path(folder).resolve(), waves)):
        picture = file.with_suffix(".svg")
        if "--check" not in options:
            picture.write_text(svg + "\n")
        elif not picture.exists() or picture.read_text() != svg + "\n":
            sys.exit(f"{picture} is not drawn from {file.name}: docs/waves/draw.py {folder}, and "
                     "commit it")


main(*sys.argv[1:]) if len(sys.argv) > 1 else sys.exit(__doc__)
