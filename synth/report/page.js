// SPDX-License-Identifier: MIT
//
// page: fills the utilisation report's tables and charts from the figures.
const byId = id => document.getElementById(id);
const data = JSON.parse(byId("data").textContent), usable = data.designs.filter(d => d.figures);
const share = (part, whole) => (100 * part / whole).toFixed(1) + " %";
// Today's figures: measured, or accepted for the same sources; none for a design that has neither.
const shown = d => d.figures ?? (d.state === "as accepted" ? d.accepted : undefined);
const signed = n => n > 0 ? "+" + n : String(n);
const clockText = mhz => mhz.toFixed(1); // as the terminal (baseline.py)
const sum = values => values.reduce((a, b) => a + b, 0);
const parent = p => p.slice(0, Math.max(0, p.lastIndexOf(".")));
// "#design/instance.path" opens the page there.
const [wanted, inside] = decodeURIComponent(location.hash.slice(1)).split("/");
let picked = usable.find(d => d.name === wanted) ?? usable[0], path = picked?.name === wanted && inside || "", isSlowest = false;

// File and line of a signal of the picked design, "" if unknown.
const place = signal => picked.figures.places[signal.replace(/\[\d+\]$/, "")] ?? "";
function link(at) {
  if (!at) return "";
  const a = element("a", at);
  a.href = "../../" + at.replace(/:\d+$/, "");
  return a;
}
// The column of a signal's file and line; name(row) is the signal's.
const source = name => ["source", r => place(name(r)), r => link(place(name(r))), { minWidth: 250 }];
function bar(value, whole) {
  const span = element("span"), part = element("span", "", "share");
  part.style.width = (whole ? 60 * value / whole : 0) + "px";
  span.append(part, String(value));
  return span;
}
// A column of changes: more is bad, less is good.
const changes = (title, by, isBad = n => n > 0) => [title, by, r => by(r) ? element("span", signed(by(r)), isBad(by(r), r) ? "bad" : by(r) < 0 ? "good" : "") : ""];

// ---- Verdict, chip, and the paper's table
function showVerdict() {
  const failures = data.designs.flatMap(d => d.failures), notes = data.designs.flatMap(d => d.notes);
  const isOpen = data.designs.some(d => !shown(d) && !d.failures.length);
  byId("verdict").append(element("p", failures.length ? "Failed" : isOpen ? data.states : "Within all budgets", failures.length ? "bad" : isOpen ? "soft" : "good"),
    ...failures.map(f => element("p", f, "bad")), ...notes.map(n => element("p", n, "soft")));
  byId("about").textContent = `${data.chip.name}, ${data.yosys}, commit ${data.commit || "unknown"}${isOpen && !failures.length ? "" : `; designs: ${data.states}`}`;
}
// The share of the FPGA that the chip, or the largest design, fills, beside the paper's.
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
  const clock = element("a", f.mhz ? clockText(f.mhz) : "no path", f.mhz < data.chip.mhz ? "bad" : "good"), number = element("b");
  clock.href = "#longest"; // the path that sets it
  clock.onclick = () => {
    [picked, path, isSlowest] = [d, "", false];
    show();
    byId("paths").querySelector("details").open = true;
  };
  number.append(clock);
  box.append(number, f.mhz ? " MHz" : "", element("div", `${data.chip.mhz} are wanted; the netlist's orders have ${clockText(f.clocks[0])} to ${clockText(f.clocks.at(-1))}`, "soft"));
  byId("chip").append(box);
}
// A table as the terminal has it: [titles, row, row, ...].
function showRows(id, [titles, ...rows]) {
  table(byId(id), titles.map((title, i) => [title, r => i ? parseFloat(r[i]) || 0 : r[i],
    r => element("span", r[i], r[i] === "ok" ? "good" : / over$/.test(r[i]) ? "bad" : "")]), rows);
}
function showCores() {
  byId("cores-part").hidden = !data.cores.length;
  if (data.cores.length) showRows("cores", data.cores);
}
function showPaper() {
  if (!data.table1.length) return;
  byId("paper-title").textContent = usable.find(d => d.paper).title;
  showRows("paper", data.table1);
}

