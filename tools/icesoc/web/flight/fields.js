// SPDX-License-Identifier: MIT
//
// fields: makes the fields of forms from types of Slice. A field is {node, get, set}: get returns
// the entered value for Slice.check(), set shows a value.

const MOST_ROWS = 500; // rows of a table; a longer sequence is shown as JSON

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

// A file input; `take` gets the file.
function fileInput(name, accept, take) {
    const file = element('input');
    Object.assign(file, {type: 'file', accept});
    file.setAttribute('aria-label', name);
    file.onchange = () => { if (file.files[0]) take(file.files[0]); };
    return file;
}

// Returns the rows of a text. The text is JSON, or has a line for each row, with commas,
// semicolons, tabs or spaces between the values.
function rowsOfText(text) {
    try { return JSON.parse(text); } catch { /* the text is not JSON */ }
    return text.trim().split(/\r?\n/).map(line => line.trim().split(/[,;\t ]+/));
}

// Converts a decimal number of at most 15 digits, and returns any other text unchanged.
// Slice.check() converts longer integers, and rejects other texts.
const numberOf = text => /^[+-]?\d{1,15}(\.\d+)?(e[+-]?\d{1,3})?$/i.test(text.trim()) ? Number(text) : text.trim();

function integerField(parameter, made, label) {
    const slice = station.slice, [low, high] = slice.bounds(parameter.type, parameter.metadata), input = element('input');
    let slider = null;
    Object.assign(input, {type: 'text', inputMode: 'numeric', value: String(parameter.default ?? (low > 0n ? low : 0)), size: 12});
    const found = made(input, () => numberOf(input.value), value => { input.value = String(value); if (slider) slider.value = value; });
    const unit = slice.annotation(parameter.metadata, 'call:unit');
    input.title = `${low} to ${high} ${unit}`;
    if (label && high - low <= 4096n) {
        slider = element('input');
        Object.assign(slider, {type: 'range', min: String(low), max: String(high), value: input.value});
        slider.setAttribute('aria-label', `${parameter.name}, slider`);
        slider.oninput = () => { input.value = slider.value; };
        input.oninput = () => { slider.value = input.value; };
        label.append(slider);
    }
    if (label) label.append(element('small', `${low} to ${high} ${unit}`));
    return found;
}

// A group of fields with a legend.
function group(parameter, id, ...nodes) {
    const set = element('fieldset');
    set.id = id;
    set.append(element('legend', `${parameter.name} (${station.slice.named(parameter.type)})`), ...nodes);
    return set;
}

function structField(parameter, id) {
    const slice = station.slice, inner = slice.fields(parameter.type).map(f => [f.name, field(f, `${id}.${f.name}`)]);
    const set = group(parameter, id, ...inner.map(([, f]) => f.node)), names = slice.picture(parameter.type);
    if (names) set.append(pictureInput(parameter.name, values => inner.forEach(([name, f]) => f.set(values[names.indexOf(name)]))));
    return {node: set, get: () => Object.fromEntries(inner.map(([name, f]) => [name, f.get()])),
        set: value => inner.forEach(([name, f]) => { if (value[name] !== undefined) f.set(value[name]); })};
}

// A class: a list of the class and its derived classes, and the fields of the selected class.
function classField(parameter, id) {
    const slice = station.slice, select = element('select'), place = element('div');
    let inner = [];
    select.id = id;
    select.setAttribute('aria-label', `${parameter.name}, class`);
    select.append(element('option', 'null'), ...slice.classes(parameter.type).map(each => element('option', slice.named(each))));
    select.onchange = () => {
        const members = select.selectedIndex ? slice.fields(slice.classes(parameter.type)[select.selectedIndex - 1]) : [];
        inner = members.map(f => [f.name, field(f, `${id}.${f.name}`)]);
        place.replaceChildren(...inner.map(([, f]) => f.node));
    };
    const get = () => select.selectedIndex ? {'@type': select.value, ...Object.fromEntries(inner.map(([name, f]) => [name, f.get()]))} : null;
    const set = value => {
        select.selectedIndex = value ? 1 + slice.classes(parameter.type).indexOf(value['@type'] ?? parameter.type) : 0;
        select.onchange();
        for (const [name, f] of inner) if (value[name] !== undefined) f.set(value[name]);
    };
    return {node: group(parameter, id + '.group', select, place), get, set};
}

