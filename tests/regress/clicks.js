// SPDX-License-Identifier: MIT
// clicks: a second script of the page. It clicks like a user, also on a separate table and chart, and writes what it then sees.
const seen = [], $ = (selector, at = document) => at.querySelector(selector);
const all = (selector, at) => [...at.querySelectorAll(selector)];
const wait = () => new Promise(done => setTimeout(done, 300));
const column = (at, n) => all(".tabulator-row", at)
  .map(row => row.querySelectorAll(".tabulator-cell")[n].textContent).join(" ");
const key = (node, key) => node.dispatchEvent(new KeyboardEvent("keydown", {key, bubbles: true}));

(async () => {
  await wait();
  const results = $("#results"), test = $(".tabulator-col", results);
  const filter = $("input", results.parentElement);
  test.click();
  key(test, "Enter");
  seen.push(`sorted ${column(results, 0)}`);
  filter.value = "ROOM fli";
  filter.oninput();
  window.Blob = function(parts) { seen.push(`csv ${parts.join("").replace(/\n/g, " / ")}`); };
  URL.createObjectURL = () => "";
  HTMLAnchorElement.prototype.click = () => {}; // nothing is downloaded
  $("button", results.parentElement).click();
  seen.push(`filtered ${column(results, 0)}`);

  const many = element("div"), few = element("div"), drawn = element("div");
  document.body.append(many, few, drawn);
  table(many, [["n", r => r]], [...Array(2000).keys()]);
  table(few, [["name", r => r.name], ["n", r => r.n]],
    [{name: "<a>", n: 9}, {name: "b", n: 10, below: [{name: "c", n: 1}]}],
    {id: "few", children: r => r.below, pick: r => seen.push(`picked ${r.name}`)});
  const values = [1, null, 4], text = i => `no. ${i}`;
  chart(drawn, {labels: ["i", "ii", "iii"], limits: [{name: "l", value: 2, colour: "--bad"}],
    series: [{name: "s", colour: "--good", values, label: text, bars: true}]});
  await wait();
  seen.push(`of 2000 ${all(".tabulator-row", many).length < 300 ? "some" : "all"}`);
  all(".tabulator-col", few)[1].click();
  seen.push(`largest ${column(few, 0)}`);
  key($(".tabulator-row", few), "Enter");
  key($(".tabulator-row", few), "ArrowRight");
  seen.push(`open ${column(few, 0)}`);
  key($(".tabulator-row", few), "ArrowDown");
  seen.push(`at ${document.activeElement.textContent}`);
  key($(".tabulator-row", few), "ArrowLeft");
  seen.push(`folded ${column(few, 0)}`);

  const read = () => all(".u-value", drawn).map(v => v.textContent).join(" ");
  const canvas = $("canvas", drawn);
  const pixels = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
  const drawnIn = (...rgb) => pixels.some(
    (_, i) => i % 4 === 0 && [...rgb, 255].every((value, j) => pixels[i + j] === value));
  seen.push(`canvas ${drawnIn(21, 122, 60)} ${drawnIn(179, 38, 30)}`, `read ${read()}`);
  key(drawn, "ArrowLeft");
  key(drawn, "ArrowLeft");
  seen.push(`moved ${read()}`);

  const wave = $(".waveform"), cursor = $("span", wave.closest("details"));
  const rows = () => all("text:not([text-anchor])", wave).map(t => t.textContent)
    .filter(t => !/^(\S+Task|[\dafus-]+)$/.test(t)).join(" ");
  const cells = () => all("text.value", wave).map(t => t.firstChild.textContent).join(" ");
  const click = (x, row) => {
    const {left, top} = wave.getBoundingClientRect(), at = {clientX: left + x, bubbles: true};
    wave.dispatchEvent(new MouseEvent("click", {...at, clientY: top + 22 * row + 9}));
  };
  seen.push(`rows ${rows()}`);
  key(wave, "ArrowDown");
  key(wave, "Enter");
  seen.push(`tree ${rows()}`);
  click(40, 3);
  seen.push(`deeper ${rows()}`, `values ${cells()}`, `readout${cursor.textContent}`);
  click(40, 4);
  seen.push(`unsigned ${cells()}`);
  key(wave, "Enter");
  seen.push(`signed ${cells()}`);
  key(wave, "ArrowLeft");
  key(wave, "ArrowLeft");
  seen.push(`earlier ${cells()}`, `readout${cursor.textContent}`);
  click(wave.clientWidth - 1, 2);
  seen.push(`later ${cells()}`);
  filter.value = "";
  filter.oninput();
  document.body.append(element("p", `seen: ${seen.join("; ")};`));
})();
