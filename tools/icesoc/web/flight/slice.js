// SPDX-License-Identifier: MIT
//
// slice: checks and marshals values of Slice in the browser, and calls operations, by stock Ice for
// JavaScript. The types come from the output of `slice2c --describe`; no code is generated.

const INTEGERS = {byte: [0n, 255n], short: [-(2n ** 15n), 2n ** 15n - 1n], int: [-(2n ** 31n), 2n ** 31n - 1n],
    long: [-(2n ** 63n), 2n ** 63n - 1n]};

// A reference to an instance of a class. Ice sends instances after the values that refer to them.
class Later {
    constructor() { this.instance = null; }
}

class Slice {
    constructor(declarations) { Object.assign(this, {declarations, exceptions: new Map(), values: new Map()}); }

    get(type) { return this.declarations[type] || {kind: ''}; }
    // Returns a declaration and its bases, the most derived first.
    lineage(id) {
        const ids = [];
        for (const todo = [id]; todo.length;) {
            const next = todo.shift();
            if (ids.includes(next) || !this.declarations[next]) continue;
            ids.push(next);
            todo.push(...this.get(next).bases || []);
        }
        return ids;
    }
    operations(id) { return this.lineage(id).flatMap(each => this.get(each).operations || []); }
    fields(id) { return this.lineage(id).reverse().flatMap(each => this.get(each).fields || []); }
    isBytes(type) { return this.get(type).kind === 'sequence' && this.get(type).element === 'byte'; }
    annotation(metadata, name) {
        const found = (metadata || []).find(text => text.startsWith(name + ':'));
        return found ? found.slice(name.length + 1) : '';
    }
    bounds(type, metadata) {
        const given = this.annotation(metadata, 'call:range');
        return given ? given.split(':').map(BigInt) : INTEGERS[type];
    }
    named(type) {
        const its = this.get(type);
        if (its.kind === 'sequence') return `sequence<${this.named(its.element)}>`;
        if (its.kind === 'dictionary') return `dictionary<${this.named(its.key)}, ${this.named(its.element)}>`;
        return type.replace(/^::/, '').replaceAll('::', '.');
    }
    // Returns the names of width, height and pixels if a struct is a grey picture, otherwise null.
    picture(type) {
        const fields = this.get(type).kind === 'struct' ? this.fields(type) : [], bytes = fields.filter(f => this.isBytes(f.type));
        const fits = fields.length === 3 && bytes.length === 1 && ['width', 'height'].every(name => fields.some(f => f.name === name));
        return fits ? ['width', 'height', bytes[0].name] : null;
    }
    // Returns whether values of a type may contain instances of classes.
    holdsClasses(type, depth = 0) {
        const its = this.get(type);
        if (type === 'Object' || its.kind === 'class' || depth > 20) return true;
        const inner = [...(its.kind === 'struct' ? this.fields(type).map(f => f.type) : []),
            ...(its.element ? [its.element] : []), ...(its.key ? [its.key] : [])];
        return inner.some(each => this.holdsClasses(each, depth + 1));
    }
    // Returns the classes that fit a parameter of a class: the class itself and its derived classes.
    classes(type) { return Object.keys(this.declarations).filter(id => this.lineage(id).includes(type)); }
    // Returns the encoded size of a type in bytes; 0 if the size depends on the value.
    fixedSize(type) {
        const sizes = {bool: 1, byte: 1, short: 2, int: 4, long: 8, float: 4, double: 8};
        if (type in sizes) return sizes[type];
        const inner = this.get(type).kind === 'struct' ? this.fields(type).map(f => this.fixedSize(f.type)) : [0];
        return inner.every(Boolean) ? inner.reduce((sum, each) => sum + each, 0) : 0;
    }
    // Returns the encoded size of one element of a sequence or dictionary; 0 if it depends on the value.
    elementSize(its) {
        const sizes = [its.element, ...(its.key ? [its.key] : [])].map(each => this.fixedSize(each));
        return sizes.every(Boolean) ? sizes.reduce((sum, each) => sum + each) : 0;
    }
    // Returns the name of the format in which Ice encodes an optional value.
    optionalFormat(type) {
        const its = this.get(type), formats = {bool: 'F1', byte: 'F1', short: 'F2', int: 'F4', float: 'F4', long: 'F8', double: 'F8', string: 'VSize'};
        if (type in formats) return formats[type];
        if (its.kind === 'enum') return 'Size';
        if (its.kind === 'class' || type === 'Object') return 'Class';
        return (its.kind === 'struct' ? this.fixedSize(type) : its.element && this.elementSize(its)) ? 'VSize' : 'FSize';
    }