// A sequence or a dictionary: a table with a row per element, a text box with the same values as
// JSON, and a file input.
function tableField(parameter, id) {
    const slice = station.slice, its = slice.get(parameter.type), isDictionary = its.kind === 'dictionary';
    const isStruct = slice.get(its.element).kind === 'struct';
    const valueColumns = isStruct ? slice.fields(its.element) : [{name: 'value', type: its.element}];
    const columns = isDictionary ? [{name: 'key', type: its.key}, ...valueColumns] : valueColumns;
    const table = element('table'), body = element('tbody'), head = element('tr'), area = element('textarea');
    let rows = [], isText = false;
    head.append(element('th', '#'), ...columns.map(c => element('th', `${c.name} ${slice.named(c.type)}`)), element('th', ''));
    table.append(element('thead'), body);
    table.tHead.append(head);
    Object.assign(area, {id, rows: 2, value: '[]'});
    area.setAttribute('aria-label', `${parameter.name} as JSON`);
    const rowValue = row => {
        const values = row.fields.map(f => f.get()), inner = isDictionary ? values.slice(1) : values;
        const value = isStruct ? Object.fromEntries(valueColumns.map((c, i) => [c.name, inner[i]])) : inner[0];
        return isDictionary ? [values[0], value] : value;
    };
    const written = () => { // copies the table to the JSON text
        isText = false;
        area.value = json(rows.map(rowValue));
        count.textContent = `${rows.length} rows`;
    };
    const number = () => rows.forEach((row, i) => { row.node.firstChild.textContent = i; });
    const addRow = value => {
        const row = {node: element('tr'), fields: columns.map((c, i) => field(c, `${id}.${rows.length}.${c.name}`, `${c.name} of row ${rows.length}`))};
        const remove = element('button', '\u00d7', 'plain'), last = element('td');
        remove.type = 'button';
        remove.setAttribute('aria-label', `remove row ${rows.length}`);
        remove.onclick = () => { rows.splice(rows.indexOf(row), 1); row.node.remove(); number(); written(); };
        last.append(remove);
        row.node.append(element('td', rows.length), ...row.fields.map(f => { const cell = element('td'); cell.append(f.node); return cell; }), last);
        if (value !== undefined) {
            const [key, inner] = isDictionary ? value : [undefined, value];
            const given = isStruct ? valueColumns.map(c => Array.isArray(inner) ? inner[valueColumns.indexOf(c)] : inner[c.name]) : [Array.isArray(inner) && inner.length === 1 ? inner[0] : inner];
            [...(isDictionary ? [key] : []), ...given].forEach((each, i) => { if (each !== undefined) row.fields[i].set(each); });
        }
        rows.push(row);
        return row;
    };
    // Shows values as rows of the table. A list with more than MOST_ROWS values is only shown as
    // JSON.
    const show = values => {
        rows = [];
        const list = isDictionary && !Array.isArray(values) ? Object.entries(values) : values;
        if (Array.isArray(list) && list.length <= MOST_ROWS) list.forEach(addRow);
        body.replaceChildren(...rows.map(row => row.node));
        count.textContent = `${Array.isArray(list) ? list.length : 0} rows${rows.length ? '' : list.length ? ', as JSON' : ''}`;
    };
    const set = values => { isText = true; area.value = json(values); show(values); };
    const add = element('button', 'Add a row', 'plain'), count = element('small', '0 rows'), more = element('details');
    add.type = 'button';
    add.onclick = () => { const row = addRow(); body.append(row.node); written(); row.node.querySelector('input, select')?.focus(); };
    body.oninput = body.onchange = written;
    body.onpaste = event => { // accepts rows of a spreadsheet
        const text = event.clipboardData.getData('text');
        if (!text.trim().includes('\n')) return;
        event.preventDefault();
        set([...rows.map(rowValue).filter((_, i) => rows[i].node !== event.target.closest('tr')), ...rowsOfText(text)]);
        written();
    };
    area.oninput = () => { isText = true; try { show(JSON.parse(area.value)); } catch { /* incomplete */ } };
    more.append(element('summary', 'as JSON, or from a file'), area,
        fileInput(`${parameter.name} from a file`, '.json,.csv,.txt', async file => { set(rowsOfText(await file.text())); written(); }));
    const get = () => {
        if (!isText) return rows.map(rowValue);
        try { return JSON.parse(area.value); } catch { throw new Error(`${parameter.name}: expected JSON, got ${area.value.slice(0, 60)}`); }
    };
    const scroll = element('div', undefined, 'rows');
    scroll.append(table);
    return {node: group(parameter, id + '.group', scroll, add, count, more), get, set};
}

