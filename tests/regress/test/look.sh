#!/bin/sh
# SPDX-License-Identifier: MIT
#
# look: checks a page in headless Chromium, 420 to 2560 pixels wide, light and dark: only elements that scroll are wider
# than the window, text has a contrast of 4.5 at least to its background (WCAG 2, AA), and no script ends by an error.
# Usage: look.sh page.html
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT TERM HUP
cat >"$work/look.html" <<END
<!doctype html>
<body>
<script>
"use strict";
const page = "file://$(readlink -f "$1")";
END
cat >>"$work/look.html" <<'END'
const wrong = new Set();
const numbers = text => text.match(/[\d.]+/g).map(Number);
const luminance = rgb => rgb.slice(0, 3).map(c => c / 255).map(c => c <= 0.03928 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4)
  .reduce((sum, c, i) => sum + c * [0.2126, 0.7152, 0.0722][i], 0);
const over = (top, below) => { const a = top[3] ?? 1; return below.map((c, i) => a * top[i] + (1 - a) * c); };
const theme = location.hash.slice(1), canvas = theme === "dark" ? [18, 18, 18] : [255, 255, 255]; // Chromium's own
function background(node) {
  if (!node) return canvas;
  const own = numbers(node.ownerDocument.defaultView.getComputedStyle(node).backgroundColor);
  return own[3] === undefined ? own : own[3] === 0 ? background(node.parentElement) : over(own, background(node.parentElement));
}
const scrolls = e => e && (e.ownerDocument.defaultView.getComputedStyle(e).overflowX !== "visible" || scrolls(e.parentElement));
function look(document, width, theme) {
  const place = `${theme}, ${width} wide: `, root = document.documentElement;
  if (document.defaultView.matchMedia("(prefers-color-scheme: dark)").matches !== (theme === "dark")) wrong.add(place + "is of the other theme");
  if (root.scrollWidth > width) {
    const wide = [...document.body.querySelectorAll("*")].filter(e => e.getBoundingClientRect().right > width + 1 && !scrolls(e.parentElement));
    wrong.add(`${place}${root.scrollWidth} are needed, by ${wide.slice(0, 3).map(e => `${e.tagName} ${e.id || e.className}`).join(", ")}`);
  }
  for (const e of document.body.querySelectorAll("*")) {
    const style = document.defaultView.getComputedStyle(e);
    if (![...e.childNodes].some(n => n.nodeType === 3 && n.data.trim()) || !e.getClientRects().length || style.visibility !== "visible" || /^(SCRIPT|STYLE|OPTION)$/.test(e.tagName)) continue;
    const below = background(e), ink = over(numbers(e.namespaceURI.endsWith("svg") ? style.fill : style.color), below);
    const [a, b] = [luminance(ink), luminance(below)].sort((x, y) => y - x), contrast = (a + 0.05) / (b + 0.05);
    if (contrast < 4.5) wrong.add(`${theme}: contrast ${contrast.toFixed(1)} of ${e.tagName} ${e.id || e.className.baseVal || e.className}`);
  }
  return [...document.body.querySelectorAll("*")].length;
}
const widths = [420, 900, 1400, 2560];
let left = widths.length, elements = 0;
for (const width of widths) {
  const frame = document.createElement("iframe");
  frame.width = width;
  frame.height = 900;
  frame.style.border = 0;
  frame.onload = () => setTimeout(() => { // tables and charts are made when the page has loaded
    elements += look(frame.contentDocument, width, theme);
    if (--left === 0) document.body.append(`looked at ${elements}; ${[...wrong].join("; ")}.`);
  }, 1000);
  frame.src = page;
  document.body.append(frame);
}
</script>
END
for theme in dark light; do
    [ $theme = dark ] && number=0 || number=1
    HOME=$work chromium --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --user-data-dir="$work/chromium" --allow-file-access-from-files --enable-logging=stderr \
        --blink-settings=preferredColorScheme=$number --virtual-time-budget=20000 --dump-dom "file://$work/look.html#$theme" >"$work/dom" 2>"$work/log" ||
        { tail -3 "$work/log" >&2 && exit 1; }
    # For a script that ends by an error: the page's line and its text.
    error=$(sed -n 's|.*:CONSOLE[^ ]* "\(Uncaught .*\)", source: file:[^ ]* (\([0-9]*\))$|\2: \1|p' "$work/log" | head -1)
    [ -z "$error" ] || { echo "$1:$error: $(sed -n "${error%%:*}s/^ *\(.\{0,120\}\).*/\1/p" "$1")" >&2 && exit 1; }
    said=$(sed -n 's/.*looked at \([0-9]*; .*\)\..*/\1/p' "$work/dom" | tail -1)
    case $said in
    [0-9]*"; ") ;;
    *) echo "$1: ${said:-Chromium did not end: $(tail -3 "$work/log")}" >&2 && exit 1 ;;
    esac
done
