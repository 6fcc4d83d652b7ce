// SPDX-License-Identifier: MIT
//
// page: the utilisation report at work: tables to sort, a chart to look into, history, differences.
"use strict";
const data = JSON.parse(document.getElementById("data").textContent);
const byId = id => document.getElementById(id);
const share = (part, whole) => (100 * part / whole).toFixed(1) + " %";
const signed = n => n > 0 ? "+" + n : String(n);
const usable = data.designs.filter(d => d.figures);
let picked = usable[0], path = "", sortBy = null, sortUp = false;

function element(tag, text, className) {
  const e = document.createElement(tag);
  if (text !== undefined) e.textContent = text;
  if (className) e.className = className;
  return e;
}
function fill(table, head, rows) { // cells: text, [text, class], or an element
  table.replaceChildren();
  const line = (cells, tag) => {
    const tr = element("tr");
    for (const c of cells) {
      const td = Array.isArray(c) ? element(tag, c[0], c[1]) : c instanceof Node ? element(tag) : element(tag, c);
      if (c instanceof Node) td.append(c);
      tr.append(td);
    }
    return tr;
  };
  table.createTHead().append(line(head, "th"));
  table.append(element("tbody"));
  for (const row of rows) table.tBodies[0].append(line(row, "td"));
}
function shape(tag, attributes, text) {
  const e = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [k, v] of Object.entries(attributes)) e.setAttribute(k, v);
  if (text !== undefined) e.textContent = text;
  return e;
}

// ---- Verdict and the paper's table
function showVerdict() {
  const failures = data.designs.flatMap(d => d.failures), notes = data.designs.flatMap(d => d.notes);
  const box = byId("verdict");
  const stale = data.designs.filter(d => d.error && !d.failures.length).length;
  box.append(element("p", failures.length ? "Failed" : stale ? `${stale} of ${data.designs.length} designs changed since they were synthesised` : "Within all budgets",
    failures.length ? "bad" : stale ? "soft" : "good"));
  for (const f of failures) box.append(element("p", f, "bad"));
  for (const n of notes) box.append(element("p", n, "soft"));
  byId("about").textContent = `${data.chip.name}, ${data.yosys}, commit ${data.commit || "unknown"}`;
}
function showPaper() {
  const d = usable.find(d => d.paper);
  if (!d) return;
  byId("paper-title").textContent = d.title;
  const names = { ff: "flip-flops", lut: "LUTs of the netlist", map: "LUTs as map counts them, with route-throughs",
    slices: `slices (estimate, ${(100 * data.slicesError).toFixed(0)} % off on average)` };
  fill(byId("paper"), ["", "here", data.chip.name, "paper", "here / paper", "limit", "accepted", ""],
    ["ff", "lut", "map", "slices"].map(row => {
      const k = row === "map" ? "lut" : row, limit = d.limits[k];
      const value = d.figures[k] + (row === "map" ? d.figures.through : 0);
      return [names[row], value + (k === "slices" ? ` (${d.figures.low} to ${d.figures.high})` : ""),
        share(value, data.chip[k]), `${data.paper[k]} (${share(data.paper[k], data.chip[k])})`,
        (value / data.paper[k]).toFixed(2), limit ?? "", d.accepted && row !== "map" ? `${d.accepted[k]} (${signed(value - d.accepted[k])})` : "",
        limit === undefined ? "" : value <= limit ? ["ok", "good"] : [`${value - limit} over`, "bad"]];
    }));
}