    // Returns the checked value; throws an Error "threshold: expected 0 to 255, got 300".
    check(value, type, where, metadata) {
        const its = this.get(type);
        const refuse = expected => {
            const text = value instanceof Uint8Array ? `${value.length} bytes` : typeof value === 'bigint' ? String(value) : JSON.stringify(value);
            throw new Error(`${where}: expected ${expected}, got ${text === undefined ? 'nothing' : text.slice(0, 60)}`);
        };
        if (type in INTEGERS) {
            const [low, high] = this.bounds(type, metadata);
            const whole = typeof value === 'bigint' || Number.isSafeInteger(value) || (typeof value === 'string' && /^[+-]?(\d{1,40}|0x[0-9a-f]{1,32})$/i.test(value));
            if (!whole || BigInt(value) < low || BigInt(value) > high) refuse(`${low} to ${high}`);
            return BigInt(value);
        }
        if (type === 'bool') return typeof value === 'boolean' ? value : refuse('true or false');
        if (type === 'float' || type === 'double') {
            const number = typeof value === 'string' && value.trim() ? Number(value) : value;
            if (typeof number !== 'number' || (Number.isNaN(number) && value !== 'NaN')) refuse('a number');
            if (type === 'float' && Number.isFinite(number) && Math.abs(number) > 3.4028234663852886e38) refuse('-3.4e38 to 3.4e38');
            return number;
        }
        if (type === 'string') return typeof value === 'string' ? value : refuse('a text');
        if (type.endsWith('*')) return value;
        if (its.kind === 'class' && value === null) return null;
        if (its.kind === 'enum') return its.enumerators.some(e => e.name === value) ? value : refuse(its.enumerators.map(e => e.name).join(', '));
        if (its.kind === 'sequence') {
            if (!Array.isArray(value) && !(value instanceof Uint8Array && its.element === 'byte')) refuse(`a list of ${this.named(its.element)}`);
            const most = this.annotation(metadata, 'hw:max') || this.annotation(metadata, 'c:max') || this.annotation(its.metadata, 'c:max');
            if (most && value.length > Number(most)) throw new Error(`${where}: expected at most ${most} elements, got ${value.length}`);
            return value instanceof Uint8Array ? value : value.map((each, at) => this.check(each, its.element, `${where}[${at}]`));
        }
        if (value === null || typeof value !== 'object' || Array.isArray(value)) {
            if (its.kind !== 'dictionary' || !Array.isArray(value)) refuse('an object');
        }
        if (its.kind === 'dictionary') {
            const pairs = Array.isArray(value) ? value : Object.entries(value);
            return pairs.map(([key, each]) => [this.check(key, its.key, `key of ${where}`), this.check(each, its.element, `${where}[${key}]`)]);
        }
        let actual = type;
        if (its.kind === 'class') {
            actual = value['@type'] === undefined ? type : '::' + String(value['@type']).replace(/^::/, '').replaceAll('.', '::');
            if (!this.lineage(actual).includes(type)) throw new Error(`${where}.@type: expected ${this.classes(type).map(id => this.named(id)).join(', ')}, got ${JSON.stringify(value['@type'])}`);
        }
        const fields = this.fields(actual), checked = its.kind === 'class' ? {'@type': actual} : {};
        for (const name of Object.keys(value))
            if (!fields.some(f => f.name === name) && !(name === '@type' && its.kind === 'class')) throw new Error(`${where}.${name}: ${this.named(actual)} has no such field`);
        for (const f of fields) {
            const given = f.name in value ? value[f.name] : f.default;
            checked[f.name] = this.checkMember(given, f, `${where}.${f.name}`);
        }
        return checked;
    }
    // Returns the checked value of a parameter or a field; null if an optional one has no value.
    checkMember(value, member, where) {
        if ('tag' in member && (value === null || value === undefined)) return null;
        return this.check(value, member.type, where, member.metadata);
    }