// ---- The table of designs
// Modules stand in their folders, which fold; a folder sorts by its largest module.
function showDesigns() {
  const folders = new Map(), rows = [];
  for (const d of data.designs) {
    const folder = d.limits.lut ? "" : d.file.startsWith("build/") ? "generated" : d.file.replace(/\/[^/]*$/, "");
    if (!folder) rows.push(d);
    else folders.set(folder, [...folders.get(folder) ?? [], d]);
  }
  for (const [folder, members] of [...folders].sort()) rows.push({ folder, members });
  const column = (title, value, cell) => [title, r => r.members ? Math.max(...r.members.map(value)) : value(r), r => r.members ? "" : (cell ?? value)(r)];
  // A figure, or nothing if it is not known for today's sources.
  const count = (title, key, cell) => column(title, d => shown(d)?.[key] ?? 0, d => shown(d)?.[key] === undefined ? "" : cell ? cell(shown(d)) : shown(d)[key]);
  const change = key => {
    const [title, by, cell] = changes("change", d => d.accepted && shown(d) ? shown(d)[key] - d.accepted[key] : 0, (n, d) => shown(d)[key] > d.budget[key]);
    return column(title, by, d => d.accepted ? cell(d) : element("span", "new", "soft"));
  };
  table(byId("designs"), [
    ["design", r => r.folder ?? r.name, r => r.members ? `${r.folder}, ${r.members.length} ${r.members.length === 1 ? "module" : "modules"}` : r.name, { minWidth: 200 }],
    [...count("LUT", "lut", f => bar(f.lut, data.chip.lut)), { minWidth: 130 }], change("lut"), count("FF", "ff"), change("ff"),
    count("MHz", "mhz", f => f.mhz ? element("span", clockText(f.mhz), f.mhz < data.chip.mhz ? "bad" : "") : ""),
    count("slices", "slices"), count("RAM16", "ram"), count("DSP", "dsp"), ["state", r => r.state ?? ""],
    ["file", r => r.file ? `${r.file} ${r.title}` : "", r => link(r.file), { minWidth: 250 }],
  ], rows, { filter: "filter by name, folder or title", children: r => r.members, picked: r => r === picked,
    pick: (r, line) => {
      if (r.members) return line?.treeToggle();
      if (!r.figures) return;
      [picked, path] = [r, ""];
      show();
    } });
}

// ---- The tree of instances
function treeOf(costs) { // {name, path, own: [LUT, FF], sum: [LUT, FF], children}, the most LUTs first
  const known = {}, node = p => known[p] ??= (() => {
    const n = { name: p.slice(p.lastIndexOf(".") + 1), path: p, own: [0, 0], sum: [0, 0], children: [] };
    if (p) node(parent(p)).children.push(n);
    return n;
  })();
  for (const [p, signals] of Object.entries(costs))
    for (let i = 0; i < 2; i++) {
      node(p).own[i] = sum(Object.values(signals).map(c => c[i]));
      for (let q = p; ; q = parent(q)) { node(q).sum[i] += node(p).own[i]; if (!q) break; }
    }
  for (const n of Object.values(known)) n.children.sort((a, b) => b.sum[0] - a.sum[0] || b.sum[1] - a.sum[1]);
  return node("");
}
// The rows of a path. A net whose name mapping has taken is at the next one that has kept its own.
function stepsOf(p) {
  const rows = [...p.steps, [p.pin, p.to]].map(r => [...r]);
  for (let i = rows.length, at; i--; ) rows[i].at = at = rows[i][1] || at;
  return rows;
}
// The part of the figures that belongs to the instance at the path.
function showInstance() {
  byId("here").textContent = `Signals of ${path || picked.top}`;
  const below = path && path + ".", here = Object.entries(picked.figures.costs).filter(([p]) => p === path || p.startsWith(below))
    .flatMap(([p, signals]) => Object.entries(signals).map(([s, c]) => ({ name: (p && p + ".") + s, lut: c[0], ram: c[2], ff: c[1] })))
    .sort((a, b) => b.lut - a.lut || b.ff - a.ff);
  table(byId("signals"), [["signal", r => r.name.slice(below.length)], ["LUT", r => r.lut], ["RAM", r => r.ram, r => r.ram || ""], ["FF", r => r.ff], source(r => r.name)],
    here, { filter: "filter signals" });
  const { mhz, clocks, timing } = picked.figures, order = byId("order"), all = isSlowest ? timing.slowest : timing.paths;
  order.hidden = !timing.slowest;
  order.textContent = isSlowest ? `${clockText(mhz)} MHz: the median order` : `${clockText(clocks[0])} MHz: the slowest order`;
  order.onclick = () => { isSlowest = !isSlowest; showInstance(); };
  byId("longest").textContent = `Longest paths${mhz ? `, at ${clockText(isSlowest ? clocks[0] : mhz)} MHz` : ""}`;
  const paths = all.filter(p => [p.from, p.to].some(end => end.startsWith(below)));
  byId("paths").replaceChildren(...paths.map(p => {
    const details = element("details"), steps = element("div"), slow = p.ns * data.slowGrade;
    details.append(element("summary", `slack ${(1000 / data.chip.mhz - slow).toFixed(2)}: ${p.ns.toFixed(2)} ns (-3), ${slow.toFixed(2)} (-2), ${p.levels} levels: ${p.from} to ${p.to} ${p.pin}`), steps);
    details.ontoggle = () => table(steps, [["cell", r => r[0]], ["net", r => r[1] || `on the way to ${r.at}`], ["fan-out", r => r[2]], ["cell ns", r => r[3], r => r[3]?.toFixed(3)],
      ["net ns", r => r[4], r => r[4]?.toFixed(3)], source(r => r.at)], stepsOf(p));
    return details;
  }), ...(paths.length ? [] : [element("p", `None of the ${all.length} longest begins or ends in ${path}.`, "soft")]));
}
// Number of registers and memories by the time left in the clock's period, at the slower grade;
// half a ns a bar.
function showSlack() {
  const ends = picked.figures.timing.ends, period = 1000 / data.chip.mhz;
  const slack = Array.from({ length: Math.max(ends.length, 2 * period + 1) }, (_, i) => period - (i + 1) / 2).reverse(); // lower bounds
  const count = slack.map((_, i) => ends[slack.length - 1 - i] ?? 0);
  chart(byId("slack"), { labels: slack.map(String), titles: slack.map(ns => `${ns} to ${ns + 0.5} ns left of ${period}`), series: [
    { name: `of ${sum(ends)} registers and memories`, values: count.map((n, i) => slack[i] < 0 ? null : n), colour: "--bar", bars: true },
    { name: "too late", values: count.map((n, i) => slack[i] < 0 ? n : null), colour: "--bad", bars: true }] });
}
// Shows the figures for which the table of designs has no room.
function showFigures() {
  const f = picked.figures, more = { "of the chip's LUTs": share(f.lut, data.chip.lut), slices: `${f.low} to ${f.high}`, levels: f.levels, LUT6: f.lut6, "LUTs as RAM": f.lutRam,
    "as shift registers": f.shift, "route-throughs": f.through, CARRY4: f.carry, "control sets": f.sets, pins: f.pins };
  for (const [family, other] of Object.entries(picked.others ?? {})) Object.assign(more, { [`${family} LUT`]: other.lut, [`${family} FF`]: other.ff });
  byId("figures").textContent = Object.entries(more).map(([name, value]) => `${name} ${value}`).join(", ");
}
function showInside() {
  byId("inside").textContent = `Inside ${picked.name}${picked.title && ": "}${picked.title}`;
  showFigures();
  const root = treeOf(picked.figures.costs), nets = picked.figures.nets;
  const cost = (title, i) => [[title, n => n.sum[i], n => bar(n.sum[i], root.sum[i]), { minWidth: 130 }], ["its own", n => n.own[i], n => n.children.length ? n.own[i] : ""]];
  table(byId("tree"), [["instance", n => n.path, n => n.name || picked.top, { minWidth: 200 }], ...cost("LUT", 0), ...cost("FF", 1), ["module", n => picked.modules?.[n.path] ?? ""]], [root], {
    filter: "filter instances", children: n => n.children, open: n => !n.path.includes(".") && n.children.some(c => !c.path.includes(".")) || path.startsWith(n.path + "."),
    picked: n => n.path === path, pick: n => { path = n.path; showInstance(); } });
  showInstance();
  showSlack();
  table(byId("clocks"), [["clock", n => n.name], ["flip-flops", n => n.flipFlops], ["pins", n => n.ends],
    ["MHz", n => n.ns ? 1000 / n.ns / data.slowGrade : 0, n => n.ns ? clockText(1000 / n.ns / data.slowGrade) : ""], source(n => n.name)], nets.clocks);
  table(byId("resets"), [["reset", n => n.name], ["kind", n => n.kind], ["flip-flops", n => n.flipFlops], source(n => n.name)], nets.resets);
  table(byId("fanouts"), [["net", n => n.name], ["ends", n => n.ends], ["from", n => n.kind], source(n => n.name)], nets.fanouts);
}

