#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""directory: measures IceGrid's registry and IceStorm: look-ups, registrations and events per
second of CPU time. CPU time hardly depends on the load of the machine.

    directory.py FOLDER OUTPUT.json [--brief]

FOLDER is the folder in which icesoc.util.fetch icegrid has installed both.
"""
import os
import pathlib
import random
import re
import subprocess
import sys
import tempfile
import time

import Ice

from figures import figure, leave

Ice.loadSlice(f"-I{Ice.getSliceDir()} {Ice.getSliceDir()}/IceStorm/IceStorm.ice")
import IceStorm  # module that the line above generates

UNDER_WAY = 64  # number of calls that are in progress at the same time
HERE = "tcp -h 127.0.0.1"


class Service:
    """A program with an object adapter. Its options switch a trace on, in which Ice prints the
    endpoint of the adapter."""

    def __init__(self, adapter, *words):
        self.process = subprocess.Popen([*words], text=True, stdout=subprocess.PIPE,
                                        stderr=subprocess.STDOUT)
        said = ""
        while not (found := re.search(f"for object adapter .*{adapter}':\n +(tcp.*)\n", said)):
            line = self.process.stdout.readline()
            if not line:
                sys.exit(f"directory: {words[0]} has ended: {said}")
            said += line
        self.endpoint = found[1]

    def spent(self):
        """Returns the CPU time that the program has used so far, s."""
        words = pathlib.Path(f"/proc/{self.process.pid}/stat").read_text().rsplit(") ")[1].split()
        return (int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.communicate()


def rate(service, calls):
    """Makes the calls (a list of functions). Returns the number of calls that the service handles
    per second of its CPU time."""
    begin, waiting = service.spent(), []
    for call in calls:
        if len(waiting) == UNDER_WAY:
            waiting.pop(0).result()
        waiting.append(call())
    for answer in waiting:
        answer.result()
    return len(calls) / max(service.spent() - begin, 0.01)


def registry(ic, folder, work, count, calls):
    """Registers `count` vehicles and looks them up."""
    with Service("Registry.Client", folder / "icegridregistry", "--IceGrid.InstanceName=IceGrid",
                 "--IceGrid.Registry.DynamicRegistration=1",
                 *(f"--IceGrid.Registry.{side}.Endpoints={HERE}"
                   for side in ("Internal", "Server", "Client")),
                 "--IceGrid.Registry.Discovery.Enabled=0", "--Ice.Trace.Network=2",
                 f"--IceGrid.Registry.LMDB.Path={work}") as service:
        locator = Ice.LocatorPrx.checkedCast(
            ic.stringToProxy(f"IceGrid/Locator:{service.endpoint}"))
        book, entry = locator.getRegistry(), ic.stringToProxy(f"any:{HERE} -p 10000")
        registered = rate(service, [lambda i=i: book.setAdapterDirectProxyAsync(f"uav{i}", entry)
                              for i in range(count)])
        found = rate(service, [lambda i=random.randrange(count):
                               locator.findAdapterByIdAsync(f"uav{i}") for _ in range(calls)])
        if locator.findAdapterById("uav1") != entry:
            sys.exit("directory: the registry leads elsewhere")
    of = f"with {count} vehicles, per second of CPU time"
    return [figure(f"{what} {of}", round(value), "")
            for what, value in (("registrations", registered), ("look-ups", found))]


class Counter(Ice.Blobject):
    heard = 0

    def ice_invoke(self, parameters, current):
        self.heard += 1
        return True, b""


def storm(ic, folder, subscribers, events):
    """Publishes events of the size that vehicles send. Counts the events that arrive at the
    subscribers."""
    adapter, counters = ic.createObjectAdapterWithEndpoints("", HERE), []
    adapter.activate()
    with Service("TopicManager", folder / "icebox",
                 "--IceBox.Service.IceStorm=IceStormService,37:createIceStorm "
                 f"--IceStorm.TopicManager.Endpoints='{HERE}' --Ice.Trace.Network=2 "
                 f"--IceStorm.Publish.Endpoints='{HERE}' --IceStorm.Transient=1") as service:
        topic = IceStorm.TopicManagerPrx.checkedCast(
            ic.stringToProxy(f"IceStorm/TopicManager:{service.endpoint}")).create("vehicles")
        for _ in range(subscribers):
            counters.append(Counter())
            topic.subscribeAndGetPublisher({"reliability": "ordered"},
                                           adapter.addWithUUID(counters[-1]))
        publisher, event = topic.getPublisher(), bytes([106, 0, 0, 0, 1, 1]) + bytes(100)
        begin = service.spent()
        rate(service, [lambda: publisher.ice_invokeAsync(
            "vehicleState", Ice.OperationMode.Normal, event, {"vehicle": "uav7"})] * events)
        while any(counter.heard < events for counter in counters):
            time.sleep(0.01)
        taken = events / max(service.spent() - begin, 0.01)
    adapter.destroy()
    return figure(f"events to {subscribers} subscribers, per second of CPU time", round(taken), "")


def main(folder, output, brief=""):
    folder, many = pathlib.Path(folder), 1 if brief else 20
    with tempfile.TemporaryDirectory() as work, Ice.initialize() as ic:
        figures = registry(ic, folder, work, 500 * many, 2000 * many)
        figures += [storm(ic, folder, subscribers, 500 * many) for subscribers in (1, 10)]
    for entry in figures:
        print(f"{entry['value']:10,.0f} {entry['name']}")
    leave(output, figures)


main(*sys.argv[1:]) if len(sys.argv) > 2 else sys.exit(__doc__)
