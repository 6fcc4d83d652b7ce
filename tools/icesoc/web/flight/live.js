// SPDX-License-Identifier: MIT
//
// live: requests /state from the server four times a second, and shows it.

const scale = 2; // pixels of the canvas for one pixel of the frame
let picture = null, pictureWanted = false;
var corners = null; // corners returned by a call from this page: {features, found}

function row(cells) {
    const tr = element('tr');
    for (const [text, className] of cells) tr.append(element('td', text, className));
    return tr;
}

function showFrame(state) {
    state = {...state, ...corners};
    if (state.frame && !pictureWanted) {
        pictureWanted = true;
        const image = new Image();
        image.onload = () => { picture = image; };
        image.onerror = () => { pictureWanted = false; };
        image.src = 'frame.png?' + Date.now();
    }
    $('found').textContent = state.found === undefined ? '' : `${state.found} corners, the strongest ${state.features.length} drawn`;
    if (!picture) return;
    const canvas = $('frame'), pen = canvas.getContext('2d');
    canvas.width = picture.width * scale;
    canvas.height = picture.height * scale;
    pen.imageSmoothingEnabled = false;
    pen.drawImage(picture, 0, 0, canvas.width, canvas.height);
    pen.strokeStyle = '#ff5000';
    pen.lineWidth = 2;
    const strongest = state.features.length ? state.features[0][2] : 1;
    for (const [x, y, score] of state.features) {
        pen.beginPath();
        pen.arc((x + 0.5) * scale, (y + 0.5) * scale, 4 + 8 * score / strongest, 0, 2 * Math.PI);
        pen.stroke();
    }
    canvas.dataset.features = state.features.length;
}

// Shows the newest picture of each other vehicle.
function showOthers(others) {
    const shown = $('others').dataset;
    if (shown.names === String(others)) return;
    shown.names = String(others);
    $('others').replaceChildren(...others.map(([address, name]) => {
        const figure = element('figure'), image = new Image();
        image.src = `vehicle${address}.png?${name}`;
        image.alt = `the frame of vehicle ${address}`;
        figure.append(image, element('figcaption', `uav${address} (${hex(Number(address), 4)})${name.startsWith('after') ? ', corners drawn' : ''}`));
        return figure;
    }));
}

function showAir(air) {
    if (!air) return;
    const mega = n => (n / 1e6).toFixed(2);
    const rows = {
        'simulated time': (air.ns / 1e9).toFixed(3) + ' s',
        'clocks of the chip': mega(air.cycles) + ' million',
        'ground to UAV': air.bytesUp + ' bytes',
        'UAV to ground': air.bytesDown + ' bytes',
        'packets': `${air.packets}, ${air.lost} lost`,
        'simulator': air.wallNs ? mega(air.cycles / air.wallNs * 1e9) + ' million clocks/s' : '',
    };
    $('air').replaceChildren(...Object.entries(rows).flatMap(([k, v]) => [element('dt', k), element('dd', v)]));
}

function showCalls(calls) {
    const number = (value, unit) => [value === undefined ? '' : value + unit, 'n'];
    $('calls').replaceChildren(...calls.map(c => row([
        [(c.ns === undefined ? c.at : c.ns / 1e9).toFixed(3) + ' s', 'n'], [c.who], [c.what], number(c.simulated_ms, ' ms'),
        number(c.bytes_up, ''), number(c.bytes_down, '')])));
}

