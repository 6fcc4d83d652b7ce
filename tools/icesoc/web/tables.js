// SPDX-License-Identifier: MIT
//
// tables: tables by Tabulator and charts by uPlot, in the page's colours. If the build could not
// download these libraries, a table is plain and has all rows, and a chart is a table of its points.

// Returns a list of the cells that do not fit into a row of a narrow page; empty cells are left out.
function collapsed(fields) {
  const list = element("table");
  for (const {title, value} of fields) {
    const node = value instanceof Node ? value : document.createTextNode(value ?? "");
    if (!node.textContent.trim() && !node.childElementCount) continue;
    const row = list.insertRow();
    row.insertCell().append(element("strong", title));
    row.insertCell().append(node);
  }
  return list.rows.length ? list : "";
}

// Shows rows in `place`, replacing its content. A column is [title, value(row), cell(row),
// Tabulator's options]. The value is used to sort, to filter, and for the download; the cell is shown
// (a text or an element; default: the value).
//   options.id        id of the table's element
//   options.filter    placeholder of the filter box, next to a button that downloads CSV
//   options.children  (row) => the rows below this row, which can be folded
//   options.open      (row) => whether the rows below this row are shown at first
//   options.pick      (row, Tabulator's row object or undefined): action of a click or Enter; arrow keys move the focus, and fold rows
//   options.picked    (row) => whether this row is the picked row
function table(place, columns, rows, options = {}) {
  const content = (row, [, value, cell]) => { // returns a node, because Tabulator would interpret a text as HTML
    const seen = (cell ?? value)(row) ?? "";
    return seen instanceof Node ? seen : document.createTextNode(seen);
  };
  const record = row => {
    const below = options.children?.(row)?.map(record) ?? [], one = {row, text: columns.map(([, value]) => value(row)).join(" ").toLowerCase()};
    columns.forEach(([, value], i) => { one[`c${i}`] = value(row); });
    if (below.length) one._children = below;
    one.text += below.map(r => ` ${r.text}`).join("");
    return one;
  };
  const box = element("div"), filter = element("input"), csv = element("button", "CSV");
  if (options.id) box.id = options.id;
  place.drawn?.destroy();
  place.replaceChildren(box);
  if (typeof Tabulator === "undefined") {
    const plain = document.createElement("table"), line = (row, depth) => {
      const tr = element("tr");
      if (options.pick) tr.onclick = () => options.pick(row);
      for (const column of columns) tr.append(element("td"));
      columns.forEach((column, i) => tr.cells[i].append(content(row, column)));
      if (depth) tr.cells[0].style.paddingLeft = `${depth + 1}em`;
      plain.tBodies[0].append(tr);
      options.children?.(row)?.forEach(r => line(r, depth + 1));
    };
    plain.createTHead().append(element("tr"));
    for (const [title] of columns) plain.tHead.rows[0].append(element("th", title));
    plain.append(element("tbody"));
    rows.forEach(row => line(row, 0));
    box.className = "plain";
    box.append(plain);
    return;
  }
  // A column is as wide as the widest text of the first rows. If all columns together are too wide,
  // each gets a proportional share of the width, and texts are wrapped.
  const pen = document.createElement("canvas").getContext("2d");
  pen.font = `bold ${getComputedStyle(document.body).font}`;
  const widest = column => Math.max(12 + pen.measureText(column[0]).width, ...rows.slice(0, 100).map(row => content(row, column))
    .map(seen => pen.measureText((seen.querySelector?.("summary, div") ?? seen).textContent).width));
  const wides = columns.map(column => Math.max(Math.min(widest(column) + 32, 700), column[3]?.minWidth ?? 0));
  if (place.clientWidth >= 800) box.style.maxWidth = `${Math.ceil(wides.reduce((sum, wide) => sum + wide, 20))}px`;
  const narrow = place.clientWidth < 600 ? 0.55 : 1; // narrower columns on a narrow page
  let marked;
  const mark = row => {
    if (!options.picked?.(row.getData().row)) return;
    marked?.classList.remove("picked");
    marked = row.getElement();
    marked.classList.add("picked");
  };
  const pick = row => {
    options.pick(row.getData().row, row);
    mark(row);
  };
  const unfold = rows => rows.forEach(row => { // unfolds all rows if there is a filter, else the rows of options.open
    if (!row.getTreeChildren().length) return;
    if (filter.value || options.open?.(row.getData().row)) row.treeExpand();
    else row.treeCollapse();
    unfold(row.getTreeChildren());
  });
  const tabulator = place.drawn = new Tabulator(box, {
    data: rows.map(record), layout: "fitColumns", maxHeight: "560px", renderVertical: rows.length > 100 ? "virtual" : "basic",
    responsiveLayout: place.clientWidth < 800 && "collapse", responsiveLayoutCollapseFormatter: collapsed, dataTree: Boolean(options.children), dataTreeFilter: true, dataTreeStartExpanded: row => options.open?.(row.getData().row) ?? false,
    columnDefaults: {headerSortTristate: true, sorter: (a, b) => a < b ? -1 : a > b ? 1 : 0}, placeholder: "nothing",
    columns: columns.map((column, i) => {
      const number = rows.length > 0 && rows.every(row => typeof column[1](row) === "number"), wide = widest(column) + (number ? 32 : 28);
      const plain = rows.slice(0, 1).map(row => content(row, column)).every(seen => !seen.childElementCount && /^[-+\d.]*( |$)/.test(seen.textContent));
      return {title: column[0], field: `c${i}`, widthGrow: Math.min(wide, 700) / 50, responsive: column[0] ? 1 : 0, ...(number ? {headerSortStartingDir: "desc"} : {}),
        formatter: cell => content(cell.getData().row, column), cssClass: number && plain ? "n" : "", ...column[3],
        minWidth: Math.max(...column[0].split(" ").map(word => pen.measureText(word).width + 30), Math.min(column[3]?.minWidth ?? wide, narrow * (column[3]?.minWidth ?? 160)))};
    }),
    rowFormatter: row => {
      const node = row.getElement();
      mark(row);
      if (!options.pick && !options.children) return;
      node.tabIndex = 0;
      node.onkeydown = event => {
        const near = event.key === "ArrowDown" ? node.nextElementSibling : event.key === "ArrowUp" ? node.previousElementSibling : null;
        if (near) near.focus();
        else if (event.key === "Enter" && options.pick) pick(row);
        else if (event.key === "ArrowRight" && options.children) row.treeExpand();
        else if (event.key === "ArrowLeft" && options.children) row.treeCollapse();
        else return;
        if (!near) node.focus();
        event.preventDefault();
      };
    },
  });
  tabulator.on("tableBuilt", () => {
    for (const title of box.querySelectorAll(".tabulator-col")) {
      title.tabIndex = 0;
      title.onkeydown = event => { if (event.key === "Enter") title.click(); };
    }
  });
  box.addEventListener("toggle", event => tabulator.getRow(event.target.closest(".tabulator-row")).normalizeHeight(), true);
  if (options.pick) tabulator.on("rowClick", (event, row) => pick(row));
  if (options.filter) {
    filter.placeholder = filter.ariaLabel = options.filter;
    filter.oninput = () => {
      const words = filter.value.toLowerCase().split(/\s+/);
      tabulator.blockRedraw();
      tabulator.setFilter(one => words.every(word => one.text.includes(word)));
      if (options.children) unfold(tabulator.getRows());
      tabulator.restoreRedraw();
    };
    csv.onclick = () => tabulator.download("csv", `${options.id ?? place.id}.csv`);
    const tools = element("div", undefined, "tools");
    tools.append(filter, csv);
    place.prepend(tools);
  }
}