// A sequence of bytes: a text, JSON or 0x..., and a file input.
function bytesField(parameter, made, label) {
    const area = element('textarea');
    let bytes = null;
    Object.assign(area, {rows: 2, value: '[]', oninput: () => { bytes = null; }});
    const found = made(area, () => {
        const text = area.value.trim();
        if (bytes) return bytes;
        if (/^0x([0-9a-f]{2})*$/i.test(text)) return Uint8Array.from(text.slice(2).match(/../g) ?? [], each => parseInt(each, 16));
        try { return JSON.parse(text); } catch { throw new Error(`${parameter.name}: expected JSON or 0x and digits, got ${text.slice(0, 60)}`); }
    }, value => { bytes = value instanceof Uint8Array ? value : null; area.value = json(value); });
    if (label) label.append(fileInput(`${parameter.name} from a file`, '', async file => found.set(new Uint8Array(await file.arrayBuffer()))));
    return found;
}

// A check box before the field of an optional parameter.
function optionalField(parameter, id) {
    const inner = field({...parameter, tag: undefined}, id), given = element('input'), line = element('div', undefined, 'optional');
    given.type = 'checkbox';
    given.setAttribute('aria-label', `pass ${parameter.name}`);
    inner.node.addEventListener('input', () => { given.checked = true; });
    line.append(given, inner.node);
    return {node: line, get: () => given.checked ? inner.get() : null,
        set: value => { given.checked = value !== null; if (value !== null) inner.set(value); }};
}

// Returns the field of a parameter. `cell`: name of the field if it is in a table, without a label.
function field(parameter, id, cell) {
    const slice = station.slice, type = parameter.type, its = slice.get(type);
    if (parameter.tag !== undefined) return optionalField(parameter, id);
    if (its.kind === 'struct') return structField(parameter, id);
    if (its.kind === 'class') return classField(parameter, id);
    if (its.element && !slice.isBytes(type)) return tableField(parameter, id);
    const label = cell ? null : element('label');
    if (label) label.append(element('span', parameter.name), ' ', element('small', slice.named(type)), ' ');
    const made = (node, get, set) => {
        node.id = id;
        if (cell) node.setAttribute('aria-label', cell);
        else label.append(node);
        return {node: label ?? node, get, set};
    };
    if (type in INTEGERS) return integerField(parameter, made, label);
    if (slice.isBytes(type)) return bytesField(parameter, made, label);
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
    if (type.endsWith('*')) {
        const select = element('select');
        select.append(element('option', 'watch: show events here'), element('option', 'null'));
        return made(select, () => select.selectedIndex ? null : 'watch', value => { select.selectedIndex = value === null ? 1 : 0; });
    }
    const input = element('input');
    input.value = type === 'string' ? '' : '0';
    return made(input, () => type === 'string' ? input.value : numberOf(input.value), value => { input.value = String(value); });
}
