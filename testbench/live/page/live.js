// SPDX-License-Identifier: MIT
//
// live: asks /state four times a second, and shows what is there.
'use strict';

const $ = id => document.getElementById(id);
const scale = 2; // screen pixels of the canvas for one of the frame
let picture = null, pictureWanted = false;

function element(name, text, className) {
    const e = document.createElement(name);
    if (text !== undefined) e.textContent = text;
    if (className) e.className = className;
    return e;
}

function row(cells) {
    const tr = element('tr');
    for (const [text, className] of cells) tr.append(element('td', text, className));
    return tr;
}

function showFrame(state) {
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
        [c.at.toFixed(3) + ' s', 'n'], [c.who], [c.what], number(c.simulated_ms, ' ms'),
        number(c.bytes_up, ''), number(c.bytes_down, '')])));
}

function showSlots(slots) {
    $('slots').replaceChildren(...slots.filter(s => s.words.length).map(s => {
        const div = element('div'), table = element('table');
        div.append(element('h3', `${s.slot}  ${s.block}`), table);
        for (const w of s.words) {
            const tr = row([[w.name], ['0x' + w.value.toString(16).padStart(8, '0'), 'n'], [w.written ? 'written' : 'read']]);
            tr.title = w.doc || '';
            table.append(tr);
        }
        div.title = s.doc;
        return div;
    }));
}

async function look() {
    let wait = 250;
    try {
        const state = await (await fetch('state', {cache: 'no-store'})).json();
        showFrame(state);
        showAir(state.air);
        showCalls(state.calls);
        showSlots(state.slots);
        $('phase').textContent = state.over ? 'the mission is over' : state.air ? 'flying' : 'waiting for the simulator';
    } catch (error) {
        $('phase').textContent = 'the mission has ended, and its page with it (make run LIVE=1 keeps it)';
        wait = 2000;
    }
    setTimeout(look, wait);
}
look();
