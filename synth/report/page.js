// SPDX-License-Identifier: MIT
//
// page: the utilisation report at work: tables to sort, trees to fold, history, differences.
const data = JSON.parse(document.getElementById("data").textContent);
const byId = id => document.getElementById(id);
const share = (part, whole) => (100 * part / whole).toFixed(1) + " %";
const signed = n => n > 0 ? "+" + n : String(n);
const usable = data.designs.filter(d => d.figures);
let picked = usable[0], path = "", sortBy = null, sortUp = false, folded = null;
const openFolders = new Set();

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
// File and line of a signal of the picked design, as a link; "" where it is not known.
function place(signal) {
  const at = picked.figures.nets.places[signal.replace(/\[\d+\]$/, "")];
  if (!at) return "";
  const a = element("a", at);
  a.href = "../../" + at.replace(/:\d+$/, "");
  return a;
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
// The chip as the whole of it, or the largest design that there is, fills it, beside what the paper's own takes of it.
function showChip() {
  const d = usable.find(d => d.limits.lut === data.chip.lut) ?? usable.reduce((a, b) => b.figures.lut > a.figures.lut ? b : a), f = d.figures;
  byId("chip-title").textContent = `${data.chip.name}, filled by ${d.name}`;
  for (const [name, key] of [["LUT", "lut"], ["FF", "ff"], ["DSP", "dsp"], ["block RAM", "ram"], ["slices", "slices"]]) {
    const box = element("div"), meter = element("div", undefined, "meter"), part = element("i", undefined, f[key] > data.chip[key] ? "full" : "");
    part.style.width = Math.min(100, 100 * f[key] / data.chip[key]) + "%";
    meter.append(part);
    box.append(element("b", String(f[key])), ` ${name}`, element("span", `${share(f[key], data.chip[key])} of ${data.chip[key]}`), meter);
    if (data.paper[key]) box.append(element("div", `the paper's Table I: ${share(data.paper[key], data.chip[key])}`, "soft"));
    byId("chip").append(box);
  }
  const box = element("div");
  box.append(element("b", f.mhz ? clock(f) : "no path", f.mhz < data.chip.mhz ? "bad" : "good"), " MHz", element("div", `${data.chip.mhz} are wanted; median and range of the netlist's orders`, "soft"));
  byId("chip").append(box);
}
function showCores() {
  byId("cores-part").hidden = !data.cores?.length;
  if (data.cores?.length) fill(byId("cores"), data.cores[0], data.cores.slice(1));
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
  ["design", d => d.name], ["LUT", d => d.figures.lut, d => bar(d.figures.lut, data.chip.lut)],
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
// Modules stand in their folders, which fold; sorted or filtered, all are one list.
function showDesigns() {
  const words = byId("filter").value.toLowerCase().split(/\s+/), table = byId("designs");
  const rows = usable.filter(d => words.every(w => `${d.name} ${d.file} ${d.title}`.toLowerCase().includes(w)));
  const folderOf = d => d.limits.lut ? "" : d.file.startsWith("build/") ? "generated" : d.file.replace(/\/[^/]*$/, "");
  const grouped = sortBy === null && !byId("filter").value, lines = []; // [cells, design or folder]
  if (sortBy !== null) {
    const key = columns[sortBy][1];
    rows.sort((a, b) => (key(a) < key(b) ? -1 : key(a) > key(b) ? 1 : 0) * (sortUp ? 1 : -1));
  }
  const cells = d => columns.map(c => (c[2] ?? c[1])(d));
  if (!grouped) rows.forEach(d => lines.push([cells(d), d]));
  else for (const folder of [...new Set(rows.map(folderOf))].sort()) {
    const members = rows.filter(d => folderOf(d) === folder), open = openFolders.has(folder);
    if (folder) lines.push([[`${open ? "\u25be" : "\u25b8"} ${folder}, ${members.length} ${members.length === 1 ? "module" : "modules"}`], folder]);
    if (!folder || open) for (const d of members) lines.push([cells(d), d]);
  }
  fill(table, columns.map(c => c[0]), lines.map(([line]) => line));
  [...table.tHead.rows[0].cells].forEach((th, i) => {
    if (i === sortBy) th.className = sortUp ? "up" : "down";
    press(th, () => { sortUp = sortBy === i ? !sortUp : i === 0; sortBy = i; showDesigns(); });
  });
  [...table.tBodies[0].rows].forEach((tr, i) => {
    const what = lines[i][1];
    if (what === picked) tr.className = "picked";
    if (typeof what === "string") {
      tr.cells[0].colSpan = columns.length;
      tr.setAttribute("aria-expanded", openFolders.has(what));
    }
    press(tr, () => {
      if (typeof what !== "string") { pick(what, ""); return; }
      if (!openFolders.delete(what)) openFolders.add(what);
      showDesigns();
      byId("designs").tBodies[0].rows[i].focus();
    });
  });
}
function press(node, action) { // by the pointer, or by Enter and the space bar
  node.tabIndex = 0;
  node.onclick = action;
  node.onkeydown = event => { if (event.key === "Enter" || event.key === " ") { event.preventDefault(); action(); } };
}

// ---- The tree of instances
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
function bar(value, whole) {
  const span = element("span"), part = element("span", "", "share");
  part.style.width = (whole ? 60 * value / whole : 0) + "px";
  span.append(part, String(value));
  return span;
}
// Rows in the order of their LUTs; what is folded is not there, and with a filter only what fits it and what leads there.
function showTree(focus) {
  const { root, known } = treeOf(picked.costs), wanted = byId("within").value.toLowerCase(), rows = [];
  folded ??= new Set(Object.keys(known).filter(p => p.includes(".") && known[p].children.length));
  const name = n => `${n.path} ${picked.modules?.[n.path] ?? ""}`.toLowerCase();
  const fits = n => name(n).includes(wanted) || n.children.some(fits);
  const walk = (n, level) => {
    if (wanted && !fits(n)) return;
    rows.push([n, level]);
    if (wanted || !folded.has(n.path)) n.children.slice().sort((a, b) => b.sum[0] - a.sum[0] || b.sum[1] - a.sum[1]).forEach(c => walk(c, level + 1));
  };
  walk(root, 1);
  fill(byId("tree"), ["instance", "LUT", "its own", "FF", "its own", "module"], rows.map(([n, level]) => {
    const cell = element("span"), leaf = !n.children.length;
    cell.style.paddingLeft = 1.2 * (level - 1) + "em";
    const fold = element("span", leaf ? "" : folded.has(n.path) && !wanted ? "\u25b8" : "\u25be", "fold");
    cell.append(fold, n.name || picked.top);
    return [cell, bar(n.sum[0], root.sum[0]), leaf ? "" : n.own[0], bar(n.sum[1], root.sum[1]), leaf ? "" : n.own[1], [picked.modules?.[n.path] ?? "", "text"]];
  }));
  const lines = [...byId("tree").tBodies[0].rows];
  lines.forEach((tr, i) => {
    const [n, level] = rows[i], leaf = !n.children.length, shut = folded.has(n.path);
    const go = p => { path = p; showInside(true); }, toggle = () => { if (!folded.delete(n.path)) folded.add(n.path); go(n.path); };
    tr.dataset.path = n.path;
    tr.setAttribute("aria-level", level);
    if (!leaf) tr.setAttribute("aria-expanded", !shut);
    tr.tabIndex = n.path === path ? 0 : -1;
    if (n.path === path) tr.className = "picked";
    tr.onclick = event => event.target.className === "fold" || n.path === path && !leaf ? toggle() : go(n.path);
    tr.onkeydown = event => {
      const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
      if (step && rows[i + step]) go(rows[i + step][0].path);
      else if (event.key === "Enter" && !leaf || event.key === "ArrowRight" && shut || event.key === "ArrowLeft" && !shut && !leaf) toggle();
      else if (event.key === "ArrowRight" && !leaf && rows[i + 1]) go(rows[i + 1][0].path);
      else if (event.key === "ArrowLeft" && n.path) go(n.path.slice(0, Math.max(0, n.path.lastIndexOf("."))));
      else return;
      event.preventDefault();
    };
  });
  if (focus) lines.find(tr => tr.dataset.path === path)?.focus();
}
// How many registers and memories have how much time left of the clock's period, at the slower grade; half a ns a bar.
function showSlack() {
  const ends = picked.figures.timing.ends, period = 1000 / data.chip.mhz, last = Math.max(ends.length, 2 * period + 1), most = Math.max(1, ...ends);
  const svg = byId("slack"), width = 560, height = 170, step = (width - 20) / last, x = i => 10 + (last - 1 - i) * step;
  svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
  svg.replaceChildren();
  for (let i = 0; i < last; i++) {
    const slack = period - (i + 1) / 2, tall = (height - 50) * (ends[i] ?? 0) / most; // at least so much
    const box = shape("rect", { x: x(i), y: height - 30 - tall, width: step - 1, height: tall, fill: slack < 0 ? "var(--bad)" : "var(--bar)" });
    box.append(shape("title", {}, `${ends[i] ?? 0} with ${slack} to ${slack + 0.5} ns left`));
    svg.append(box);
    if (i % 4 === 0) svg.append(shape("text", { x: x(i) + step, y: height - 12, "text-anchor": "middle" }, String(period - i / 2)));
  }
  svg.append(shape("text", { x: 4, y: 14 }, `${ends.reduce((a, b) => a + b, 0)} registers and memories; the highest bar: ${most}; ns left of ${period}`));
}
function showInside(focus) {
  byId("inside").textContent = `Inside ${picked.name}: ${picked.title}`;
  byId("here").textContent = `Signals of ${path || picked.top}`;
  showTree(focus === true);
  showSlack();
  const wanted = byId("within").value.toLowerCase(), here = [];
  for (const [p, signals] of Object.entries(picked.costs))
    if (p === path || (path === "" || p.startsWith(path + ".")))
      for (const [s, c] of Object.entries(signals)) here.push([(p ? p + "." : "").slice(path ? path.length + 1 : 0) + s, c]);
  here.sort((a, b) => b[1][0] - a[1][0] || b[1][1] - a[1][1]);
  fill(byId("signals"), ["signal", "LUT", "of these RAM", "FF", "source"], here.filter(([n]) => n.toLowerCase().includes(wanted)).slice(0, 200)
    .map(([n, c]) => [n, c[0], c[2] || "", c[1], place((path ? path + "." : "") + n)]));
  const box = byId("paths");
  box.replaceChildren();
  const paths = picked.figures.timing.paths.filter(p => !path || [p.from, p.to].some(end => end.startsWith(path + ".")));
  if (!paths.length) box.append(element("p", `None of the ${picked.figures.timing.paths.length} longest begins or ends in ${path}.`, "soft"));
  for (const p of paths) {
    const d = element("details");
    d.append(element("summary", `slack ${(1000 / data.chip.mhz - p.ns * data.slowGrade).toFixed(2)}: ${p.ns.toFixed(2)} ns (-3), ${(p.ns * data.slowGrade).toFixed(2)} (-2), ${p.levels} levels: ${p.from} to ${p.to} ${p.pin}`));
    const t = element("table");
    fill(t, ["cell", "net", "fan-out", "cell ns", "net ns", "source"],
      [...p.steps.map(s => [s[0], s[1] || "(no name left)", s[2], s[3].toFixed(3), s[4].toFixed(3), place(s[1])]), [p.pin, p.to, "", "", "", place(p.to)]]);
    d.append(t);
    box.append(d);
  }
  const nets = picked.figures.nets, within = n => n.name.toLowerCase().includes(wanted);
  fill(byId("clocks"), ["clock", "flip-flops", "pins", "MHz", "source"], nets.clocks.filter(within)
    .map(n => [n.name, n.flipFlops, n.ends, n.ns ? (1000 / n.ns / data.slowGrade).toFixed(0) : "", place(n.name)]));
  fill(byId("resets"), ["reset", "kind", "flip-flops", "source"], nets.resets.filter(within).map(n => [n.name, n.kind, n.flipFlops, place(n.name)]));
  fill(byId("fanouts"), ["net", "ends", "from", "source"], nets.fanouts.filter(within).map(n => [n.name, n.ends, n.kind, place(n.name)]));
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
  const every = Math.ceil(all.length / 12); // dates that do not touch
  all.forEach((c, i) => { if ((all.length - 1 - i) % every === 0) svg.append(shape("text", { x: x(i), y: height - 8, "text-anchor": "middle" }, c.date.slice(5) || c.id)); });
  const by = (now, before) => before && now !== before ? ` (${signed(now - before)})` : "";
  fill(byId("commits"), ["commit", "date", "LUT", "FF", "slices", "MHz", "subject"], all.map((c, i) => {
    const f = series[i], before = series[i - 1];
    return f ? [c.id, c.date, f.lut + by(f.lut, before?.lut), f.ff + by(f.ff, before?.ff), f.slices, f.mhz ? f.mhz.toFixed(0) : "", [c.subject, "text"]] : null;
  }).filter(row => row).reverse());
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
function pick(design, inside) { picked = design; path = inside; folded = null; show(); }
function show() { showDesigns(); showInside(); showHistory(); showDifference(); }

for (const [id, chosen] of [["from", Math.max(0, all.length - 2)], ["to", all.length - 1]]) {
  all.forEach((c, i) => { const o = element("option", `${c.id} ${c.date} ${c.subject}`.slice(0, 70)); o.value = i; byId(id).append(o); });
  byId(id).value = chosen;
  byId(id).onchange = showDifference;
}
byId("filter").oninput = showDesigns;
byId("within").oninput = showInside;
showVerdict();
if (usable.length) showChip();
showCores();
showPaper();
if (picked) show();
// "#design/instance.path" opens the page there.
const [wanted, inside] = decodeURIComponent(location.hash.slice(1)).split("/");
if (wanted && usable.some(d => d.name === wanted)) pick(usable.find(d => d.name === wanted), inside ?? "");