// ---- History
function showHistory() { // oldest first; the last is now
  const now = { id: "now", date: "", subject: "this run", designs: { [picked.name]: picked.figures } };
  const all = [...data.history].reverse().concat(now);
  const kinds = [["lut", "LUT"], ["ff", "FF"], ["slices", "slices"]], known = all.filter(c => c.designs[picked.name]).map(c => ({ ...c, f: c.designs[picked.name] }));
  known.forEach((c, i) => { c.before = known[i - 1]?.f ?? c.f; });
  chart(byId("history"), { labels: known.map(c => c.date.slice(5) || c.id), titles: known.map(c => `${c.id} ${c.date} ${c.subject}`),
    series: kinds.map(([key, name]) => ({ name, values: known.map(c => c.f[key]), colour: `--${key}` })),
    limits: kinds.filter(([key]) => picked.limits[key] < 2 * picked.figures[key]).map(([key, name]) => ({ name: `limit of ${name}`, value: picked.limits[key], colour: `--${key}` })) });
  const change = key => [key.toUpperCase(), c => c.f[key], c => c.f[key] + (c.f[key] === c.before[key] ? "" : ` (${signed(c.f[key] - c.before[key])})`)];
  table(byId("commits"), [["commit", c => c.id], ["date", c => c.date], change("lut"), change("ff"), ["slices", c => c.f.slices], ["MHz", c => c.f.mhz || 0, c => c.f.mhz ? clockText(c.f.mhz) : ""],
    ["subject", c => c.subject, , { minWidth: 400 }]], known.reverse());
}
function show() { showInside(); showHistory(); }

showVerdict();
showCores();
showPaper();
if (picked) {
  showChip();
  showDesigns();
  show();
}
