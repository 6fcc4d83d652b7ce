# SPDX-License-Identifier: MIT
"""call: calls an operation of any object, lists objects and operations, listens to events."""
import json
import math
import os
import queue
import re
import sys
import time

import places

from icesoc.call.declarations import listed
from icesoc.call.objects import Catalogue, check_register, flights, registers, ACCESSES, REGISTERS
from icesoc.call.values import Reader, plain, readable
from icesoc.cli.command import command
from icesoc.cli.options import (ADDRESS, ARGUMENTS, BUILD, COUNT, FILE, FOLDER, KEY_FILE, PATH,
                                SWITCH, TEXT, Option, number, one_of)
from icesoc.util import chip
from icesoc.util.console import say
from icesoc.util.errors import Interrupted, Stop, nearest


def completed(prefix, parsed_args, **_):
    """Returns the completions of a word: objects and operations, then parameters and their
    values."""
    values = {name.lstrip("-"): value for name, value in vars(parsed_args).items()}
    # argcomplete passes only the current word, so the earlier words are taken from the shell's line
    line = os.environ.get("COMP_LINE", "")[:int(os.environ.get("COMP_POINT") or 0)]
    before = line.partition(" call ")[2].split(" ")[:-1]
    words = [word for word in before if "." in word and not word.startswith("-")]
    try:
        catalogue = Catalogue(values.get("build") or "build/main",
                              (values.get("slice") or "").split())
        return list(choices(catalogue, words))
    except Stop:
        return []


def choices(catalogue, words):
    """Returns the words that may follow: OBJECT.OPERATION first."""
    if not words:
        for each in catalogue.objects.values():
            for name in catalogue.slices.operations(each.interface):
                yield f"{each.identity}.{name}"
        return
    each, name = catalogue.find(words[0])
    operation = catalogue.operation(each, name)
    for p in inputs(operation):
        yield from (f"{p['name']}={value}" for value in values_of(catalogue, each, operation, p))


def values_of(catalogue, each, operation, parameter):
    """Returns the possible values of a parameter. If they cannot be listed, returns one empty
    value, so that the completion ends after NAME=."""
    its = catalogue.slices.get(parameter["type"])
    if its["kind"] == "enum":
        return [one["name"] for one in its["enumerators"]]
    if parameter["type"] == "bool":
        return ["true", "false"]
    if each.interface == REGISTERS and operation["name"] in ACCESSES and \
            parameter["name"] == "name" and each.registers:
        return [name for name, (access, _) in registers(each).items()
                if access in ACCESSES[operation["name"]]]
    return [""]


WORD = Option("call", ARGUMENTS,
              "[OBJECT.]OPERATION, then its arguments, by position or as NAME=VALUE; write "
              "structures and sequences as JSON, bytes and pictures as JSON or @FILE; for "
              "an argument that is a listener, write 'watch'",
              positional=True, completer=completed)
OPTIONS = [
    WORD,
    Option("list", SWITCH, "list all objects and their operations, or the operations of one "
                           "OBJECT"),
    Option("json", SWITCH, "print results, events and errors as JSON, one line each"),
    Option("check", SWITCH, "only check the arguments; send nothing"),
    Option("oneway", SWITCH, "call without waiting for an answer"),
    Option("watch", SWITCH, "print the calls that the vehicle makes to a listener, until Ctrl-C"),
    Option("events", COUNT, "with --watch: end after this number of events"),
    Option("page", SWITCH, "with --gateway: serve a page with forms for all operations"),
    Option("repeat", COUNT, "call this number of times, and print latency statistics", None),
    Option("timeout", number(0.001, 3600, "s", float), "time-out of each call, with connecting",
           30.0),
    Option("facet", TEXT, "facet of the object", ""),
    Option("context", TEXT, "context of the call: NAME=VALUE pairs, separated by spaces", ""),
    Option("encoding", one_of("1.0", "1.1"), "Ice encoding", "1.1"),
    Option("flight", FOLDER, "folder of the flight in progress; default: the one below build/", ""),
    Option("vehicle", TEXT, "name of the vehicle: uav1, uav2, ... in a flight, or its name in "
                            "IceGrid", ""),
    Option("gateway", TEXT, "HOST:PORT of a gateway or another Ice server, or endpoints in Ice's "
                            "syntax", ""),
    Option("locator", TEXT, "proxy of IceGrid's locator, which finds the vehicle given by "
                            "--vehicle", ""),
    Option("device", PATH, "serial port of the modem; with --wire: serial port of the cable", ""),
    Option("key", KEY_FILE, "with --device: file with the link key; default: unencrypted", ""),
    Option("address", ADDRESS, "with --device: address of the vehicle", "0x0001"),
    Option("guard", number(2, 3300, "ms"), "with --device: guard time of the modem", 1000),
    Option("wire", SWITCH, "with --device: the port leads to a serial cable, without modems"),
    Option("plugin", FOLDER, "with --device: folder of the radio plugin (default: the build's "
                             "folder)", ""),
    Option("slice", TEXT, "Slice files of objects that the build does not list, separated by "
                          "spaces", ""),
    Option("config", FILE, "file with Ice properties, such as IceSSL.CertFile", ""),
    BUILD]