// ---- The table of designs
const columns = [
  ["design", d => d.name], ["LUT", d => d.figures.lut, d => {
    const span = element("span"), bar = element("span", "", "share");
    bar.style.width = 60 * d.figures.lut / data.chip.lut + "px";
    span.append(bar, String(d.figures.lut));
    return span;
  }],
  ["of chip", d => d.figures.lut, d => share(d.figures.lut, data.chip.lut)],
  ["change", d => d.accepted ? d.figures.lut - d.accepted.lut : -1e9, d => change(d, "lut")],
  ["LUT6", d => d.figures.luts[5]], ["RAM", d => d.figures.lutRam], ["SRL", d => d.figures.shift], ["thru", d => d.figures.through],
  ["FF", d => d.figures.ff], ["change ", d => d.accepted ? d.figures.ff - d.accepted.ff : -1e9, d => change(d, "ff")],
  ["sets", d => d.figures.sets], ["carry", d => d.figures.carry], ["RAM16", d => d.figures.ram], ["DSP", d => d.figures.dsp],
  ["pins", d => d.figures.pins], ["slices", d => d.figures.slices], ["from-to", d => d.figures.low, d => `${d.figures.low}-${d.figures.high}`],
  ["levels", d => d.figures.timing.paths[0]?.levels ?? 0],
  ["MHz", d => d.figures.mhz, d => d.figures.mhz ? [clock(d.figures), d.figures.mhz < data.chip.mhz ? "bad" : ""] : ""],
];
for (const family of Object.keys(usable[0]?.others ?? {}))
  for (const key of ["lut", "ff"])
    columns.push([`${family} ${key.toUpperCase()}`, d => d.others?.[family]?.[key] ?? 0]);
// The clock, and between which it is with the netlist in other orders.
function clock(f) {
  return f.mhz.toFixed(0) + (f.clocks.length ? ` (${f.mhzRange.map(mhz => mhz.toFixed(0)).join("-")})` : "");
}
function change(d, key) {
  if (!d.accepted) return ["new", "soft"];
  const by = d.figures[key] - d.accepted[key];
  return by === 0 ? "" : [signed(by), d.figures[key] > d.budget[key] ? "bad" : by < 0 ? "good" : ""];
}
function showDesigns() {
  const rows = usable.slice();
  if (sortBy !== null) {
    const key = columns[sortBy][1];
    rows.sort((a, b) => (key(a) < key(b) ? -1 : key(a) > key(b) ? 1 : 0) * (sortUp ? 1 : -1));
  }
  const table = byId("designs");
  fill(table, columns.map(c => c[0]), rows.map(d => columns.map(c => (c[2] ?? c[1])(d))));
  [...table.tHead.rows[0].cells].forEach((th, i) => {
    if (i === sortBy) th.className = sortUp ? "up" : "down";
    th.onclick = () => { sortUp = sortBy === i ? !sortUp : i === 0; sortBy = i; showDesigns(); };
  });
  [...table.tBodies[0].rows].forEach((tr, i) => {
    if (rows[i] === picked) tr.className = "picked";
    tr.onclick = () => { picked = rows[i]; path = ""; show(); };
  });
}

