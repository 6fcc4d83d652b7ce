// SPDX-License-Identifier: MIT
//
// objects: shows a card for each object of the vehicle, with a form for each of the object's
// operations, made from Slice. Calls operations by Ice for JavaScript, and shows their results, the
// events, and a history of the calls. fields.js makes the fields of the forms.

const $ = id => document.getElementById(id);
const MOST_EVENTS = 200, MOST_CALLS = 50;
const now = () => { const date = new Date(); return new Date(date - 60000 * date.getTimezoneOffset()).toISOString().slice(0, 19).replace('T', ' '); };
let station = null; // Slice, communicator, adapter of listeners

// Returns a value as JSON: bytes as a list, numbers beyond 2**53 as texts.
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
    station = {...described, slice: new Slice(described.declarations), communicator: Ice.initialize(data), adapter: null};
    return station;
}

// Returns the selected vehicle, which calls go to.
const vehicle = () => station.vehicles[Math.max(0, $('vehicles').querySelector('select').selectedIndex)];

async function proxyOf(object) {
    const its = vehicle(), quoted = object.identity.replace(/[\\"]/g, '\\$&');
    if (its.tls && !its.isChosen) {
        // For a WebSocket, a browser uses a client certificate only if an earlier https request has
        // selected it.
        await fetch(`https://${location.hostname}:${its.port}/`, {mode: 'no-cors', credentials: 'include'}).catch(() => {});
        its.isChosen = true;
    }
    return station.communicator.stringToProxy(`"${quoted}":${its.browser}`);
}

async function listenerProxy(proxy, interface_) {
    if (!station.adapter) {
        station.adapter = await station.communicator.createObjectAdapter('');
        (await proxy.ice_getConnection()).setAdapter(station.adapter);
        station.adapter.activate();
    }
    const take = (name, values) => {
        const item = element('li', `${now()} ${interface_.split('::').pop()}.${name} ${json(values)}`);
        $('arrived').prepend(item);
        while ($('arrived').children.length > MOST_EVENTS) $('arrived').lastChild.remove();
    };
    return station.adapter.addWithUUID(station.slice.listener(interface_, take)).ice_oneway();
}

// Returns a canvas for a result that is a picture; null for any other result.
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

// Returns the shell command for a call.
const shellQuoted = text => /^[\w@%+=:,.\/-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`;
function asShell(object, operation, values) {
    const words = Object.entries(values).map(([name, value]) => shellQuoted(`${name}=${typeof value === 'string' ? value : json(value)}`));
    const watch = Object.values(values).includes('watch') ? ['--watch'] : [];
    return [station.command, shellQuoted(`${object.identity}.${operation.name}`), ...words, ...watch].join(' ');
}
// Returns the Python program for a call.
function asPython(object, operation, values) {
    const slice = station.slice, python = type => type.slice(2).replaceAll('::', '.');
    const literal = (value, type, tag) => {
        const its = slice.get(type), list = inner => `${python(inner)}(${slice.fields(inner).map(f => literal(value[f.name], f.type, f.tag)).join(', ')})`;
        if (value === null) return tag === undefined ? 'None' : 'Ice.Unset';
        if (type.endsWith('*')) return 'None';
        if (type === 'bool') return value ? 'True' : 'False';
        if (its.kind === 'enum') return `${python(type)}.${value}`;
        if (its.kind === 'struct' || its.kind === 'class') return list(value['@type'] ?? type);
        if (slice.isBytes(type)) return `bytes([${[...value].join(', ')}])`;
        if (its.kind === 'sequence') return `[${value.map(each => literal(each, its.element)).join(', ')}]`;
        if (its.kind === 'dictionary') return `{${value.map(([k, v]) => `${literal(k, its.key)}: ${literal(v, its.element)}`).join(', ')}}`;
        return typeof value === 'string' ? JSON.stringify(value) : String(value);
    };
    const given = operation.parameters.filter(p => !p.out).map(p => literal(values[p.name], p.type, p.tag));
    const file = slice.get(object.interface).file, place = JSON.stringify(`${object.identity}:${vehicle().program}`);
    return [
        'import Ice', `Ice.loadSlice("", ["-I" + Ice.getSliceDir(), ${JSON.stringify(file)}])`,
        `import ${python(object.interface).split('.')[0]}`, 'with Ice.initialize() as communicator:',
        `    proxy = ${python(object.interface)}Prx.uncheckedCast(communicator.stringToProxy(${place}))`,
        `    print(proxy.${operation.name}(${given.join(', ')}))`, ''].join('\n');
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

// Draws the corners that a call has returned, instead of the mission's corners.
function draw(results) {
    const found = Object.values(results).find(value => value && Array.isArray(value.best));
    if (found) corners = {features: found.best.map(f => [f.x, f.y, f.score]), found: found.found};
}

function operationForm(object, operation) {
    const form = element('form'), slice = station.slice, output = element('output'), unfit = operation.parameters.some(p => !p.out && p.type === 'Object');
    const outputs = operation.parameters.filter(p => p.out).map(p => `${p.name}: ${slice.named(p.type)}`);
    if (operation.result !== 'void') outputs.unshift(slice.named(operation.result));
    form.append(element('h4', operation.name + (outputs.length ? ` → ${outputs.join(', ')}` : '')));
    if (operation.doc) form.append(element('p', operation.doc, 'soft'));
    if (unfit) {
        form.append(element('p', `This page does not pass objects of unknown classes; use ${station.command} ${object.identity}.${operation.name}`, 'soft'));
        return form;
    }
    const fields = operation.parameters.filter(p => !p.out).map(p => [p, field(p, `${object.identity}.${operation.name}.${p.name}`)]);
    const button = element('button', 'Call');
    form.append(...fields.map(([, f]) => f.node), button, output);
    output.setAttribute('role', 'status');
    const values = () => Object.fromEntries(fields.map(([p, f]) => [p.name, slice.checkMember(f.get(), p, p.name)]));
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
            const proxy = await proxyOf(object), passed = {...given}, begin = performance.now();
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
    const item = element('li', `${now()} ${object.identity}.${operation.name} ${json(given).slice(0, 80)}: ${line} `);
    const again = element('button', 'Repeat', 'plain');
    again.onclick = repeat;
    item.append(again);
    $('history').prepend(item);
    while ($('history').children.length > MOST_CALLS) $('history').lastChild.remove();
}

// A card gets its forms when it is first opened, because a vehicle may have hundreds of operations.
function card(object) {
    const details = element('details'), summary = element('summary');
    summary.append(element('b', object.identity), ' ', element('small', object.interface.slice(2).replaceAll('::', '.') || 'unknown interface'));
    details.append(summary);
    details.dataset.names = `${object.identity} ${station.slice.operations(object.interface).map(o => o.name).join(' ')}`.toLowerCase();
    details.addEventListener('toggle', () => {
        if (!details.open || details.children.length > 1) return;
        const forms = element('div'), registers = element('aside');
        forms.append(...station.slice.operations(object.interface).map(operation => operationForm(object, operation)));
        registers.dataset.block = object.block; // live.js shows the registers here
        const body = element('div', undefined, 'card');
        body.append(forms, ...(object.block ? [registers] : []));
        details.append(body);
    });
    return details;
}

$('objects').addEventListener('toggle', async () => {
    if (!$('objects').open || station) return;
    try {
        await connect();
        $('vehicles').querySelector('select').append(...station.vehicles.map(v => element('option', v.name)));
        $('vehicles').hidden = station.vehicles.length < 2;
        $('cards').replaceChildren(...station.objects.map(card));
    } catch (error) { $('cards').replaceChildren(element('p', error.message, 'bad')); }
});
if (location.hash === '#objects') $('objects').open = true;
$('filter').oninput = () => {
    for (const each of $('cards').children) each.hidden = !(each.dataset.names || '').includes($('filter').value.toLowerCase());
};