def inputs(operation):
    return [p for p in operation["parameters"] if not p.get("out")]


def assigned(words, operation):
    """Assigns arguments, by position or by name, to parameters; returns {parameter: text}."""
    known = {p["name"]: p for p in inputs(operation)}
    texts, positions = {}, list(known)
    for word in words:
        name, equals, value = word.partition("=")
        if equals and name in known:
            if name in texts:
                raise Stop(f"{name}: given twice", 2)
            texts[name] = value
            continue
        free = [each for each in positions if each not in texts]
        if not free:
            near = nearest(name, known) if equals else ""
            raise Stop(f"{operation['name']}: expected {len(known)} arguments"
                       f"{' (' + listed(known) + ')' if known else ''}, got '{word}' as well{near}",
                       2)
        texts[free[0]] = word
    return texts


def checked(catalogue, each, operation, words, options):
    """Converts and checks the arguments; returns {parameter: checked value}."""
    reader = Reader(catalogue.slices, options.place)
    texts, values = assigned(words, operation), {}
    for p in inputs(operation):
        name = p["name"]
        if name not in texts and options.watch and p["type"].endswith("*"):
            texts[name] = "watch"
        if name not in texts and "tag" in p:
            values[name] = None
            continue
        if name not in texts:
            raise Stop(f"{name}: missing; expected {catalogue.slices.explained(p)}: "
                       f"{each.identity}.{catalogue.slices.signature(operation)}", 2)
        if texts[name] == "watch" and p["type"].endswith("*") and not options.watch:
            raise Stop(f"{name}: expected --watch with the listener 'watch'; add --watch", 2)
        values[name] = reader.argument(texts[name], p)
    check_register(each, operation["name"], values)
    return values


def show_list(catalogue, only, as_json):
    """Prints objects with their operations and doc comments."""
    shown = [each for each in catalogue.objects.values()
             if not only or each.identity == only.rstrip(".")]
    if not shown:
        raise Stop(f"no object '{only}'{nearest(only, catalogue.objects)}", 2)
    if as_json:
        return say(json.dumps({each.identity: {
            "interface": each.interface,
            "operations": catalogue.slices.operations(each.interface)} for each in shown}))
    for each in shown:
        say(f"{each.identity}: {each.interface.lstrip(':').replace('::', '.') or 'unknown'}")
        for name, operation in catalogue.slices.operations(each.interface).items():
            if name.startswith("ice_"):
                continue
            say(f"  {catalogue.slices.signature(operation)}")
            for line in operation.get("doc", "").split("\n"):
                if line:
                    say(f"      {line}")
    return None


def show(results, as_json):
    """Prints the results of a call."""
    if as_json:
        return say(json.dumps(results, default=plain))
    for name, value in results.items():
        text = readable(value)
        say(text.lstrip("\n") if list(results) == ["result"] else f"{name}: {text}")
    return None


def show_statistics(times, failures, as_json):
    """Prints latencies in ms."""
    import statistics  # imported only here, because it takes 16 ms
    ordered = sorted(times)
    figures = {"calls": len(times), "failures": failures}
    if ordered:
        figures |= {
            "min": ordered[0], "median": statistics.median(ordered),
            "p99": ordered[math.ceil(0.99 * len(ordered)) - 1], "max": ordered[-1]}
    figures = {name: round(value, 3) for name, value in figures.items()}
    say(json.dumps(figures) if as_json else ", ".join(
        f"{name} {value:g}" + (" ms" if name not in ("calls", "failures") else "")
        for name, value in figures.items()))


def watch(client, options):
    """Prints events until Ctrl-C, or until the requested number has arrived."""
    left = options.events or math.inf
    while left > 0:
        try:
            name, found = client.events.queue.get(timeout=0.2)
        except queue.Empty:
            continue
        left -= 1
        if options.json:
            say(json.dumps({"event": name, "values": found}, default=plain))
        else:
            say(f"{time.strftime('%H:%M:%S')} {name}" + "".join(
                f" {key}={readable(value).strip()}" for key, value in found.items()))


def unsubscribe(client, operation, prepared):
    """Removes the listener from the core, because nothing receives the events after this program
    has ended."""
    marked = client.slices.get(client.each.interface).get("metadata", [])
    if ":hw" in marked and len(prepared) == 1:
        client.call(operation, [None])