// Draws a lane for each direction of the radio, for the calls of each side, for each task of the
// firmware, and for each slot that the processor has accessed. In the lane of a slot, the height of
// a mark is the number of accesses, and an event has full height. All marks of one kind in a lane
// are one SVG path; only calls have a title.
function showTimeline(state) {
    const events = state.events, svg = $('timeline'), width = svg.getBoundingClientRect().width || 1200, left = 120, height = 22;
    if (!events.length || !state.air) return;
    const end = state.air.ns, first = state.calls.find(c => c.ns)?.ns ?? end, chosen = $('span').value;
    // The first call includes the set-up of the modems, so the span begins only shortly before its
    // end.
    const span = chosen === 'call' ? 1.5 * (end - first) : Number(chosen) * 1e9, begin = span ? Math.max(0, end - span) : 0;
    const x = ns => left + (width - left - 10) * (ns - begin) / (end - begin);
    const lanes = [];
    const lane = name => lanes.find(l => l.name === name) ?? (lanes.push({name, mark: '', event: '', lost: '', cap: '', calls: []}), lanes[lanes.length - 1]);
    const bar = (ns, share, wide = 1.5) => `M${x(ns).toFixed(1)} 0h${wide}v${-Math.max(2, 16 * share).toFixed(1)}h${-wide}z`;
    for (const name of ['ground to UAV', 'UAV to ground', 'calls, ground', 'calls, UAV']) lane(name);
    const names = new Map(state.slots.map(s => [s.slot, s.block])), nameOf = slot => names.get(Number(slot)) ?? `slot ${slot}`;
    let since = null; // start of the running task
    for (const e of [...events.filter(e => e.task), {ns: end}]) {
        if (since && since.task !== 'idleTask' && e.ns > begin)
            lane(since.task).mark += bar(Math.max(since.ns, begin), 1, Math.max(1, x(e.ns) - x(Math.max(since.ns, begin))).toFixed(1));
        since = e;
    }
    for (const e of events) {
        if (e.ns < begin || e.task) continue;
        if (e.packet !== undefined) {
            const its = lane(e.from === 'ground' ? 'ground to UAV' : 'UAV to ground');
            if (e.lost) {
                // the mark of a lost packet has full height and a cap; its height does not show the
                // packet's length
                its.lost += bar(e.ns, 1, 3);
                its.cap += `M${(x(e.ns) - 2).toFixed(1)} -19h7v3h-7z`;
            } else its.mark += bar(e.ns, e.packet / 100);
        }
        else if (e.events) lane(nameOf(e.slot)).event += bar(e.ns, 1);
        else for (const [slot, n] of Object.entries(e.accesses ?? {})) lane(nameOf(slot)).mark += bar(e.ns, n / 20);
    }
    for (const c of state.calls)
        if (c.ns >= begin) lane(c.who.startsWith('ground') ? 'calls, ground' : 'calls, UAV').calls.push(c);
    svg.setAttribute('viewBox', `0 0 ${width} ${height * (lanes.length + 1)}`);
    svg.replaceChildren(...lanes.flatMap((l, i) => {
        const low = height * (i + 1), all = [shape('text', {x: 0, y: low - 5}, l.name), shape('line', {x1: left, x2: width, y1: low, y2: low})];
        for (const kind of ['mark', 'event', 'lost', 'cap'])
            if (l[kind]) all.push(shape('path', {d: l[kind], class: kind, transform: `translate(0 ${low})`}));
        for (const c of l.calls) {
            const from = Math.max(left, x(c.ns - (c.simulated_ms ?? 0) * 1e6)), box = shape('rect', {x: from, y: low - 14, width: Math.max(2, x(c.ns) - from), height: 12, class: /failed:/.test(c.what) ? 'lost' : 'mark'});
            box.append(shape('title', {}, `${c.what}: until ${(c.ns / 1e9).toFixed(3)} s`));
            all.push(box);
        }
        return all;
    }), ...[0, 1, 2, 3, 4].map(i => shape('text', {x: left + (width - left - 50) * i / 4, y: height * (lanes.length + 1) - 5}, `${((begin + (end - begin) * i / 4) / 1e9).toFixed(2)} s`)));
}

const hex = (value, digits) => '0x' + value.toString(16).padStart(digits, '0');
// Returns a table of the registers in a slot with their byte addresses. Registers that have changed within two seconds are marked.
const known = new Map(); // "slot.word" -> value of the register, and time of its last change
function registersOf(slot) {
    const table = element('table');
    for (const w of slot.words) {
        const key = `${slot.slot}.${w.word}`, before = known.get(key), now = performance.now();
        if (!before || before.value !== w.value) known.set(key, {value: w.value, at: before ? now : -Infinity});
        const tr = row([[hex(w.word * 4, 2), 'n'], [w.name], [hex(w.value, 8), 'n'], [w.written ? 'written' : 'read']]);
        tr.title = w.doc || '';
        tr.classList.toggle('changed', now - known.get(key).at < 2000);
        table.append(tr);
        if (!w.fields.length) continue;
        const line = element('tr', undefined, 'fields'), cell = element('td');
        cell.colSpan = 4;
        for (const f of w.fields) {
            // large values, such as addresses, in hexadecimal
            const shown = typeof f.value === 'number' && f.value >= 0x10000 ? hex(f.value, 8) : f.value;
            const field = element('span', `${f.name} ${shown}`, f.value && f.value !== 'cleared' ? 'set' : '');
            field.title = f.doc;
            cell.append(field, ' ');
        }
        line.append(cell);
        table.append(line);
    }
    return table;
}

// Shows the registers of all slots in one section, and each core's also at its object.
function showSlots(slots) {
    const used = slots.filter(s => s.words.length);
    $('slots').replaceChildren(...used.map(s => {
        const div = element('div', undefined, 'registers');
        div.append(element('h3', `${s.slot}  ${s.block}`), registersOf(s));
        div.title = s.doc;
        return div;
    }));
    for (const place of document.querySelectorAll('#cards [data-block]')) {
        const slot = used.find(s => s.block === place.dataset.block);
        place.className = 'registers';
        place.replaceChildren(...(slot ? [element('h4', 'Registers'), registersOf(slot)] : []));
    }
}

async function look() {
    let wait = 250;
    try {
        const state = await (await fetch('state', {cache: 'no-store'})).json();
        $('flight').textContent = state.flight;
        showFrame(state);
        showOthers(state.others);
        showAir(state.air);
        showTimeline(state);
        showCalls(state.calls);
        showSlots(state.slots);
        const verdict = state.calls.find(c => c.who === 'ground' && /equals|differs/.test(c.what))?.what ?? '';
        $('phase').className = !state.over ? '' : /differs/.test(verdict) ? 'bad' : 'good';
        $('phase').textContent = state.over ? ['the mission is over', state.found === undefined ? '' : `${state.found} corners`, verdict].filter(Boolean).join(', ') : state.air ? 'flying' : 'waiting for the simulator';
    } catch (error) {
        $('phase').className = 'bad';
        $('phase').textContent = 'the mission has ended, and its page with it (LIVE=1 or --live keeps it)';
        wait = 2000;
    }
    setTimeout(look, wait);
}
if (document.body.dataset.kind === 'flight') look();
else {
    $('phase').textContent = 'a vehicle behind its gateway';
    $('objects').open = true;
}
addEventListener('pagehide', () => { fetch('closed', {keepalive: true}).catch(() => {}); });