    write(os, value, type) {
        const its = this.get(type), scalars = {bool: 'writeBool', float: 'writeFloat', double: 'writeDouble', string: 'writeString'};
        const integers = {byte: 'writeByte', short: 'writeShort', int: 'writeInt'};
        if (type in integers) os[integers[type]](Number(value));
        else if (type === 'long') os.writeLong(new Ice.Long(Number(BigInt.asIntN(32, value >> 32n)), Number(BigInt.asUintN(32, value))));
        else if (type in scalars) os[scalars[type]](value);
        else if (type.endsWith('*')) os.writeProxy(value);
        else if (its.kind === 'enum') os.writeSize(its.enumerators.find(e => e.name === value).value);
        else if (its.kind === 'class') os.writeValue(value === null ? null : new (this.valueClass(value['@type']))(value));
        else if (its.kind === 'struct') for (const f of this.fields(type)) this.write(os, value[f.name], f.type);
        else {
            os.writeSize(value.length);
            if (value instanceof Uint8Array) os.writeBlob(value);
            else for (const each of value) {
                if (its.kind === 'dictionary') this.write(os, each[0], its.key);
                this.write(os, its.kind === 'dictionary' ? each[1] : each, its.element);
            }
        }
    }
    read(is, type) {
        const its = this.get(type), scalars = {bool: 'readBool', byte: 'readByte', short: 'readShort', int: 'readInt', float: 'readFloat', double: 'readDouble', string: 'readString'};
        if (type in scalars) return is[scalars[type]]();
        if (type === 'long') {
            const value = is.readLong();
            return BigInt.asIntN(64, (BigInt(value.high >>> 0) << 32n) | BigInt(value.low >>> 0));
        }
        if (type.endsWith('*')) {
            const proxy = is.readProxy(Ice.ObjectPrx);
            return proxy === null ? null : proxy.toString();
        }
        if (its.kind === 'enum') {
            const value = is.readSize(), found = its.enumerators.find(e => e.value === value);
            return found ? found.name : value;
        }
        if (its.kind === 'struct') return Object.fromEntries(this.fields(type).map(f => [f.name, this.read(is, f.type)]));
        if (its.kind === 'class' || type === 'Object') {
            const later = new Later();
            is.readValue(instance => { later.instance = instance; }, type === 'Object' ? Ice.Value : this.valueClass(type));
            return later;
        }
        const count = is.readSize();
        if (its.element === 'byte' && its.kind === 'sequence') return new Uint8Array(is.readBlob(count));
        const pairs = Array.from({length: count}, () => its.kind === 'dictionary' ? [this.read(is, its.key), this.read(is, its.element)] : this.read(is, its.element));
        return its.kind === 'dictionary' && its.key === 'string' ? Object.fromEntries(pairs) : pairs;
    }

    // Returns parameters or fields in the order of Ice's encoding: optional ones last, by their tags.
    ordered(members) {
        const tagged = members.filter(m => 'tag' in m).sort((a, b) => a.tag - b.tag);
        return [...members.filter(m => !('tag' in m)), ...tagged];
    }
    writeMembers(os, members, values) {
        for (const m of this.ordered(members)) {
            const value = values[m.name], its = this.get(m.type);
            if (!('tag' in m)) { this.write(os, value, m.type); continue; }
            const format = this.optionalFormat(m.type);
            if (value === null || !os.writeOptional(m.tag, Ice.OptionalFormat[format])) continue;
            const start = format === 'FSize' ? os.startSize() : 0;
            if (format === 'VSize' && its.kind === 'struct') os.writeSize(this.fixedSize(m.type));
            if (format === 'VSize' && its.element && this.elementSize(its) > 1) os.writeSize(value.length * this.elementSize(its) + (value.length > 254 ? 5 : 1));
            this.write(os, value, m.type);
            if (format === 'FSize') os.endSize(start);
        }
    }
    // Returns a list of [name, value].
    readMembers(is, members) {
        return this.ordered(members).map(m => {
            if (!('tag' in m)) return [m.name, this.read(is, m.type)];
            const its = this.get(m.type), format = this.optionalFormat(m.type);
            if (!is.readOptional(m.tag, Ice.OptionalFormat[format])) return [m.name, null];
            if (format === 'FSize') is.skip(4);
            if (format === 'VSize' && (its.kind === 'struct' || (its.element && this.elementSize(its) > 1))) is.skipSize();
            return [m.name, this.read(is, m.type)];
        });
    }
    // Returns a result in which each instance of a class is replaced by its fields.
    resolved(value, above = []) {
        if (value instanceof Later) {
            if (!value.instance) return null;
            if (above.includes(value.instance)) return '(see above)';
            return this.resolved(value.instance.fields || {}, [...above, value.instance]);
        }
        if (value === null || typeof value !== 'object' || value instanceof Uint8Array) return value;
        if (Array.isArray(value)) return value.map(each => this.resolved(each, above));
        return Object.fromEntries(Object.entries(value).map(([name, each]) => [name, this.resolved(each, above)]));
    }
    // Returns the JavaScript class, derived from Ice.Value, for a Slice class.
    valueClass(id) {
        if (this.values.has(id)) return this.values.get(id);
        const slice = this, own = this.get(id).fields || [], base = this.get(id).bases?.[0];
        const made = class extends (base ? this.valueClass(base) : Ice.Value) {
            constructor(fields = {}) { super(); this.fields = fields; }
            _iceWriteMemberImpl(os) { slice.writeMembers(os, own, this.fields); }
            _iceReadMemberImpl(is) { this.fields = {...Object.fromEntries(slice.readMembers(is, own)), ...this.fields}; }
        };
        Ice.Slice.defineValue(made, id, false);
        this.values.set(id, made);
        return made;
    }