def perform(client, operation, values, options):
    """Calls once or several times, then listens."""
    prepared = client.arguments(operation, values)
    times, failed = [], None
    for _ in range(options.repeat or 1):
        try:
            results, milliseconds = client.call(operation, prepared)
            times.append(milliseconds)
        except Stop as stop:
            failed = failed or stop
            if not options.repeat:
                raise
    if options.repeat:
        show_statistics(times, options.repeat - len(times), options.json)
        if failed:
            raise failed
        return
    if results or options.json:
        show(results, options.json)
    else:
        print(f"done in {times[0]:.1f} ms", file=sys.stderr)
    if options.watch:
        try:
            watch(client, options)
        except Interrupted:
            pass
        finally:
            unsubscribe(client, operation, prepared)


@command("call", OPTIONS, brief=("call --list", "call fir.setCoefficient 3 value=-7 --check"),
         examples=["call --list fir", "call hwengine1.setParameterA 24",
                   "call fir.filter '[100, 200, 300]'", "call scaler.watch --watch",
                   "call uav.isAlive 7 --repeat 100", "call aes.set KEY0 0x2b7e1516",
                   "call camera.isActive --device /dev/ttyUSB0 --key my.key --json"])
def call(options):
    """call an operation of any object of a flight, a vehicle or a gateway

    The arguments are checked against the Slice definition before anything is sent. Exit status: 2
    wrong arguments, 3 the operation threw an exception, 4 no answer, 5 no such object or operation,
    6 the operation refused the call and gave no reason. docs/call.md explains arguments and
    targets.
    """
    words = options.call
    if options.page:
        return serve_page(options)
    if not words and not options.list:
        raise Stop("call: expected [OBJECT.]OPERATION; --list lists all", 2)
    from_outside = [name for name in ("device", "gateway", "locator") if getattr(options, name)]
    live = {} if from_outside or options.flight or places.IS_INSTALLED else flights()
    if live:
        options.build = next(iter(live.values())).build
    files = [os.path.join(options.place, file) for file in options.slice.split()]
    catalogue = Catalogue(options.build, files)
    if options.list:
        return show_list(catalogue, words[0] if words else "", options.json)
    pairs = [pair.partition("=") for pair in options.context.split()]
    if odd := next((pair[0] for pair in pairs if not pair[1]), None):
        raise Stop(f"--context: expected NAME=VALUE, got '{odd}'", 2)
    options.context = {name: value for name, _, value in pairs}
    if options.events and not options.watch:
        raise Stop("--events: expected --watch as well; add --watch", 2)
    each, name = catalogue.find(words[0])
    known = bool(each.interface)
    if known:
        operation = catalogue.operation(each, name)
        values = checked(catalogue, each, operation, words[1:], options)
        refuse_oneway(options, operation)
    if options.check:
        return say(json.dumps(values if known else {}, default=plain))
    from icesoc.call import target
    from icesoc.call.client import Client, Failure
    try:
        with Client(target.of(options), catalogue, each, options) as client:
            if not known:
                operation = catalogue.operation(each, name)
                values = checked(catalogue, each, operation, words[1:], options)
                refuse_oneway(options, operation)
            perform(client, operation, values, options)
    except Failure as failure:
        if not options.json:
            raise Stop(f"{words[0]}: {failure.text}", failure.status) from None
        say(json.dumps({"error": failure.name, "text": failure.text, **failure.fields},
                       default=plain))
        return failure.status
    return None


def serve_page(options):
    """Serves the page of a flight for the vehicle of a gateway, until Ctrl-C."""
    import tempfile
    from icesoc.util.process import run, tool
    if not re.fullmatch(r"(\[[0-9a-fA-F:.]+\]|[^\s:\[\]]+):\d{1,5}", options.gateway):
        raise Stop(f"--page: expected --gateway HOST:PORT, got '{options.gateway}'", 2)
    path = os.path.join(options.build, chip.FILE)
    if not os.path.exists(path):
        raise Stop(f"{path} not found; ./icesoc build writes it", 2)
    with tempfile.TemporaryDirectory() as folder:
        return run([*tool("web.live"), "--dir", folder, "--build", options.build, "--gateway",
                    options.gateway], check=False)


def refuse_oneway(options, operation):
    """Refuses --oneway for an operation with a result."""
    outputs = [p for p in operation["parameters"] if p.get("out")]
    if options.oneway and (outputs or operation["result"] != "void" or operation.get("throws")):
        raise Stop(f"--oneway: expected an operation without results and exceptions, got "
                   f"{operation['name']}", 2)