// ---- The chart of the hierarchy
function treeOf(costs) { // {name, path, own: [LUT, FF], sum: [LUT, FF], children}
  const root = { name: "", path: "", own: [0, 0], sum: [0, 0], children: [] }, known = { "": root };
  const node = p => known[p] ??= (() => {
    const dot = p.lastIndexOf("."), n = { name: p.slice(dot + 1), path: p, own: [0, 0], sum: [0, 0], children: [] };
    node(dot < 0 ? "" : p.slice(0, dot)).children.push(n);
    return n;
  })();
  for (const [p, signals] of Object.entries(costs))
    for (const c of Object.values(signals))
      for (let i = 0; i < 2; i++) {
        node(p).own[i] += c[i];
        for (let q = p; ; q = q.slice(0, Math.max(0, q.lastIndexOf(".")))) { node(q).sum[i] += c[i]; if (!q) break; }
      }
  return { root, known };
}
const colour = text => { let h = 0; for (const c of text) h = (h * 31 + c.charCodeAt(0)) % 360; return `hsl(${h} 55% 72%)`; };
function showChart() {
  const metric = Number(byId("metric").value), { root, known } = treeOf(picked.costs), top = known[path] ?? root;
  const svg = byId("chart"), width = 1160, rowHeight = 34, depth = 4;
  svg.setAttribute("viewBox", `0 0 ${width} ${rowHeight * depth}`);
  svg.replaceChildren();
  const draw = (n, x, w, level) => {
    if (level >= depth || w < 1) return;
    const label = n.name || picked.top, module = picked.modules?.[n.path];
    const box = shape("rect", { x, y: level * rowHeight, width: w, height: rowHeight - 1, fill: colour(n.path), "data-path": n.path });
    box.append(shape("title", {}, `${n.path || picked.top}${module ? " (" + module + ")" : ""}: ${n.sum[0]} LUT, ${n.sum[1]} FF`));
    box.onclick = () => { path = n.path === path ? path.slice(0, Math.max(0, path.lastIndexOf("."))) : n.path; showInside(); };
    svg.append(box);
    if (w > 46) svg.append(shape("text", { x: x + 4, y: level * rowHeight + 21 }, `${label} ${n.sum[metric]}`.slice(0, Math.floor(w / 7))));
    let at = x;
    for (const c of n.children.slice().sort((a, b) => b.sum[metric] - a.sum[metric])) {
      const part = n.sum[metric] ? w * c.sum[metric] / n.sum[metric] : 0;
      draw(c, at, part, level + 1);
      at += part;
    }
  };
  draw(top, 0, width, 0);
  const crumbs = byId("crumbs"), parts = path ? path.split(".") : [];
  crumbs.replaceChildren();
  [picked.top, ...parts].forEach((p, i) => {
    const a = element("a", p);
    a.onclick = () => { path = parts.slice(0, i).join("."); showInside(); };
    crumbs.append(i ? " / " : "", a);
  });
}
function showInside() {
  byId("inside").textContent = `Inside ${picked.name}: ${picked.title}`;
  showChart();
  const metric = Number(byId("metric").value), here = [];
  for (const [p, signals] of Object.entries(picked.costs))
    if (p === path || (path === "" || p.startsWith(path + ".")))
      for (const [s, c] of Object.entries(signals)) here.push([(p ? p + "." : "").slice(path ? path.length + 1 : 0) + s, c]);
  here.sort((a, b) => b[1][metric] - a[1][metric] || b[1][1 - metric] - a[1][1 - metric]);
  fill(byId("signals"), ["signal", "LUT", "of these RAM", "FF"], here.slice(0, 200).map(([n, c]) => [n, c[0], c[2] || "", c[1]]));
  const box = byId("paths");
  box.replaceChildren();
  for (const p of picked.figures.timing.paths) {
    const d = element("details");
    d.append(element("summary", `${p.ns.toFixed(2)} ns (-3), ${(p.ns * data.slowGrade).toFixed(2)} (-2), ${p.levels} levels: ${p.from} to ${p.to} ${p.pin}`));
    const t = element("table");
    fill(t, ["cell", "net", "fan-out", "cell ns", "net ns"], p.steps.map(s => [s[0], s[1] || "(no name left)", s[2], s[3].toFixed(3), s[4].toFixed(3)]));
    d.append(t);
    box.append(d);
  }
  const picture = byId("picture"), module = path ? picked.modules?.[path] : picked.top;
  picture.replaceChildren();
  if (data.pictures[module]) {
    const d = element("details"), body = element("div");
    d.append(element("summary", `Netlist of ${module}`), body);
    body.innerHTML = data.pictures[module];
    picture.append(d);
  }
}

