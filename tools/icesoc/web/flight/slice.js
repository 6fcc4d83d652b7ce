// SPDX-License-Identifier: MIT
//
// slice: values of Slice in the browser, by the description that `slice2c --describe` prints:
// checks, marshalling by stock Ice for JavaScript, and calls. No code is generated.

const INTEGERS = {byte: [0n, 255n], short: [-(2n ** 15n), 2n ** 15n - 1n], int: [-(2n ** 31n), 2n ** 31n - 1n],
    long: [-(2n ** 63n), 2n ** 63n - 1n]};

class Slice {
    constructor(declarations) { this.declarations = declarations; this.exceptions = new Map(); }

    get(type) { return this.declarations[type] || {kind: ''}; }
    // A declaration and its bases, the most derived first.
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
    // Names of width, height and pixels of a struct that is a grey picture, or null.
    picture(type) {
        const fields = this.get(type).kind === 'struct' ? this.fields(type) : [], bytes = fields.filter(f => this.isBytes(f.type));
        const fits = fields.length === 3 && bytes.length === 1 && ['width', 'height'].every(name => fields.some(f => f.name === name));
        return fits ? ['width', 'height', bytes[0].name] : null;
    }
    // The part of a type that this page cannot pass, or ''.
    unfit(type, depth = 0) {
        const its = this.get(type);
        if (type === 'Object' || its.kind === 'class' || depth > 20) return 'classes';
        const inner = [...(its.kind === 'struct' ? this.fields(type).map(f => f.type) : []),
            ...(its.element ? [its.element] : []), ...(its.key ? [its.key] : [])];
        return inner.map(each => this.unfit(each, depth + 1)).find(Boolean) || '';
    }
    unfitOperation(operation) {
        if ('tag' in operation || operation.parameters.some(p => 'tag' in p)) return 'optional parameters';
        return [operation.result, ...operation.parameters.map(p => p.type)].map(type => this.unfit(type)).find(Boolean) || '';
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
        const fields = this.fields(type);
        for (const name of Object.keys(value))
            if (!fields.some(f => f.name === name)) throw new Error(`${where}.${name}: ${this.named(type)} has no such field`);
        return Object.fromEntries(fields.map(f => [f.name, this.check(f.name in value ? value[f.name] : f.default, f.type, `${where}.${f.name}`, f.metadata)]));
    }

    write(os, value, type) {
        const its = this.get(type), scalars = {bool: 'writeBool', float: 'writeFloat', double: 'writeDouble', string: 'writeString'};
        const integers = {byte: 'writeByte', short: 'writeShort', int: 'writeInt'};
        if (type in integers) os[integers[type]](Number(value));
        else if (type === 'long') os.writeLong(new Ice.Long(Number(BigInt.asIntN(32, value >> 32n)), Number(BigInt.asUintN(32, value))));
        else if (type in scalars) os[scalars[type]](value);
        else if (type.endsWith('*')) os.writeProxy(value);
        else if (its.kind === 'enum') os.writeSize(its.enumerators.find(e => e.name === value).value);
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
        const count = is.readSize();
        if (its.element === 'byte' && its.kind === 'sequence') return new Uint8Array(is.readBlob(count));
        const pairs = Array.from({length: count}, () => its.kind === 'dictionary' ? [this.read(is, its.key), this.read(is, its.element)] : this.read(is, its.element));
        return its.kind === 'dictionary' && its.key === 'string' ? Object.fromEntries(pairs) : pairs;
    }

    // Declares an exception to Ice, which finds it by its module.
    exception(id) {
        if (this.exceptions.has(id)) return this.exceptions.get(id);
        const slice = this, base = this.get(id).bases ? this.exception(this.get(id).bases[0]) : Ice.UserException;
        const made = class extends base {
            static get _id() { return id; }
            static get _parent() { return base; }
            _mostDerivedType() { return made; }
            _readMemberImpl(is) {
                // those of the base are read after those of the derived one
                this.fields = {...Object.fromEntries((slice.get(id).fields || []).map(f => [f.name, slice.read(is, f.type)])), ...this.fields};
            }
        };
        const names = id.slice(2).split('::'), last = names.pop();
        Ice._ModuleRegistry.module(names.join('.'))[last] = made;
        this.exceptions.set(id, made);
        return made;
    }

    // Calls an operation; `values`: checked, by name. Returns {results, bytes}, or throws.
    async call(proxy, operation, values) {
        for (const id of Object.keys(this.declarations)) if (this.get(id).kind === 'exception') this.exception(id);
        const ins = operation.parameters.filter(p => !p.out), outs = operation.parameters.filter(p => p.out);
        const results = outs.map(p => [p.name, p.type]);
        if (operation.result !== 'void') results.push(['result', operation.result]);
        const bytes = {up: 0, down: 0};
        const marshal = os => {
            const before = os.size;
            for (const p of ins) this.write(os, values[p.name], p.type);
            bytes.up = os.size - before;
        };
        const unmarshal = answer => {
            const is = answer.startReadParams(), before = is.pos;
            const found = Object.fromEntries(results.map(([name, type]) => [name, this.read(is, type)]));
            bytes.down = is.pos - before;
            answer.endReadParams();
            return found;
        };
        const mode = operation.idempotent ? Ice.OperationMode.Idempotent : Ice.OperationMode.Normal;
        const found = await Ice.ObjectPrx._invoke(proxy, operation.name, mode, 0, undefined, ins.length ? marshal : null,
            results.length ? unmarshal : null, [Ice.UserException], []);
        return {results: found || {}, bytes};
    }

    // An object that takes the operations of an interface as events.
    listener(interface_, take) {
        const slice = this;
        return new class extends Ice.Object {
            _iceDispatch(incoming, current) {
                const operation = slice.operations(interface_).find(o => o.name === current.operation);
                if (!operation) throw new Ice.OperationNotExistException(current.id, current.facet, current.operation);
                const ins = operation.parameters.filter(p => !p.out), found = {};
                if (ins.length) {
                    const is = incoming.startReadParams();
                    for (const p of ins) found[p.name] = slice.read(is, p.type);
                    incoming.endReadParams();
                } else incoming.readEmptyParams();
                take(operation.name, found);
                incoming.writeEmptyParams();
                return null;
            }
        }();
    }
}
