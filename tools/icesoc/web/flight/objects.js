// SPDX-License-Identifier: MIT
//
// objects: a card for each object of the vehicle, with a form for each of its operations, made from
// Slice; calls by Ice for JavaScript, results, events, and a history.

const $ = id => document.getElementById(id);
const MOST_EVENTS = 200, MOST_CALLS = 50;
let station = null; // Slice, communicator, adapter of listeners

// Returns JSON of a value: bytes as a list, 64-bit numbers as digits.
const json = value => JSON.stringify(value, (_, each) => each instanceof Uint8Array ? [...each] : typeof each === 'bigint'
    ? Number.isSafeInteger(Number(each)) ? Number(each) : String(each) : each);

async function connect() {
    if (station) return station;
    const described = await (await fetch('objects')).json();
    if (!window.Ice) throw new Error(described.error || 'Ice for JavaScript is missing: build again with a network');
    const properties = Ice.createProperties();
    properties.setProperty('Ice.Default.InvocationTimeout', '60000');
    properties.setProperty('Ice.RetryIntervals', '-1');
    const data = new Ice.InitializationData();
    data.properties = properties;
    station = {objects: described.objects, slice: new Slice(described.declarations), communicator: Ice.initialize(data), adapter: null};
    return station;
}

function proxyOf(object) {
    const quoted = object.identity.replace(/[\\"]/g, '\\$&');
    return station.communicator.stringToProxy(`"${quoted}":ws -h ${location.hostname} -p ${location.port} -r "/ice?token=${document.body.dataset.token}"`);
}

async function listenerProxy(proxy, interface_) {
    if (!station.adapter) {
        station.adapter = await station.communicator.createObjectAdapter('');
        (await proxy.ice_getConnection()).setAdapter(station.adapter);
        station.adapter.activate();
    }
    const take = (name, values) => {
        const item = element('li', `${new Date().toLocaleTimeString()} ${interface_.split('::').pop()}.${name} ${json(values)}`);
        $('arrived').prepend(item);
        while ($('arrived').children.length > MOST_EVENTS) $('arrived').lastChild.remove();
    };
    return station.adapter.addWithUUID(station.slice.listener(interface_, take)).ice_oneway();
}

// A file input for a picture; `take` gets width, height and grey levels.
function pictureInput(name, take) {
    const file = element('input');
    Object.assign(file, {type: 'file', accept: 'image/*'});
    file.setAttribute('aria-label', `${name} from a picture`);
    file.onchange = async () => {
        if (!file.files[0]) return;
        const image = await createImageBitmap(file.files[0]), canvas = new OffscreenCanvas(image.width, image.height), pen = canvas.getContext('2d');
        pen.drawImage(image, 0, 0);
        const rgba = pen.getImageData(0, 0, image.width, image.height).data;
        take([image.width, image.height, Uint8Array.from({length: rgba.length / 4}, (_, i) => 0.299 * rgba[4 * i] + 0.587 * rgba[4 * i + 1] + 0.114 * rgba[4 * i + 2])]);
    };
    return file;
}

// A picture in a result, as a canvas; null for anything else.
function pictureOf(value, type) {
    const names = station.slice.picture(type);
    if (!names) return null;
    const [width, height, grey] = names.map(name => value[name]), canvas = element('canvas');
    if (width < 1 || height < 1 || grey.length !== width * height) return null;
    Object.assign(canvas, {width, height});
    const pen = canvas.getContext('2d'), image = pen.createImageData(width, height);
    grey.forEach((level, i) => image.data.set([level, level, level, 255], 4 * i));
    pen.putImageData(image, 0, 0);
    canvas.setAttribute('aria-label', `picture of ${width} x ${height} pixels`);
    return canvas;
}

// A field of a form: {node, get, set}; get returns what Slice.check() takes.
function field(parameter, id) {
    const slice = station.slice, type = parameter.type, its = slice.get(type), label = element('label');
    const unit = slice.annotation(parameter.metadata, 'call:unit');
    label.append(element('span', parameter.name), ' ', element('small', slice.named(type)), ' ');
    const made = (node, get, set) => {
        node.id = id;
        label.append(node);
        return {node: label, get, set};
    };
    if (type in INTEGERS) {
        const [low, high] = slice.bounds(type, parameter.metadata), input = element('input');
        Object.assign(input, {type: 'text', inputMode: 'numeric', value: String(parameter.default ?? (low > 0n ? low : 0)), size: 12});
        const found = made(input, () => input.value.trim(), value => { input.value = String(value); if (slider) slider.value = value; });
        let slider = null;
        if (high - low <= 4096n) {
            slider = element('input');
            Object.assign(slider, {type: 'range', min: String(low), max: String(high), value: input.value});
            slider.setAttribute('aria-label', `${parameter.name}, slider`);
            slider.oninput = () => { input.value = slider.value; };
            input.oninput = () => { slider.value = input.value; };
            label.append(slider);
        }
        label.append(element('small', `${low} to ${high} ${unit}`));
        return found;
    }
    if (type === 'bool') {
        const input = element('input');
        input.type = 'checkbox';
        return made(input, () => input.checked, value => { input.checked = value; });
    }
    if (its.kind === 'enum') {
        const select = element('select');
        select.append(...its.enumerators.map(e => element('option', e.name)));
        return made(select, () => select.value, value => { select.value = value; });
    }
    if (its.kind === 'struct') {
        const set = element('fieldset'), inner = slice.fields(type).map(f => [f.name, field(f, `${id}.${f.name}`)]);
        set.id = id;
        set.append(element('legend', `${parameter.name} (${slice.named(type)})`), ...inner.map(([, f]) => f.node));
        const names = slice.picture(type);
        if (names) set.append(pictureInput(parameter.name, values => inner.forEach(([name, f]) => f.set(values[names.indexOf(name)]))));
        return {node: set, get: () => Object.fromEntries(inner.map(([name, f]) => [name, f.get()])),
            set: value => inner.forEach(([name, f]) => f.set(value[name]))};
    }
    if (type.endsWith('*')) {
        const select = element('select');
        select.append(element('option', 'watch: show events here'), element('option', 'null'));
        return made(select, () => select.selectedIndex ? null : 'watch', value => { select.selectedIndex = value === null ? 1 : 0; });
    }
    if (type === 'string' || type === 'float' || type === 'double') {
        const input = element('input');
        input.value = type === 'string' ? '' : '0';
        return made(input, () => input.value, value => { input.value = String(value); });
    }
    // JSON; bytes from a file, too.
    const area = element('textarea');
    area.rows = 2;
    area.value = its.kind === 'dictionary' ? '{}' : '[]';
    let bytes = null;
    const found = made(area, () => {
        if (bytes) return bytes;
        try { return JSON.parse(area.value); } catch { throw new Error(`${parameter.name}: expected JSON, got ${area.value.slice(0, 60)}`); }
    }, value => { bytes = null; area.value = json(value); });
    if (slice.isBytes(type)) {
        const file = element('input');
        file.type = 'file';
        file.setAttribute('aria-label', `${parameter.name} from a file`);
        file.onchange = async () => { if (file.files[0]) found.set(new Uint8Array(await file.files[0].arrayBuffer())); };
        label.append(file);
    }
    return found;
}

// Text of a call for the shell, and for Python.
const shellQuoted = text => /^[\w@%+=:,.\/-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`;
function asShell(object, operation, values) {
    const words = Object.entries(values).map(([name, value]) => shellQuoted(`${name}=${typeof value === 'string' ? value : json(value)}`));
    const watch = Object.values(values).includes('watch') ? ['--watch'] : [];
    return ['./icesoc call', shellQuoted(`${object.identity}.${operation.name}`), ...words, ...watch].join(' ');
}
function asPython(object, operation, values) {
    const slice = station.slice, module = object.interface.slice(2).replaceAll('::', '.');
    const literal = (value, type) => {
        const its = slice.get(type);
        if (type.endsWith('*')) return value === null ? 'None' : 'listener';
        if (type === 'bool') return value ? 'True' : 'False';
        if (its.kind === 'enum') return `${type.slice(2).replaceAll('::', '.')}.${value}`;
        if (its.kind === 'struct') return `${type.slice(2).replaceAll('::', '.')}(${slice.fields(type).map(f => literal(value[f.name], f.type)).join(', ')})`;
        if (slice.isBytes(type)) return `bytes([${[...value].join(', ')}])`;
        if (its.kind === 'sequence') return `[${value.map(each => literal(each, its.element)).join(', ')}]`;
        if (its.kind === 'dictionary') return `{${value.map(([k, v]) => `${literal(k, its.key)}: ${literal(v, its.element)}`).join(', ')}}`;
        return typeof value === 'string' ? JSON.stringify(value) : String(value);
    };
    const ins = operation.parameters.filter(p => !p.out).map(p => literal(values[p.name], p.type));
    return `proxy = ${module}Prx.uncheckedCast(communicator.stringToProxy("${object.identity}:" + endpoint))\nprint(proxy.${operation.name}(${ins.join(', ')}))`;
}

function shown(results, operation) {
    const list = element('dl'), types = Object.fromEntries([['result', operation.result], ...operation.parameters.map(p => [p.name, p.type])]);
    for (const [name, value] of Object.entries(results)) {
        const picture = pictureOf(value, types[name]);
        if (picture) {
            const cell = element('dd');
            cell.append(picture);
            list.append(element('dt', name), cell);
            continue;
        }
        const text = value instanceof Uint8Array ? `${value.length} bytes: ${[...value.slice(0, 256)].map(b => b.toString(16).padStart(2, '0')).join(' ')}${value.length > 256 ? ' ...' : ''}` : json(value);
        list.append(element('dt', name), element('dd', text.length > 4000 ? text.slice(0, 4000) + ' ...' : text));
    }
    return list;
}

// Corners that a call returned replace those of the mission in the frame.
function draw(results) {
    const found = Object.values(results).find(value => value && Array.isArray(value.best));
    if (found) corners = {features: found.best.map(f => [f.x, f.y, f.score]), found: found.found};
}

function operationForm(object, operation) {
    const form = element('form'), slice = station.slice, output = element('output'), unfit = slice.unfitOperation(operation);
    const outputs = operation.parameters.filter(p => p.out).map(p => `${p.name}: ${slice.named(p.type)}`);
    if (operation.result !== 'void') outputs.unshift(slice.named(operation.result));
    form.append(element('h4', operation.name + (outputs.length ? ` → ${outputs.join(', ')}` : '')));
    if (operation.doc) form.append(element('p', operation.doc, 'soft'));
    if (unfit) {
        form.append(element('p', `This page does not pass ${unfit}; use ./icesoc call ${object.identity}.${operation.name}`, 'soft'));
        return form;
    }
    const fields = operation.parameters.filter(p => !p.out).map(p => [p, field(p, `${object.identity}.${operation.name}.${p.name}`)]);
    const button = element('button', 'Call');
    form.append(...fields.map(([, f]) => f.node), button, output);
    output.setAttribute('role', 'status');
    const values = () => Object.fromEntries(fields.map(([p, f]) => [p.name, slice.check(f.get(), p.type, p.name, p.metadata)]));
    for (const [text, make] of [['Copy as shell', asShell], ['Copy as Python', asPython]]) {
        const copy = element('button', text, 'plain');
        copy.type = 'button';
        copy.onclick = async () => {
            try {
                await navigator.clipboard.writeText(make(object, operation, values()));
                output.replaceChildren('copied');
            } catch (error) { fail(error); }
        };
        button.after(copy);
    }
    function fail(error) {
        const name = error.ice_id ? error.ice_id().slice(2).replaceAll('::', '.') : '';
        const text = error.fields ? `${name} ${json(error.fields)}` : name ? `${name}${error.unknown ? ': ' + error.unknown : error.reason ? ': ' + error.reason : ''}` : error.message;
        output.replaceChildren(element('p', text, 'bad'));
        return text;
    }
    form.onsubmit = async event => {
        event.preventDefault();
        let given = null, line = '';
        try {
            given = values();
            output.replaceChildren('calling ...');
            button.disabled = true;
            const proxy = proxyOf(object), passed = {...given}, begin = performance.now();
            for (const [p] of fields)
                if (p.type.endsWith('*')) passed[p.name] = given[p.name] === 'watch' ? await listenerProxy(proxy, p.type.slice(0, -1)) : null;
            const {results, bytes} = await slice.call(proxy, operation, passed);
            const cost = `${(performance.now() - begin).toFixed(1)} ms, ${bytes.up} bytes up, ${bytes.down} down`;
            output.replaceChildren(shown(results, operation), element('small', `done in ${cost}`));
            draw(results);
            line = `${json(results).slice(0, 80)} (${cost})`;
        } catch (error) { line = fail(error); }
        button.disabled = false;
        if (given) remember(object, operation, given, line, () => {
            for (const [p, f] of fields) f.set(given[p.name]);
            form.closest('details').open = true;
            form.requestSubmit();
        });
    };
    return form;
}

function remember(object, operation, given, line, repeat) {
    const item = element('li', `${new Date().toLocaleTimeString()} ${object.identity}.${operation.name} ${json(given).slice(0, 80)}: ${line} `);
    const again = element('button', 'Repeat', 'plain');
    again.onclick = repeat;
    item.append(again);
    $('history').prepend(item);
    while ($('history').children.length > MOST_CALLS) $('history').lastChild.remove();
}

// Forms are made when a card is opened first: a vehicle may have hundreds of operations.
function card(object) {
    const details = element('details'), summary = element('summary');
    summary.append(element('b', object.identity), ' ', element('small', object.interface.slice(2).replaceAll('::', '.') || 'unknown interface'));
    details.append(summary);
    details.dataset.names = `${object.identity} ${station.slice.operations(object.interface).map(o => o.name).join(' ')}`.toLowerCase();
    details.addEventListener('toggle', () => {
        if (details.open && details.children.length === 1)
            details.append(...station.slice.operations(object.interface).map(operation => operationForm(object, operation)));
    });
    return details;
}

$('objects').addEventListener('toggle', async () => {
    if (!$('objects').open || station) return;
    try {
        await connect();
        $('cards').replaceChildren(...station.objects.map(card));
    } catch (error) { $('cards').replaceChildren(element('p', error.message, 'bad')); }
});
if (location.hash === '#objects') $('objects').open = true;
$('filter').oninput = () => {
    for (const each of $('cards').children) each.hidden = !(each.dataset.names || '').includes($('filter').value.toLowerCase());
};