    // Makes the JavaScript class of an exception, and stores it in the module where Ice looks for it.
    exception(id) {
        if (this.exceptions.has(id)) return this.exceptions.get(id);
        const slice = this, base = this.get(id).bases ? this.exception(this.get(id).bases[0]) : Ice.UserException;
        const made = class extends base {
            static get _id() { return id; }
            static get _parent() { return base; }
            _mostDerivedType() { return made; }
            _readMemberImpl(is) {
                // Fields of the base are read after the fields of the derived exception.
                this.fields = {...Object.fromEntries(slice.readMembers(is, slice.get(id).fields || [])), ...this.fields};
            }
        };
        const names = id.slice(2).split('::'), last = names.pop();
        Ice._ModuleRegistry.module(names.join('.'))[last] = made;
        this.exceptions.set(id, made);
        return made;
    }

    // Calls an operation. `values`: checked values by name of parameter. Returns {results, bytes}.
    async call(proxy, operation, values) {
        this.declare(proxy.ice_getCommunicator());
        const ins = operation.parameters.filter(p => !p.out), results = operation.parameters.filter(p => p.out);
        if (operation.result !== 'void') results.push({...operation, name: 'result', type: operation.result});
        const bytes = {up: 0, down: 0};
        const marshal = os => {
            const before = os.size;
            this.writeMembers(os, ins, values);
            if (ins.some(p => this.holdsClasses(p.type))) os.writePendingValues();
            bytes.up = os.size - before;
        };
        const unmarshal = answer => {
            const is = answer.startReadParams(), before = is.pos;
            const found = Object.fromEntries(this.readMembers(is, results));
            if (results.some(p => this.holdsClasses(p.type))) is.readPendingValues();
            bytes.down = is.pos - before;
            answer.endReadParams();
            return this.resolved(found);
        };
        const mode = operation.idempotent ? Ice.OperationMode.Idempotent : Ice.OperationMode.Normal;
        try {
            const found = await Ice.ObjectPrx._invoke(proxy, operation.name, mode, 0, undefined, ins.length ? marshal : null,
                results.length ? unmarshal : null, [Ice.UserException], []);
            return {results: found || {}, bytes};
        } catch (error) {
            if (error.fields) error.fields = this.resolved(error.fields);
            throw error;
        }
    }
    // On the first call, registers all exceptions and classes with Ice.
    declare(communicator) {
        if (this.isDeclared) return;
        this.isDeclared = true;
        for (const id of Object.keys(this.declarations)) {
            if (this.get(id).kind === 'exception') this.exception(id);
            if (this.get(id).kind !== 'class') continue;
            const made = this.valueClass(id);
            communicator.getValueFactoryManager().add(() => new made(), id);
        }
    }

    // Returns an object of an interface; it passes each call to `take` as an event.
    listener(interface_, take) {
        const slice = this;
        return new class extends Ice.Object {
            _iceDispatch(incoming, current) {
                const operation = slice.operations(interface_).find(o => o.name === current.operation);
                if (!operation) throw new Ice.OperationNotExistException(current.id, current.facet, current.operation);
                const ins = operation.parameters.filter(p => !p.out), found = {};
                if (ins.length) {
                    const is = incoming.startReadParams();
                    Object.assign(found, Object.fromEntries(slice.readMembers(is, ins)));
                    if (ins.some(p => slice.holdsClasses(p.type))) is.readPendingValues();
                    incoming.endReadParams();
                } else incoming.readEmptyParams();
                take(operation.name, slice.resolved(found));
                incoming.writeEmptyParams();
                return null;
            }
        }();
    }
}