// ---- History and differences
function points() { // oldest first; the last is now
  const now = { id: "now", date: "", subject: "this run", designs: {} };
  for (const d of usable) {
    now.designs[d.name] = { ...d.figures, instances: {} };
    for (const [p, signals] of Object.entries(d.costs))
      now.designs[d.name].instances[p] = Object.values(signals).reduce((s, c) => [s[0] + c[0], s[1] + c[1]], [0, 0]);
  }
  return [...data.history].reverse().concat(now);
}
const all = points();
function showHistory() {
  const svg = byId("history"), width = 1160, height = 220, series = all.map(c => c.designs[picked.name]);
  svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
  svg.replaceChildren();
  const keys = [["lut", "LUT", "#3b7dd8"], ["ff", "FF", "#d8763b"], ["slices", "slices", "#3ba55d"]];
  const most = Math.max(1, ...series.flatMap(s => s ? keys.map(k => s[k[0]]) : []), ...Object.values(picked.limits));
  const x = i => 60 + (width - 160) * (all.length > 1 ? i / (all.length - 1) : 0.5), y = v => height - 30 - (height - 50) * v / most;
  for (const part of [0, 0.5, 1]) svg.append(shape("text", { x: 4, y: y(part * most) + 4 }, String(Math.round(part * most))),
    shape("line", { x1: 56, x2: width - 96, y1: y(part * most), y2: y(part * most), stroke: "currentColor", "stroke-opacity": 0.15 }));
  for (const [key, label, stroke] of keys) {
    const line = series.map((s, i) => s ? `${x(i)},${y(s[key])}` : null).filter(p => p);
    svg.append(shape("polyline", { points: line.join(" "), fill: "none", stroke, "stroke-width": 2 }));
    series.forEach((s, i) => {
      if (!s) return;
      const dot = shape("circle", { cx: x(i), cy: y(s[key]), r: 4, fill: stroke });
      dot.append(shape("title", {}, `${all[i].id} ${all[i].date} ${all[i].subject}: ${s[key]} ${label}`));
      svg.append(dot);
    });
    const last = series[series.length - 1];
    if (last) svg.append(shape("text", { x: width - 90, y: y(last[key]) + 4 }, `${last[key]} ${label}`));
    if (picked.limits[key]) svg.append(shape("line", { x1: 56, x2: width - 96, y1: y(picked.limits[key]), y2: y(picked.limits[key]), stroke, "stroke-dasharray": "6 4" }));
  }
  all.forEach((c, i) => svg.append(shape("text", { x: x(i) - 20, y: height - 8 }, c.id)));
}
function showDifference() {
  const a = all[byId("from").value], b = all[byId("to").value];
  const names = [...new Set([...Object.keys(a.designs), ...Object.keys(b.designs)])].sort();
  const by = (x, y, k) => { const d = (y?.[k] ?? 0) - (x?.[k] ?? 0); return d ? [signed(d), d > 0 ? "bad" : "good"] : ""; };
  fill(byId("difference"), ["design", "LUT", "", "FF", "", "slices", ""],
    names.map(n => [a.designs[n], b.designs[n], n]).filter(([x, y]) => ["lut", "ff", "slices"].some(k => x?.[k] !== y?.[k]))
      .map(([x, y, n]) => [n, y?.lut ?? "gone", by(x, y, "lut"), y?.ff ?? "", by(x, y, "ff"), y?.slices ?? "", by(x, y, "slices")]));
  const before = a.designs[picked.name]?.instances ?? {}, after = b.designs[picked.name]?.instances ?? {};
  byId("difference-inside").textContent = `Instances of ${picked.name}`;
  fill(byId("instances"), ["instance (without those below)", "LUT", "", "FF", ""],
    [...new Set([...Object.keys(before), ...Object.keys(after)])].map(p => [p, before[p] ?? [0, 0], after[p] ?? [0, 0]])
      .filter(([, x, y]) => x[0] !== y[0] || x[1] !== y[1]).sort((l, r) => Math.abs(r[2][0] - r[1][0]) - Math.abs(l[2][0] - l[1][0]))
      .map(([p, x, y]) => [p || picked.top, y[0], by(x, y, 0), y[1], by(x, y, 1)]));
}
function show() { showDesigns(); showInside(); showHistory(); showDifference(); }

for (const [id, chosen] of [["from", Math.max(0, all.length - 2)], ["to", all.length - 1]]) {
  all.forEach((c, i) => { const o = element("option", `${c.id} ${c.date} ${c.subject}`.slice(0, 70)); o.value = i; byId(id).append(o); });
  byId(id).value = chosen;
  byId(id).onchange = showDifference;
}
byId("metric").onchange = showInside;
showVerdict();
showPaper();
if (picked) show();
// "#design/instance.path" opens the page there.
const [wanted, inside] = decodeURIComponent(location.hash.slice(1)).split("/");
if (wanted && usable.some(d => d.name === wanted)) { picked = usable.find(d => d.name === wanted); path = inside ?? ""; show(); }