// Draws series of points in `place`. labels: text of each point on the axis; titles: text of each point in the read-out below the chart;
// series: [{name, values, colour (a variable of the page, such as "--good"), bars (true: bars; otherwise a line), label: (i) => text for
// the read-out}]; limits: dashed lines, [{name, value, colour}]; height: in pixels. The pointer and the arrow keys choose the point for
// the read-out; at first, it is the last point.
function chart(place, {labels, titles = labels, series, limits = [], height = 190}) {
  place.drawn?.destroy();
  place.replaceChildren();
  if (!labels.length) return;
  if (typeof uPlot === "undefined") {
    table(place, [["point", i => titles[i]], ...series.map(({name, values, label}) => [name, i => values[i] === null ? "" : label?.(i) ?? values[i]])], [...labels.keys()]);
    return;
  }
  const colour = name => () => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const axis = {stroke: colour("--soft"), font: "12px system-ui, sans-serif", ticks: {show: false}};
  const last = labels.length - 1, most = Math.max(1e-9, ...series.flatMap(s => s.values.filter(v => v !== null)), ...limits.map(l => l.value));
  const plot = new uPlot({
    width: place.clientWidth || 600, height, cursor: {y: false, drag: {x: false}},
    scales: {x: {time: false, range: [-0.7, last + 0.7]}, y: {range: [0, 1.08 * most]}},
    axes: [{...axis, size: 28, grid: {show: false}, space: 80, incrs: [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000], values: (u, at) => at.map(i => labels[i] ?? "")},
      {...axis, size: 56, grid: {stroke: colour("--line"), width: 1}}],
    series: [{label: "point", value: (u, v, s, i) => titles[i] ?? ""},
      ...series.map(({name, colour: c, bars, label}) => ({label: name, stroke: colour(c), width: bars ? 0 : 2, points: {show: !bars},
        value: (u, v, s, i) => i === null || v === null ? "" : label ? label(i) : String(v), ...(bars ? {fill: colour(c), paths: uPlot.paths.bars({size: [0.85, 34]})} : {})})),
      ...limits.map(({name, colour: c}) => ({label: name, stroke: colour(c), dash: [6, 4], width: 1.5, points: {show: false}, value: (u, v) => v === null ? "" : String(v)}))],
    hooks: {setCursor: [u => { if (u.cursor.idx === null) u.setLegend({idx: last}, false); }]},
  }, [labels.map((_, i) => i), ...series.map(s => s.values), ...limits.map(l => labels.map(() => l.value))], place);
  plot.setLegend({idx: last}, false);
  place.tabIndex = 0;
  place.onkeydown = event => {
    const step = {ArrowLeft: -1, ArrowRight: 1}[event.key];
    if (!step) return;
    plot.setCursor({left: plot.valToPos(Math.max(0, Math.min(last, (plot.cursor.idx ?? last) + step)), "x"), top: 0});
    event.preventDefault();
  };
  const resized = new ResizeObserver(() => plot.setSize({width: place.clientWidth, height}));
  resized.observe(place);
  const scheme = matchMedia("(prefers-color-scheme: dark)"), redraw = () => plot.redraw();
  scheme.addEventListener("change", redraw);
  place.drawn = {destroy: () => {
    resized.disconnect();
    scheme.removeEventListener("change", redraw);
    plot.destroy();
  }};
}

if (typeof Tabulator === "undefined")
  document.body.prepend(element("p", "Tables cannot be sorted, and charts are shown as tables, because Tabulator and uPlot could not be downloaded. Make this page " +
    "again with a network, or set ICESOC_NPM to a mirror of npm.", "soft"));
