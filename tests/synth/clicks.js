// SPDX-License-Identifier: MIT
// clicks: actions of a user on the utilisation page; report_test.py runs it in the page.
(async () => {
const seen = [], all = selector => [...document.querySelectorAll(selector)];
const rest = () => new Promise(done => setTimeout(done, 200));
const rowsOf = id => all(`#${id} .tabulator-row`);
const first = id => rowsOf(id).map(r => r.querySelector(".tabulator-cell").textContent);
const cells = (id, row) =>
  [...rowsOf(id)[row].querySelectorAll(".tabulator-cell")].map(c => c.textContent);
const row = (id, name) => rowsOf(id)[first(id).findIndex(text => text.startsWith(name))];
const key = (row, key) => row.dispatchEvent(new KeyboardEvent("keydown", {key, bubbles: true}));
await rest();
const verdict = document.getElementById("verdict"), chip = document.getElementById("chip");
const text = id => document.getElementById(id).textContent;
seen.push("at first " + text("here") + ", " +
  first("tree").filter((name, i) => rowsOf("tree")[i].matches(".picked")));
const isFirst = verdict.compareDocumentPosition(chip) & Node.DOCUMENT_POSITION_FOLLOWING;
seen.push("first " + (isFirst ? verdict.firstChild.textContent : "not the verdict"));
seen.push("chip " + chip.querySelectorAll(".meter").length + " " + chip.firstChild.textContent);
seen.push("folders " + first("designs"));
row("designs", "hdl/blocks").focus();
key(row("designs", "hdl/blocks"), "Enter");
seen.push("opened " + first("designs") + " at " + document.activeElement.textContent.slice(0, 10));
for (const time of [1, 2]) {
  all("#designs .tabulator-col")[1].click();
  await rest();
  seen.push("sorted " + first("designs"));
}
row("designs", "whole").click();
await rest();
seen.push("picked " + all("#designs .picked").length + " " + text("inside"));
row("tree", "u_store").click();
await rest();
seen.push("tree " +
  rowsOf("tree").map((r, i) => cells("tree", i)[0] + cells("tree", i)[5]).join(" "));
seen.push("here " + text("here"));
seen.push("paths " + all("#paths details").length);
all("#paths details")[0].open = true;
await rest();
seen.push("step " + all("#paths a").pop().textContent);
seen.push("on the way to " + stepsOf({ steps: [["a", "x"], ["b", ""], ["c", "y"]], pin: "D",
  to: "z" }).map(row => row.at));
const read = id => all(`#${id} .u-value`).map(value => value.textContent).join(" ");
picked.figures.clocks[0] = 104.46;
document.getElementById("order").click();
seen.push("slow " + document.getElementById("longest").textContent);
document.querySelector("#chip a").click();
await rest();
seen.push("clock " + document.querySelector("#chip a").textContent + " " +
  document.getElementById("longest").textContent + ", by " + all("#paths details[open] a").length);
seen.push("wider " + all(".tabulator-tableholder").filter(t => t.scrollWidth > t.clientWidth).length);
seen.push("rounded " + [104.46, 104.44, 104].map(clockText));
let slack = read("slack");
for (let left = 20; left && / 0 *$/.test(slack); left--) { // moves to the last bar
  key(document.getElementById("slack"), "ArrowLeft");
  await rest();
  slack = read("slack");
}
seen.push("slack " + slack);
seen.push("history " + read("history"));
document.getElementById("seen").textContent = seen.join("; ") + ";";
})().catch(error => { document.getElementById("seen").textContent = error.stack; });
